"""Life support of the target as an FMU, packed by PythonFMU: it vents on a schedule that nobody tells the filter.

Carbon dioxide goes overboard in every period, water once. Force is mass flow times exhaust velocity, against the way
out.
"""

from random import Random

from pulse import register, share
from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Integer

# kg/s, m/s, s; out of which side of the target, body axes.
CARBON_DIOXIDE = {"flow": 0.01, "speed": 500.0, "duration": 20.0, "out": (0.5, 0.866, 0.0)}
WATER = {"flow": 0.03, "speed": 100.0, "duration": 60.0, "out": (0.5, 0.0, 0.866)}


class LifeSupport(Fmi2Slave):
    description = "Vents carbon dioxide in every period and water once, at times and strengths drawn from a seed"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        causality, fixed = Fmi2Causality, {"variability": Fmi2Variability.fixed}
        # N, body axes of the target: held over the communication step that follows.
        self.force, self.flow = [0.0] * 3, [0.0]
        register(self, "f_dist_t_bt", self.force, causality.output)
        register(self, "life.flow", self.flow, causality.output)
        self.seed, self.period, self.water, self.scale = 1, [900.0], [2500.0], [1.0]
        access = {"getter": lambda: self.seed, "setter": lambda value: setattr(self, "seed", value)}
        self.register_variable(Integer("life.seed", causality=causality.parameter, **fixed, **access), nested=False)
        register(self, "life.period_s", self.period, causality.parameter, **fixed)
        register(self, "life.water_s", self.water, causality.parameter, **fixed)
        register(self, "life.scale", self.scale, causality.parameter, **fixed)
        self.vents = []

    def exit_initialization_mode(self):
        draw = Random(self.seed)
        first = draw.uniform(0.2, 0.5) * self.period[0]
        # Flows differ by a fifth from vent to vent.
        self.vents = [
            (first + k * self.period[0], draw.uniform(0.8, 1.2) * self.scale[0], CARBON_DIOXIDE) for k in range(100)
        ]
        self.vents.append((self.water[0], draw.uniform(0.8, 1.2) * self.scale[0], WATER))

    def do_step(self, current_time, step_size):
        acts = current_time + step_size
        self.force[:], self.flow[0] = [0.0] * 3, 0.0
        for begins, factor, kind in self.vents:
            flow = factor * kind["flow"] * share(begins, begins + kind["duration"], acts, step_size)
            self.flow[0] += flow
            for i in range(3):
                self.force[i] -= flow * kind["speed"] * kind["out"][i]
        return True
