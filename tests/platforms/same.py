"""Compares what host.c wrote on each platform, bit for bit, and writes the table into a page.

    same.py PAGE STEPS NAME=OUTPUTS NAME=OUTPUTS... [NAME=]...

The first is what the others are held against; one without outputs could not be run here. Fails where one differs.
"""

import re
import sys
from pathlib import Path

BEGIN, END = "<!-- written by tests/platforms/run.sh -->", "<!-- to here -->"


def cases(file):
    """Outputs and last status of each mission and filter."""
    found = {}
    for line in Path(file).read_text().splitlines():
        mission, name, outputs, status = line.split(" ")
        found[name, mission] = outputs, int(status)
    return found


def main():
    page, steps = Path(sys.argv[1]), sys.argv[2]
    given = [argument.split("=", 1) for argument in sys.argv[3:]]
    names, files = zip(*((name, file) for name, file in given if file))
    missing = [name for name, file in given if not file]
    first, *others = map(cases, files)
    flown = {case: seen for case, seen in first.items() if seen[1] <= 1}
    if not flown or not others:
        sys.exit("nothing to compare")
    rows, differences = {}, []
    for (name, mission), seen in first.items():
        equal = [other.get((name, mission)) == seen for other in others]
        differences += [f"{name} in {mission}: {n} differs from {names[0]}" for n, e in zip(names[1:], equal) if not e]
        if (name, mission) in flown:
            rows.setdefault(name, []).append(equal)
    columns = [*names[1:], *missing]
    head = f"| filter | missions | {' | '.join(columns)} |\n|---|---|{'---|' * len(columns)}\n"
    lines = [
        f"| `{name}` | {len(equal)} | " + " | ".join(
            [*("equal" if all(e) else f"{sum(e)} equal" for e in zip(*equal)), *("not run" for _ in missing)]
        ) + " |\n"
        for name, equal in rows.items()
    ]
    values = sum(len(outputs) // 16 for outputs, _ in flown.values())
    told = (
        f"{len(flown)} flights of {steps} samples, {values} numbers on each platform, against {names[0]} library, "
        "which another compiler made:\n\n"
    )
    before, _, rest = page.read_text().partition(BEGIN)
    _, _, after = rest.partition(END)
    page.write_text(f"{before}{BEGIN}\n{told}{head}{''.join(lines)}{END}{after}")
    print(f"{told.splitlines()[0]} {len(differences)} differ")
    sys.exit("\n".join(differences) or None)


main()
