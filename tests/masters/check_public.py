"""Runs `trade-harness check` over FMUs that packages of PyPI carry, and one that PythonFMU has built.

Usage: check_public.py HARNESS FOLDER [FMU ...]; packages are downloaded to FOLDER, never installed. What is found is printed, and held
against what is known of these files, so that neither a crash of the checker nor a rule that no longer looks goes unseen.
"""

import json
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

# Packages as pip takes them, and what is known: how many FMUs of version 2.0 they carry at least.
WHEELS = {"crane-fmu==0.2.0": 4, "gemseo-fmu==3.1.1": 12}
SOURCES = {"fmu-manipulation-toolbox==2.0": 3}
# Rules that are broken by an FMU of this name, known from reading it.
BROKEN = {
    "linux/Mass_Damper.fmu": {"variable.structured", "binary.start", "binary.free-null"},
    "linux/FMU3Model.fmu": {"description.version"},
}


def download(folder: Path, package: str, source: bool) -> list[Path]:
    into = folder / package.replace("==", "-")
    if not into.exists():
        kind = ["--no-binary", ":all:"] if source else ["--only-binary", ":all:"]
        pip = [sys.executable, "-m", "pip", "download", "--quiet", "--disable-pip-version-check", "--no-deps"]
        into.mkdir(parents=True)
        subprocess.run([*pip, *kind, "--dest", str(into), package], check=True)
    for archive in [*into.glob("*.whl"), *into.glob("*.tar.gz")]:
        if archive.suffix == ".whl":
            with zipfile.ZipFile(archive) as wheel:
                wheel.extractall(into, [name for name in wheel.namelist() if name.endswith(".fmu")])
        else:
            with tarfile.open(archive) as tar:
                tar.extractall(into, [m for m in tar.getmembers() if m.name.endswith(".fmu")], filter="data")
    return sorted(into.rglob("*.fmu"))


def check(harness: str, fmu: Path, *options: str) -> dict:
    ended = subprocess.run([harness, "check", str(fmu), "--json", *options], capture_output=True, text=True)
    if ended.returncode not in (0, 1):
        sys.exit(f"{fmu}: exit code {ended.returncode}: {ended.stderr}")
    return json.loads(ended.stdout)["files"][0]


def main() -> None:
    harness, folder, *own = sys.argv[1:]
    fmus = []
    for packages, source in ((WHEELS, False), (SOURCES, True)):
        for package, least in packages.items():
            found = download(Path(folder), package, source)
            if len(found) < least:
                sys.exit(f"{package}: {len(found)} FMUs instead of {least}")
            fmus += found
    for fmu in [*fmus, *map(Path, own)]:
        # Those of PythonFMU take Python from the program that loads them.
        told = check(harness, fmu, *(["--with-tool", "--preload", "python"] if str(fmu) in own else []))
        rules: dict[str, int] = {}
        for finding in told["findings"]:
            name = f"{finding['severity']} {finding['rule']}"
            rules[name] = rules.get(name, 0) + 1
        print(f"{fmu}: {told['errors']} errors, {told['warnings']} warnings, {told['notes']} notes")
        for name, count in rules.items():
            print(f"    {name}: {count}")
        for ending, expected in BROKEN.items():
            if str(fmu).endswith(ending):
                missing = expected - {finding["rule"] for finding in told["findings"]}
                if missing:
                    sys.exit(f"{fmu}: {missing} no longer found")


main()
