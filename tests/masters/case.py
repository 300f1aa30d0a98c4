"""A coupled system that every master runs: its FMUs, what is set, what is read, and for how long."""

import json
import sys
from dataclasses import asdict, dataclass, field
from pathlib import Path

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "05_closed_loop"
sys.path.insert(0, str(EXAMPLE))

import ssp  # noqa: E402


@dataclass
class Case:
    """What a case is made of.

    fmus: paths in the order of a Gauss-Seidel master. settings: text by variable, by model. read: [model, variable]
    each.
    """

    name: str
    fmus: list
    settings: dict
    read: list
    step: float
    stop: float
    folder: str
    archive: str = field(default="")

    def write(self):
        """Writes the SSP archive of the system and the case beside it; returns the path of the latter."""
        folder = Path(self.folder)
        folder.mkdir(parents=True, exist_ok=True)
        self.archive = str(folder / f"{self.name}.ssp")
        ssp.write(self.archive, self.fmus, self.settings, {name for _, name in self.read})
        path = folder / f"{self.name}.json"
        path.write_text(json.dumps(asdict(self)))
        return path

    @staticmethod
    def load(path):
        return Case(**json.loads(Path(path).read_text()))

    @property
    def steps(self):
        return round(self.stop / self.step)

    def models(self):
        return {model.name: model for model in map(ssp.Model, self.fmus)}

    def kinds(self):
        """FMI type of each value that is read."""
        models = self.models()
        return [models[model].kind(name) for model, name in self.read]
