"""Guidance as an FMU, to be packed by PythonFMU: holds the chaser where the estimate put the target after five minutes."""

from pythonfmu import Fmi2Causality, Fmi2Slave, Integer, Real

AXES = range(3)


class Guidance(Fmi2Slave):
    description = "Holds the chaser at a fixed point, on the estimates of the filter it is coupled with"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.count = 0
        self.r, self.v, self.a = [0.0] * 3, [0.0] * 3, [0.0] * 3
        self.point = None
        access = {"getter": lambda: self.count, "setter": lambda value: setattr(self, "count", value)}
        self.register_variable(Integer("est.count", causality=Fmi2Causality.input, **access), nested=False)
        for i in AXES:
            self.element(f"est.r_tc_n[{i + 1}]", self.r, i, Fmi2Causality.input)
            self.element(f"est.v_tc_n[{i + 1}]", self.v, i, Fmi2Causality.input)
        for i in AXES:
            self.element(f"a_cmd_c_n[{i + 1}]", self.a, i, Fmi2Causality.output)

    def element(self, name, values, index, causality):
        access = {"getter": lambda: values[index], "setter": lambda value: values.__setitem__(index, value)}
        self.register_variable(Real(name, causality=causality, **access), nested=False)

    def do_step(self, current_time, step_size):
        if self.count < 300:  # let the filter settle first
            return True
        self.point = self.point or list(self.r)
        # Target minus chaser, so a chaser that is too far behind is pushed forwards.
        command = [1e-4 * (self.r[i] - self.point[i]) + 2e-2 * self.v[i] for i in AXES]
        self.a[:] = [max(-1e-2, min(1e-2, c)) for c in command]
        return True
