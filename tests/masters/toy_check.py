"""Check what the harness says of the toy filter: toy_check.py NOISE_FREE_FOLDER STOPPING_FOLDER"""

import csv
import sys
from pathlib import Path


def row(folder):
    with open(Path(folder) / "summary.csv", newline="") as file:
        return next(r for r in csv.DictReader(file) if r["filter"] == "toy")


def main(exact, stopping):
    toy = row(exact)
    # Without noise the inversion is exact but for rounding; a filter without covariance has no ratios.
    if toy["failed"] != "0" or not float(toy["pos_rmse_m"]) < 1e-9 or toy["ratio_pos"] or toy["nees"]:
        return f"noise-free: {toy}"
    toy = row(stopping)
    if toy["failed"] != toy["runs"] or toy["pos_rmse_m"]:
        return f"after 400 samples it discards every step: {toy}"
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
