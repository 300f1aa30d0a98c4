"""What both FMUs of this example need: a pulse over a communication step, and variables by name."""

from pythonfmu import Real


def share(begins, ends, step_begins, step):
    """Part of a communication step that a pulse [begins, ends) fills: the held input has the pulse's momentum."""
    return max(0.0, min(ends, step_begins + step) - max(begins, step_begins)) / step


def register(slave, name, values, causality, **more):
    """Offers a list as variables name[1], name[2], ... of an FMU, and a list of one as the scalar `name`."""
    for index in range(len(values)):
        element = f"{name}[{index + 1}]" if len(values) > 1 else name
        slave.register_variable(
            Real(
                element,
                causality=causality,
                getter=lambda index=index: values[index],
                setter=lambda value, index=index: values.__setitem__(index, value),
                **more,
            ),
            nested=False,
        )
