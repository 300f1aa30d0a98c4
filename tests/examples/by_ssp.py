"""Fly the four FMUs of examples/05_closed_loop with FMPy's simulate_ssp, which adds steps of 0.1 s up: by_ssp.py EXAMPLE FMUS

Prints how many cycles guidance has planned, of how many. Exit code 1 if one is missed.
"""

import sys
from pathlib import Path
from types import SimpleNamespace

from fmpy.ssp.simulation import simulate_ssp

STEP_S, STOP_S = 0.1, 300.0
# Of guidance: when the first cycle begins, and how long each is.
START_S, CYCLE_S = 120.0, 4.0
FMUS = ("fmu-truth", "fmu-nav", "Guidance", "LifeSupport")


def main(example, fmus):
    sys.path.insert(0, example)
    import ssp

    archive = Path(fmus) / "by_ssp.ssp"
    # A new plan has a new reference, on the way to the point.
    read = [f"guidance.reference[{i}]" for i in (1, 2, 3)]
    ssp.write(archive, [Path(fmus) / f"{name}.fmu" for name in FMUS], {}, read)
    # simulate_ssp reads no bindings.
    settings = [line.split("=") for line in (Path(example) / "settings.txt").read_text().split()]
    parameters = [SimpleNamespace(name=name, value={"false": 0}.get(text, text)) for name, text in settings]
    rows = simulate_ssp(
        str(archive), stop_time=STOP_S, step_size=STEP_S, parameter_set=SimpleNamespace(parameters=parameters)
    )
    references = [tuple(row[f"Guidance.{name}"].item() for name in read) for row in rows]
    planned = sum(before != after for before, after in zip([(0.0, 0.0, 0.0), *references], references))
    wanted = int((STOP_S - START_S) / CYCLE_S) + 1
    print(f"{STEP_S} s, simulate_ssp: {planned} of {wanted} cycles")
    return 0 if planned == wanted else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
