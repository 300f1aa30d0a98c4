"""Couple a truth and a navigation FMU by equal names, with FMPy and nothing else: both of FMI 2.0, or both of FMI 3.0.

    couple.py --truth fmu-truth.fmu --nav fmu-nav.fmu --filter milton --run 3 --stop 600 --out estimates.csv

Writes one row for each sample that the filter has used: its epoch, ordinal and the estimate. Numbers are written so that
they read back exactly.
"""

import argparse
import csv
import math
import sys
from pathlib import Path

from fmpy import read_model_description
from fmpy.fmi3 import FMU3Slave

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "examples" / "05_closed_loop"))

from coupling import Loop, Slave  # noqa: E402

SCALARS = ["est.time", "est.count"]
VECTORS = [
    *("est.r_tc_n", "est.v_tc_n", "est.a_t_n", "est.r_c_n", "est.v_c_n", "est.b_c_bc"),
    *("est.rho_lvlh", "est.rho_dot_lvlh", "est.d_lvlh"),
]


class Slave3(Slave):
    """An FMU of FMI 3.0 with its variables by name, of which a vector or matrix is one, handed over whole."""

    slave = FMU3Slave
    values = {**Slave.values, "Int32": int, "Float64": float}

    def _accessor(self, verb, name):
        kind = self.variables[name].type
        return getattr(self.fmu, verb + ("Int64" if kind == "Enumeration" else kind))

    def set(self, name, value):
        values = value if isinstance(value, list) else [value]
        self._accessor("set", name)([self.variables[name].valueReference], values)

    def get(self, name):
        variable = self.variables[name]
        values = self._accessor("get", name)([variable.valueReference], nValues=math.prod(variable.shape))
        return values if variable.shape else values[0]

    def vector(self, name):
        return self.get(name)

    def start(self):
        self.fmu.enterInitializationMode(startTime=0.0)
        self.fmu.exitInitializationMode()


def slave(path, name):
    """An FMU of either version."""
    version = read_model_description(path).fmiVersion
    return (Slave3 if version.startswith("3.") else Slave)(path, name)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--truth", required=True)
    parser.add_argument("--nav", required=True)
    parser.add_argument("--out", required=True)
    parser.add_argument("--scenario", default="leo_venting")
    parser.add_argument("--mission", help="a mission file, in place of the scenario")
    parser.add_argument("--filter", default="fixed_q")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--run", type=int, default=0)
    parser.add_argument("--stop", type=float, default=600.0)
    parser.add_argument("--step", type=float, default=1.0)
    parser.add_argument("--scheme", choices=["gauss-seidel", "jacobi"], default="gauss-seidel")
    parser.add_argument("--set", action="append", default=[], metavar="fmu-nav.VARIABLE=VALUE")
    arguments = parser.parse_args()

    truth, nav = slave(arguments.truth, "truth"), slave(arguments.nav, "nav")
    for fmu in (truth, nav):
        if arguments.mission:
            fmu.set("mission_file", arguments.mission)
        else:
            fmu.set_text("scenario", arguments.scenario)
        fmu.set("study_seed", arguments.seed)
        fmu.set("run", arguments.run)
    nav.set_text("filter", arguments.filter)
    for assignment in arguments.set:
        target, value = assignment.split("=", 1)
        model, name = target.split(".", 1)
        {"fmu-truth": truth, "fmu-nav": nav}[model].set_text(name, value)

    loop = Loop([truth, nav], arguments.scheme)
    loop.start()
    with open(arguments.out, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(SCALARS + [f"{name}[{i}]" for name in VECTORS for i in (1, 2, 3)])
        used = 0
        for k in range(round(arguments.stop / arguments.step)):
            loop.step(arguments.step, k)
            count = nav.get("est.count")
            if count > used:
                used = count
                values = [nav.get(name) for name in SCALARS] + [v for name in VECTORS for v in nav.vector(name)]
                writer.writerow([repr(value) for value in values])
    loop.close()


if __name__ == "__main__":
    main()
