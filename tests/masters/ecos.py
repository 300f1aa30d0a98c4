"""Run an SSP of truth and filter with ecos: ecos.py SSP SET STEP_S STOP_S OUT.csv

Writes what `cosim.py` does. ecos applies the bound values whose set has the name SET. It steps all slaves at once and hands values
over afterwards (Jacobi).
"""

import csv
import sys

from cosim import REALS
from ecospy import EcosSimulation


def main(ssp, values, step, stop, out):
    with open(out, "w", newline="") as file, EcosSimulation(step_size=float(step), ssp_path=ssp) as simulation:
        simulation.init(parameter_set=values)
        writer = csv.writer(file)
        writer.writerow(["est.count"] + REALS)
        used = 0
        for _ in range(round(float(stop) / float(step))):
            simulation.step()
            now = simulation.get_integer("nav::est.count")
            if now > used:
                used = now
                writer.writerow([used] + [repr(simulation.get_real(f"nav::{name}")) for name in REALS])
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
