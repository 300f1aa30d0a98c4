"""Run an SSP of truth and filter, archive or folder, with libcosim, DNV's co-simulation library: cosim.py SSP STEP_S STOP_S OUT.csv [NAV]

Writes one row for each sample that the filter has used, as `tests/fmpy/couple.py` does. libcosim steps all slaves at once
and hands values over afterwards (Jacobi).
"""

import csv
import sys

from libcosimpy.CosimEnums import CosimExecutionState
from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimObserver import CosimObserver

VECTORS = ("est.r_tc_n", "est.v_tc_n", "est.a_t_n", "est.r_c_n", "est.v_c_n", "est.b_c_bc")
REALS = ["est.time"] + [f"{name}[{i}]" for name in VECTORS for i in (1, 2, 3)]


def main(ssp, step, stop, out, element="fmu-nav"):
    step, stop = round(float(step) * 1e9), round(float(stop) * 1e9)
    execution = CosimExecution.from_ssp_file(ssp_path=ssp, step_size=step)
    observer = CosimObserver.create_last_value()
    execution.add_observer(observer)
    nav = execution.slave_index_from_instance_name(element)
    variables = {v.name.decode(): v.reference for v in execution.slave_variables(nav)}
    reals, count = [variables[name] for name in REALS], [variables["est.count"]]
    with open(out, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["est.count"] + REALS)
        used = 0
        for _ in range(stop // step):
            if not execution.step() or execution.status().state == CosimExecutionState.ERROR.value:
                return f"libcosim stops: {execution.status()}"
            (now,) = observer.last_integer_values(slave_index=nav, variable_references=count)
            if now > used:
                used = now
                values = observer.last_real_values(slave_index=nav, variable_references=reals)
                writer.writerow([used] + [repr(value) for value in values])
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
