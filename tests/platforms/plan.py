"""Writes the plan that host.c runs: every filter in every mission.

    plan.py FOLDER STEPS > PLAN

FOLDER holds fmu-truth and fmu-nav, unpacked. Outputs and inputs of equal names are linked; all Real outputs are shown.
"""

import re
import sys
import tomllib
import xml.etree.ElementTree as ElementTree
from pathlib import Path

TRUTH, NAV = 0, 1


def variables(description):
    """Name, type, causality and value reference of every variable."""
    for variable in description.iter("ScalarVariable"):
        kind = next(child.tag for child in variable if child.tag != "Annotations")
        yield variable.get("name"), kind, variable.get("causality"), variable.get("valueReference")


def main():
    folder, steps = Path(sys.argv[1]), int(sys.argv[2])
    sides = [ElementTree.parse(folder / name / "modelDescription.xml").getroot() for name in ("fmu-truth", "fmu-nav")]
    outputs = {}
    for side, description in enumerate(sides):
        print("guid", side, description.get("guid"))
        for name, kind, causality, reference in variables(description):
            if name == "mission_file":
                print("mission_file", side, reference)
            if causality == "output" and kind == "Real":
                print("shown", side, reference)
            if side == TRUTH and causality == "output":
                outputs[name] = kind, reference
            if side == NAV and name == "filter":
                print("filter", reference)
            if side == NAV and causality == "input" and name in outputs:
                of, source = outputs[name]
                assert of == kind, name
                print(kind, source, reference)
    filters = next(t for t in sides[NAV].iter("SimpleType") if t.get("name") == "Filter")
    for file in sorted((folder / "fmu-nav" / "resources").rglob("*.toml")):
        period = re.search(r"^sample_period_s *= *(\S+)", file.read_text(), re.M)
        tomllib.loads(file.read_text())
        for item in filters.iter("Item"):
            print("case", file.stem, item.get("name"), item.get("value"), period[1], steps)


main()
