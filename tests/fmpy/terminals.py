"""Look at the terminals of FMI 3.0 FMUs with FMPy's schema: terminals.py TRUTH NAV

Prints each FMU's terminals with their members, and those that two FMUs have in common with how they are connected.
"""

import sys
import zipfile
from pathlib import Path

import fmpy
from fmpy import read_model_description
from lxml import etree


def terminals(path):
    """Rule and variables by member, of each terminal."""
    schema = etree.XMLSchema(file=str(Path(fmpy.__file__).parent / "schema/fmi3/fmi3TerminalsAndIcons.xsd"))
    with zipfile.ZipFile(path) as archive:
        root = etree.fromstring(archive.read("terminalsAndIcons/terminalsAndIcons.xml"))
    schema.assertValid(root)
    variables = {v.name: v for v in read_model_description(path).modelVariables}
    found = {}
    for terminal in root.iterfind("Terminals/Terminal"):
        members = {}
        for member in terminal.iterfind("TerminalMemberVariable"):
            variable = variables[member.get("variableName")]
            assert variable.causality in ("input", "output"), variable.name
            members[member.get("memberName")] = variable
        assert len(members) == len(terminal), "a member twice"
        found[terminal.get("name")] = (terminal.get("matchingRule"), members)
    return found


def main(truth, nav):
    truth, nav = terminals(truth), terminals(nav)
    for name, found in (("fmu-truth", truth), ("fmu-nav", nav)):
        print(name, ", ".join(f"{terminal} {len(members)}" for terminal, (_, members) in found.items()))
    for terminal in truth.keys() & nav.keys():
        (rule, ours), (other, theirs) = truth[terminal], nav[terminal]
        assert rule == other, terminal
        if rule == "plug":
            assert ours.keys() == theirs.keys(), ours.keys() ^ theirs.keys()
        ways = set()
        for member in ours.keys() & theirs.keys():
            assert (ours[member].type, ours[member].shape, ours[member].unit) == (
                theirs[member].type,
                theirs[member].shape,
                theirs[member].unit,
            ), member
            ways.add((ours[member].causality, theirs[member].causality))
        print(terminal, rule, *(" to ".join(way) for way in sorted(ways)))


if __name__ == "__main__":
    main(*sys.argv[1:])
