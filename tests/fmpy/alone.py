"""Simulate one FMU by itself with FMPy's own master: alone.py FMU OUTPUT...

Prints the last value of each named output and checks that the result has as many rows as the default experiment asks.
"""

import sys

from fmpy import read_model_description, simulate_fmu


def main(path, outputs):
    experiment = read_model_description(path).defaultExperiment
    step = float(experiment.stepSize)
    result = simulate_fmu(path, output=outputs, validate=True, step_size=step, output_interval=step)
    rows = round(float(experiment.stopTime) / step) + 1
    if len(result) != rows:
        print(f"{path}: {len(result)} rows, expected {rows}")
        return 1
    for name in outputs:
        print(f"{name} {result[name][-1].tolist()!r}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2:]))
