"""DNV's libcosim, through libcosimpy."""

from importlib.metadata import version as installed

from libcosimpy.CosimEnums import CosimExecutionState
from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
from libcosimpy.CosimObserver import CosimObserver

SCHEMES = {"libcosim": "jacobi"}
READERS = {"Real": "last_real_values", "Integer": "last_integer_values", "Boolean": "last_boolean_values"}


def version():
    return f"libcosimpy {installed('libcosimpy')}"


def points(case, scheme):
    log_output_level(CosimLogLevel.WARNING)
    execution = CosimExecution.from_ssp_file(ssp_path=case.archive, step_size=round(case.step * 1e9))
    observer = CosimObserver.create_last_value()
    execution.add_observer(observer)
    groups = {}
    for place, ((model, name), kind) in enumerate(zip(case.read, case.kinds())):
        groups.setdefault((model, kind), []).append((place, name))
    wanted = []
    for (model, kind), members in groups.items():
        slave = execution.slave_index_from_instance_name(model)
        references = {v.name.decode(): v.reference for v in execution.slave_variables(slave)}
        places, names = zip(*members)
        wanted.append((slave, READERS[kind], places, [references[name] for name in names]))
    for _ in range(case.steps):
        if not execution.step() or execution.status().state == CosimExecutionState.ERROR.value:
            raise RuntimeError(f"libcosim stops: {execution.status()}")
        row = [None] * len(case.read)
        for slave, reader, places, references in wanted:
            values = getattr(observer, reader)(slave_index=slave, variable_references=references)
            for place, value in zip(places, values):
                row[place] = value
        yield row
