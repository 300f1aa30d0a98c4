"""NTNU's ecos, through ecospy."""

from importlib.metadata import version as installed

from ecospy import EcosLib, EcosSimulation

SCHEMES = {"ecos": "jacobi"}


def version():
    return f"ecospy {installed('ecospy')}"


def points(case, scheme):
    EcosLib.set_log_level("warn")
    with EcosSimulation(step_size=case.step, ssp_path=case.archive) as simulation:
        readers = {"Real": simulation.get_real, "Integer": simulation.get_integer, "Boolean": simulation.get_bool}
        read = [(readers[kind], f"{model}::{name}") for (model, name), kind in zip(case.read, case.kinds())]
        # It applies the sets of parameters that have this name, and no others.
        simulation.init(parameter_set=case.values)
        for _ in range(case.steps):
            simulation.step()
            yield [reader(name) for reader, name in read]
        simulation.terminate()
