"""Run one case with one master: run_one.py MODULE SCHEME CASE.json OUT.csv

Writes one row for each new value of the first column, the ordinal of the sample that the filter has used. Reals are
written so that they read back exactly. `run_one.py MODULE` prints the tool's version and its schemes.
"""

import csv
import importlib
import sys

from case import Case


def main(module, scheme=None, path=None, out=None):
    master = importlib.import_module(f"master.{module}")
    if scheme is None:
        print(master.version(), *("\t".join(pair) for pair in master.SCHEMES.items()), sep="\n")
        return
    case = Case.load(path)
    with open(out, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow([name for _, name in case.read])
        used = 0
        for values in master.points(case, scheme):
            if values[0] > used:
                used = values[0]
                writer.writerow([repr(value) for value in values])


if __name__ == "__main__":
    main(*sys.argv[1:])
