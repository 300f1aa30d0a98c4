"""Fails unless two studies hold the same bytes, timing and the manifest's environment aside: same.py FOLDER FOLDER."""

import json
import pathlib
import sys


def results(folder):
    found = {}
    for path in sorted(pathlib.Path(folder).rglob("*")):
        name = str(path.relative_to(folder))
        if path.is_dir() or name == "timing.csv":
            continue
        found[name] = path.read_bytes()
        if name == "manifest.json":
            manifest = json.loads(found[name])
            del manifest["environment"]
            found[name] = json.dumps(manifest)
    return found


one, other = map(results, sys.argv[1:])
differ = [name for name in one.keys() | other.keys() if one.get(name) != other.get(name)]
if differ or not one:
    sys.exit(f"{sys.argv[1]} and {sys.argv[2]} differ in {sorted(differ)}")
print(f"{len(one)} files, not a byte different")
