"""Couple a truth and a navigation FMU by equal names, with FMPy and nothing else.

    couple.py --truth fmu-truth.fmu --nav fmu-nav.fmu --filter milton --run 3 --stop 600 --out estimates.csv

Writes one row for each sample that the filter has used: its epoch, ordinal and the estimate. Numbers are written so that
they read back exactly.
"""

import argparse
import csv
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "examples" / "05_closed_loop"))

from coupling import Loop, Slave  # noqa: E402

WRITTEN = ["est.time", "est.count"] + [
    f"{name}[{i}]"
    for name in (
        *("est.r_tc_n", "est.v_tc_n", "est.a_t_n", "est.r_c_n", "est.v_c_n", "est.b_c_bc"),
        *("est.rho_lvlh", "est.rho_dot_lvlh", "est.d_lvlh"),
    )
    for i in (1, 2, 3)
]


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

    loop = Loop([truth, nav], arguments.scheme)
    loop.start()
    with open(arguments.out, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(WRITTEN)
        used = 0
        for k in range(round(arguments.stop / arguments.step)):
            loop.step(arguments.step, k)
            count = nav.get("est.count")
            if count > used:
                used = count
                writer.writerow([repr(nav.get(name)) for name in WRITTEN])
    loop.close()


if __name__ == "__main__":
    main()
