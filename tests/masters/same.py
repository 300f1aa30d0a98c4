"""Compare estimates of another master with a replay of the harness, bit for bit: same.py THEIRS.csv REPLAY.csv ROWS"""

import csv
import sys

NAMES = {"est.r_tc_n": "est_pos_{}_m", "est.v_tc_n": "est_vel_{}_m_s", "est.a_t_n": "est_acc_{}_m_s2", "est.b_c_bc": "est_bias_{}_m_s2"}


def read(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def main(theirs, ours, rows):
    theirs, ours = read(theirs), read(ours)
    if len(theirs) != int(rows):
        return f"{len(theirs)} samples, expected {rows}"
    for their, our in zip(theirs, ours):
        if their["est.count"] != our["sample"]:
            return f"sample {their['est.count']} stands beside sample {our['sample']}"
        for name, pattern in NAMES.items():
            for i, axis in enumerate("xyz", start=1):
                a, b = float(their[f"{name}[{i}]"]), float(our[pattern.format(axis)])
                if a.hex() != b.hex():
                    return f"sample {our['sample']}: {name}[{i}] is {a!r}, the harness has {b!r}"
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
