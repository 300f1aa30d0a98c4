"""FMPy's simulate_ssp. It knows no bindings, so that parameters are said to it; inputs are 0 in its first step."""

from types import SimpleNamespace

import fmpy
from fmpy.ssp.simulation import simulate_ssp

SCHEMES = {"FMPy, `simulate_ssp`": "jacobi"}


def version():
    return f"FMPy {fmpy.__version__}"


def points(case, scheme):
    models = case.models()
    truths = {"true": 1, "false": 0}
    parameters = [
        SimpleNamespace(name=f"{model}.{name}", value=truths.get(text, text))
        for model, settings in case.settings.items()
        for name, text in settings.items()
        if models[model].kind(name) != "String"
    ]
    rows = simulate_ssp(
        case.archive, stop_time=case.stop, step_size=case.step, parameter_set=SimpleNamespace(parameters=parameters)
    )
    for row in rows:
        yield [row[f"{model}.{name}"].item() for model, name in case.read]
