"""A loop of our own over FMPy, in both orders."""

import fmpy
from coupling import Loop, Slave

SCHEMES = {"FMPy, own loop": "gauss-seidel", "FMPy, own loop (Jacobi)": "jacobi"}


def version():
    return f"FMPy {fmpy.__version__}"


def points(case, scheme):
    loop = Loop([Slave(path, model) for path, model in zip(case.fmus, case.models())], SCHEMES[scheme])
    slaves = {slave.name: slave for slave in loop.slaves}
    for model, settings in case.settings.items():
        for name, text in settings.items():
            slaves[model].set_text(name, text)
    loop.start()
    for k in range(case.steps):
        loop.step(case.step, k)
        yield [slaves[model].get(name) for model, name in case.read]
    loop.close()
