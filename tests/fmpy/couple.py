"""Couple a truth and a navigation FMU by equal names, with FMPy and nothing else.

    couple.py --truth fmu-truth.fmu --nav fmu-nav.fmu --filter milton --run 3 --stop 600 --out estimates.csv

Writes one row for each sample that the filter has used: its epoch, ordinal and the estimate. Numbers are written so that
they read back exactly.
"""

import argparse
import csv
import shutil

from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave

WRITTEN = ["est.time", "est.count"] + [
    f"{name}[{i}]"
    for name in (
        *("est.r_tc_n", "est.v_tc_n", "est.a_t_n", "est.r_c_n", "est.v_c_n", "est.b_c_bc"),
        *("est.rho_lvlh", "est.rho_dot_lvlh", "est.d_lvlh"),
    )
    for i in (1, 2, 3)
]


class Slave:
    """An FMU with its variables by name."""

    def __init__(self, path, name):
        self.description = read_model_description(path)
        self.variables = {v.name: v for v in self.description.modelVariables}
        self.folder = extract(path)
        self.fmu = FMU2Slave(
            guid=self.description.guid,
            unzipDirectory=self.folder,
            modelIdentifier=self.description.coSimulation.modelIdentifier,
            instanceName=name,
        )
        self.fmu.instantiate()

    def _accessor(self, verb, name):
        kind = self.variables[name].type
        return getattr(self.fmu, verb + ("Integer" if kind == "Enumeration" else kind))

    def set(self, name, value):
        self._accessor("set", name)([self.variables[name].valueReference], [value])

    def set_text(self, name, text):
        """Set a parameter from text: a number, true or false, or the name of an enumeration item."""
        variable = self.variables[name]
        if variable.type == "Enumeration":
            items = [item.name for item in variable.declaredType.items]
            self.set(name, items.index(text) + 1)
        elif variable.type == "Boolean":
            self.set(name, text == "true")
        elif variable.type == "String":
            self.set(name, text)
        elif variable.type == "Integer":
            self.set(name, int(text))
        else:
            self.set(name, float(text))

    def get(self, name):
        return self._accessor("get", name)([self.variables[name].valueReference])[0]

    def close(self):
        self.fmu.terminate()
        self.fmu.freeInstance()
        shutil.rmtree(self.folder, ignore_errors=True)


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

    truth, nav = Slave(arguments.truth, "truth"), Slave(arguments.nav, "nav")
    for slave in (truth, nav):
        if arguments.mission:
            slave.set("mission_file", arguments.mission)
        else:
            slave.set_text("scenario", arguments.scenario)
        slave.set("study_seed", arguments.seed)
        slave.set("run", arguments.run)
    nav.set_text("filter", arguments.filter)
    for assignment in arguments.set:
        target, value = assignment.split("=", 1)
        model, name = target.split(".", 1)
        {"fmu-truth": truth, "fmu-nav": nav}[model].set_text(name, value)

    # Equal names connect: that is the whole wiring rule.
    wires = [
        name
        for name, variable in nav.variables.items()
        if variable.causality == "input"
        and name in truth.variables
        and truth.variables[name].causality == "output"
    ]

    def hand_over():
        for name in wires:
            nav.set(name, truth.get(name))

    for slave in (truth, nav):
        slave.fmu.setupExperiment(startTime=0.0)
        slave.fmu.enterInitializationMode()
        slave.fmu.exitInitializationMode()

    with open(arguments.out, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(WRITTEN)
        used = 0
        for k in range(round(arguments.stop / arguments.step)):
            now = k * arguments.step
            if arguments.scheme == "jacobi":
                hand_over()
                truth.fmu.doStep(now, arguments.step)
            else:
                truth.fmu.doStep(now, arguments.step)
                hand_over()
            nav.fmu.doStep(now, arguments.step)
            count = nav.get("est.count")
            if count > used:
                used = count
                writer.writerow([repr(nav.get(name)) for name in WRITTEN])
    truth.close()
    nav.close()


if __name__ == "__main__":
    main()
