"""Simulate the SSP that `pack` writes with FMPy alone: packed_ssp.py FILE MISSION RUN STEP_S STOP_S OUT.csv

FMPy checks the structure and its values against the schemas of SSP 1.0. Its master applies no parameter bindings, so the values are
handed to it, under the names of their elements; those of another mission than the one that is bound are read from its files.
"""

import csv
import sys

from fmpy.ssp.simulation import simulate_ssp
from fmpy.ssp.ssd import Parameter, ParameterSet, read_ssd, read_ssv

VECTORS = ("est.r_tc_n", "est.v_tc_n", "est.a_t_n", "est.b_c_bc", "est.rho_lvlh", "est.rho_dot_lvlh", "est.d_lvlh")
WRITTEN = ["est.time", "est.count"] + [f"{name}[{i}]" for name in VECTORS for i in (1, 2, 3)]


def values(path, mission, run):
    """The values of a mission, each under the name of its element."""
    whole = ParameterSet()
    for component in read_ssd(path).system.elements:
        (binding,) = component.parameterBindings
        assert binding.source == f"resources/leo_venting_{component.name}.ssv", binding
        for parameter in read_ssv(path, f"resources/{mission}_{component.name}.ssv").parameters:
            value = run if parameter.name == "run" else parameter.value
            whole.parameters.append(Parameter(name=f"{component.name}.{parameter.name}", type=parameter.type, value=value))
    return whole


def main(path, mission, run, step, stop, out):
    result = simulate_ssp(path, stop_time=float(stop), step_size=float(step), parameter_set=values(path, mission, int(run)))
    with open(out, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(WRITTEN)
        used = 0
        for row in result:
            if row["nav.est.count"] > used:
                used = row["nav.est.count"]
                writer.writerow([repr(row[f"nav.{name}"].item()) for name in WRITTEN])


if __name__ == "__main__":
    main(*sys.argv[1:])
