"""FMUs coupled by equal names with FMPy alone, in the order of a Gauss-Seidel or of a Jacobi master."""

import shutil

from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave


class Slave:
    """An FMU with its variables by name."""

    slave = FMU2Slave
    values = {"Boolean": lambda text: text == "true", "String": str, "Integer": int, "Real": float}

    def __init__(self, path, name):
        self.name = name
        self.description = read_model_description(path)
        self.variables = {v.name: v for v in self.description.modelVariables}
        self.folder = extract(path)
        self.fmu = self.slave(
            guid=self.description.guid,
            unzipDirectory=self.folder,
            modelIdentifier=self.description.coSimulation.modelIdentifier,
            instanceName=name,
        )
        self.fmu.instantiate()

    def _accessor(self, verb, name):
        kind = self.variables[name].type
        return getattr(self.fmu, verb + ("Integer" if kind == "Enumeration" else kind))

    def set(self, name, value):
        self._accessor("set", name)([self.variables[name].valueReference], [value])

    def set_text(self, name, text):
        """Set a parameter from text: a number, true or false, or the name of an enumeration item."""
        variable = self.variables[name]
        if variable.type == "Enumeration":
            items = [item.name for item in variable.declaredType.items]
            self.set(name, items.index(text) + 1)
        else:
            self.set(name, self.values[variable.type](text))

    def get(self, name):
        return self._accessor("get", name)([self.variables[name].valueReference])[0]

    def vector(self, name):
        return [self.get(f"{name}[{i}]") for i in (1, 2, 3)]

    def names(self, causality):
        return [name for name, v in self.variables.items() if v.causality == causality]

    def start(self):
        self.fmu.setupExperiment(startTime=0.0)
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()

    def close(self):
        self.fmu.terminate()
        self.fmu.freeInstance()
        shutil.rmtree(self.folder, ignore_errors=True)


class Loop:
    """Slaves in the order in which they step. Equal names connect: that is the whole wiring rule."""

    def __init__(self, slaves, scheme="gauss-seidel"):
        self.slaves, self.scheme, self.time = slaves, scheme, 0.0
        self.wires = {
            reader.name: [
                (source, name)
                for name in reader.names("input")
                for source in slaves
                if name in source.variables and source.variables[name].causality == "output"
            ]
            for reader in slaves
        }

    def start(self):
        for slave in self.slaves:
            slave.start()

    def hand_over(self, reader):
        for source, name in self.wires[reader.name]:
            reader.set(name, source.get(name))

    def step(self, step, k):
        """Steps all slaves from k * step on; in a Jacobi master all have what the others said before it."""
        if self.scheme == "jacobi":
            for slave in self.slaves:
                self.hand_over(slave)
        for slave in self.slaves:
            if self.scheme != "jacobi":
                self.hand_over(slave)
            slave.fmu.doStep(k * step, step)

    def close(self):
        for slave in self.slaves:
            slave.close()
