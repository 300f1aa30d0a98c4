"""Guidance that flies on the filter's estimates: fmu-truth, fmu-nav and ten lines of Python, with FMPy as the master.

    closed_loop.py --truth fmu-truth.fmu --nav fmu-nav.fmu

Holds the chaser at a fixed distance from the target, on the line of sight it begins with, and prints distance and estimation
error every ten minutes. Exit code 1 if the loop does not hold its point.
"""

import argparse
import shutil
import sys
from math import dist

from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave

AXES = (1, 2, 3)


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

    def _call(self, verb, name):
        kind = self.variables[name].type
        return getattr(self.fmu, verb + ("Integer" if kind == "Enumeration" else kind))

    def set(self, name, value):
        self._call("set", name)([self.variables[name].valueReference], [value])

    def get(self, name):
        return self._call("get", name)([self.variables[name].valueReference])[0]

    def vector(self, name):
        return [self.get(f"{name}[{i}]") for i in AXES]

    def start(self):
        self.fmu.setupExperiment(startTime=0.0)
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()

    def close(self):
        self.fmu.terminate()
        self.fmu.freeInstance()
        shutil.rmtree(self.folder, ignore_errors=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--truth", required=True)
    parser.add_argument("--nav", required=True)
    parser.add_argument("--hours", type=float, default=1.5)
    arguments = parser.parse_args()

    truth, nav = Slave(arguments.truth, "truth"), Slave(arguments.nav, "nav")
    truth.set("guidance.burn_enabled", False)
    nav.set("filter", [i.name for i in nav.variables["filter"].declaredType.items].index("snc") + 1)
    wires = [
        name
        for name, v in nav.variables.items()
        if v.causality == "input" and name in truth.variables and truth.variables[name].causality == "output"
    ]
    truth.start()
    nav.start()

    point, worst = None, 0.0
    for k in range(round(arguments.hours * 3600)):
        truth.fmu.doStep(float(k), 1.0)
        for name in wires:
            nav.set(name, truth.get(name))
        nav.fmu.doStep(float(k), 1.0)
        if k < 300:  # let the filter settle first
            continue
        r, v = nav.vector("est.r_tc_n"), nav.vector("est.v_tc_n")
        point = point or list(r)
        # Target minus chaser, so a chaser that is too far behind is pushed forwards.
        command = [1e-4 * (r[i] - point[i]) + 2e-2 * v[i] for i in range(3)]
        for i in AXES:
            truth.set(f"a_cmd_c_n[{i}]", max(-1e-2, min(1e-2, command[i - 1])))
        off = dist(truth.vector("truth.r_tc_n"), point)
        if k > 1500:
            worst = max(worst, off)
        if k % 600 == 0:
            error = dist(truth.vector("truth.r_tc_n"), r)
            print(f"{k:5d} s: {off:8.2f} m from the point, estimate off by {error:6.2f} m")
    truth.close()
    nav.close()
    print(f"after settling never more than {worst:.2f} m away")
    return 0 if worst < 100.0 else 1


if __name__ == "__main__":
    sys.exit(main())
