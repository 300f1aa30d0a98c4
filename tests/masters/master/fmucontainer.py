"""Renault's fmucontainer: a container FMU of all the FMUs, in each of its three modes, stepped by FMPy."""

import json
import subprocess
import sys
from importlib.metadata import version as installed
from pathlib import Path

import ssp
from coupling import Slave

MODES = {
    "fmucontainer, sequential": {"sequential": True, "mt": False},
    "fmucontainer, parallel": {"sequential": False, "mt": False},
    "fmucontainer, multi-threaded": {"sequential": False, "mt": True},
}
SCHEMES = {name: "gauss-seidel" if mode["sequential"] else "jacobi" for name, mode in MODES.items()}


def version():
    return f"fmucontainer {installed('fmu_manipulation_toolbox')}"


def shown(model, name):
    """Name of an output of the container; MODEL.NAME is that of a wire within."""
    return f"shown.{model}.{name}"


def points(case, scheme):
    models = case.models()
    files = {name: model.path.name for name, model in models.items()}
    converted = {
        "Real": float,
        "Integer": int,
        "Enumeration": int,
        "Boolean": lambda text: text == "true",
        "String": str,
    }
    container = Path(case.archive).with_suffix(".fmu").name
    description = {
        "name": container,
        **MODES[scheme],
        **dict.fromkeys(["auto_link", "auto_input", "auto_output"], False),
        "step_size": case.step,
        "fmu": list(files.values()),
        "path": {model.path.name: str(model.path.resolve()) for model in models.values()},
        "link": [
            [files[source.name], name, files[reader.name], name]
            for source, name, reader in ssp.wiring(list(models.values()))
        ],
        "output": [[files[model], name, shown(model, name)] for model, name in case.read],
        "start": [
            [files[model], name, converted[models[model].kind(name)](text)]
            for model, settings in case.settings.items()
            for name, text in settings.items()
        ],
    }
    folder = Path(case.folder)
    (folder / "container.json").write_text(json.dumps(description))
    program = Path(sys.executable).parent / "fmucontainer"
    command = [program, "-fmu-directory", folder, "-container", "container.json"]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    slave = Slave(str(folder / container), "container")
    slave.start()
    for k in range(case.steps):
        slave.fmu.doStep(k * case.step, case.step)
        yield [slave.get(shown(model, name)) for model, name in case.read]
    slave.close()
