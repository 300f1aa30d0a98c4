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
    each. archive: an SSP archive that is there already, with elements of these names and values of this set in it.
    """

    name: str
    fmus: list
    settings: dict
    read: list
    step: float
    stop: float
    folder: str
    archive: str = ""
    elements: list = field(default_factory=list)
    values: str = ""

    def write(self):
        """Writes the SSP archive of the system, unless it has one, and the case; returns the path of the latter."""
        folder = Path(self.folder)
        folder.mkdir(parents=True, exist_ok=True)
        if not self.archive:
            self.archive = str(folder / f"{self.name}.ssp")
            ssp.write(self.archive, self.fmus, self.settings, {name for _, name in self.read})
            self.values = self.name
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
        models = [ssp.Model(path) for path in self.fmus]
        return dict(zip(self.elements or [model.name for model in models], models))

    def kinds(self):
        """FMI type of each value that is read."""
        models = self.models()
        return [models[model].kind(name) for model, name in self.read]
