"""A stranger's filter, to be packed by PythonFMU: it inverts the newest LiDAR measurement and differences two of them.

It knows nothing of epochs, covariances or initial estimates: no more than the names `est.r_tc_n` and `est.v_tc_n`.
"""

from math import sqrt, tan

from pythonfmu import Boolean, Fmi2Causality, Fmi2Slave, Fmi2Variability, Integer, Real

INPUT = {"causality": Fmi2Causality.input}
OUTPUT = {"causality": Fmi2Causality.output}
AXES = range(3)


class Toy(Fmi2Slave):
    description = "Direct inversion of the LiDAR measurement"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.time = self.range = self.azimuth = self.elevation = 0.0
        self.count = self.used = self.stop_after = 0
        self.valid = False
        self.dcm = [[float(i == j) for j in AXES] for i in AXES]
        self.epoch, self.r, self.v = None, [0.0] * 3, [0.0] * 3
        self.offer(Real, "sample_time", "time", INPUT)
        self.offer(Integer, "sample_count", "count", INPUT)
        self.offer(Boolean, "lidar.valid", "valid", INPUT)
        for name in ("range", "azimuth", "elevation"):
            self.offer(Real, f"lidar.{name}", name, INPUT)
        fixed = {"causality": Fmi2Causality.parameter, "variability": Fmi2Variability.fixed}
        self.offer(Integer, "stop_after", "stop_after", fixed)
        for i in AXES:
            for j in AXES:
                self.element(f"dcm_bc_n[{i + 1},{j + 1}]", self.dcm[i], j, INPUT)
        for i in AXES:
            self.element(f"est.r_tc_n[{i + 1}]", self.r, i, OUTPUT)
            self.element(f"est.v_tc_n[{i + 1}]", self.v, i, OUTPUT)

    def offer(self, kind, name, field, role):
        access = {"getter": lambda: getattr(self, field), "setter": lambda value: setattr(self, field, value)}
        self.register_variable(kind(name, **access, **role), nested=False)

    def element(self, name, values, index, role):
        access = {"getter": lambda: values[index], "setter": lambda value: values.__setitem__(index, value)}
        self.register_variable(Real(name, **access, **role), nested=False)

    def do_step(self, current_time, step_size):
        if self.count <= self.used or not self.valid:
            return True
        if 0 < self.stop_after < self.count:
            return False
        self.used = self.count
        x, y = tan(self.azimuth), tan(self.elevation)
        depth = self.range / sqrt(1.0 + x * x + y * y)
        # LiDAR axes in body axes: x_L = z_B, y_L = x_B, z_L = y_B.
        body = [depth * y, depth, depth * x]
        now = [sum(self.dcm[i][j] * body[i] for i in AXES) for j in AXES]
        if self.epoch is not None:
            self.v[:] = [(new - old) / (self.time - self.epoch) for new, old in zip(now, self.r)]
        self.epoch, self.r[:] = self.time, now
        return True
