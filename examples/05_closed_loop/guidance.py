"""Guidance as an FMU, packed by PythonFMU: flies to a point beside the target on the filter's estimates, and holds it.

The point stands in the target's LVLH axes (radial, along track, across). Thrusters of fixed strength fire along these
axes, once in each cycle, for as long as the wanted change of velocity needs; what is too little to fire is kept for the
next cycle.
"""

from math import copysign, floor

from pulse import register, share
from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability

AXES = range(3)
# Part of a cycle by which times may be off: much less than any step, and more than a sum of steps rounds in hours.
ROUNDING = 1e-6


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    return [x / dot(a, a) ** 0.5 for x in a]


class Guidance(Fmi2Slave):
    description = "Flies to a point beside the target on the filter's estimates, and holds it"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        causality, tunable = Fmi2Causality, {"variability": Fmi2Variability.fixed}
        # Estimates at the end of the filter's communication step, and the chaser's orbit as it was at est.time.
        self.pred_time, self.r_tc, self.v_tc = [0.0], [0.0] * 3, [0.0] * 3
        self.est_time, self.r_c, self.v_c = [0.0], [0.0] * 3, [0.0] * 3
        register(self, "pred.time", self.pred_time, causality.input)
        register(self, "pred.r_tc_n", self.r_tc, causality.input)
        register(self, "pred.v_tc_n", self.v_tc, causality.input)
        register(self, "est.time", self.est_time, causality.input)
        register(self, "est.r_c_n", self.r_c, causality.input)
        register(self, "est.v_c_n", self.v_c, causality.input)
        # m/s2, axes N: held over the communication step that follows.
        self.a_cmd = [0.0] * 3
        register(self, "a_cmd_c_n", self.a_cmd, causality.output)
        # Target relative to chaser as taken for when the command acts; sum of all changes of velocity, m/s;
        # where the chaser should be, m, LVLH.
        self.taken, self.dv, self.reference = [0.0] * 3, [0.0], [0.0] * 3
        register(self, "guidance.r_tc_n", self.taken, causality.output)
        register(self, "guidance.dv", self.dv, causality.output)
        register(self, "guidance.reference", self.reference, causality.output)
        # The filter settles until start; then transfer_s to the point.
        self.point, self.start, self.transfer = [0.0, 8.0, 0.0], [120.0], [1200.0]
        self.thrust, self.shortest, self.cycle = [5e-3], [0.05], [4.0]
        self.bandwidth, self.damping = [0.02], [1.0]
        register(self, "guidance.point", self.point, causality.parameter, **tunable)
        register(self, "guidance.start_s", self.start, causality.parameter, **tunable)
        register(self, "guidance.transfer_s", self.transfer, causality.parameter, **tunable)
        register(self, "guidance.thrust", self.thrust, causality.parameter, **tunable)
        register(self, "guidance.shortest_pulse_s", self.shortest, causality.parameter, **tunable)
        register(self, "guidance.cycle_s", self.cycle, causality.parameter, **tunable)
        register(self, "guidance.bandwidth", self.bandwidth, causality.parameter, **tunable)
        register(self, "guidance.damping", self.damping, causality.parameter, **tunable)
        self.origin = None
        # Of the cycle in hand: when it begins, seconds of fire by axis with sign, and what was too little to fire, m/s.
        self.begins, self.fire, self.kept = 0.0, [0.0] * 3, [0.0] * 3
        # Cycles that have begun since time 0; None before the first step.
        self.cycles = None

    def do_step(self, current_time, step_size):
        # What is said now acts from the end of this step on, in a Gauss-Seidel and in a Jacobi master.
        acts = current_time + step_size
        before = self.begun(current_time) if self.cycles is None else self.cycles
        self.cycles = self.begun(acts)
        if acts < self.start[0] - ROUNDING * self.cycle[0]:
            return True
        frame, rate, rho, rho_dot = self.relative(acts)
        if self.cycles > before:
            self.plan(acts, rate, rho, rho_dot)
        strength = [
            copysign(self.thrust[0], self.fire[i])
            * share(self.begins, self.begins + abs(self.fire[i]), acts, step_size)
            for i in AXES
        ]
        self.dv[0] += sum(map(abs, strength)) * step_size
        self.a_cmd[:] = [dot(strength, [axis[i] for axis in frame]) for i in AXES]
        return True

    def begun(self, time):
        """Cycles that have begun by a time. They are counted, so that none is missed whatever the times of a master add up to."""
        return floor(time / self.cycle[0] + ROUNDING)

    def relative(self, acts):
        """Axes and rate of the target's LVLH frame, place and velocity of the chaser in it, when the command acts."""
        # Zero in a Gauss-Seidel master, a communication step in a Jacobi master.
        late = acts - self.pred_time[0]
        v_tc = [v - a * late for v, a in zip(self.v_tc, self.a_cmd)]
        r_tc = [r + 0.5 * (v + u) * late for r, v, u in zip(self.r_tc, self.v_tc, v_tc)]
        self.taken[:] = r_tc
        r_t = [c + v * (acts - self.est_time[0]) + r for c, v, r in zip(self.r_c, self.v_c, r_tc)]
        v_t = [c + v for c, v in zip(self.v_c, v_tc)]
        radial, across = unit(r_t), unit(cross(r_t, v_t))
        frame = [radial, cross(across, radial), across]
        rate = dot(across, cross(r_t, v_t)) / dot(r_t, r_t)
        rho = [-dot(axis, r_tc) for axis in frame]
        v = [-dot(axis, v_tc) for axis in frame]
        return frame, rate, rho, [v[0] + rate * rho[1], v[1] - rate * rho[0], v[2]]

    def plan(self, acts, rate, rho, rho_dot):
        """Seconds of fire along each axis in the cycle that begins now."""
        self.origin = self.origin or (acts, list(rho))
        began, origin = self.origin
        s = min(1.0, (acts - began) / self.transfer[0])
        # A quintic from the point where guidance began: no velocity and no acceleration at either end.
        shape = s**3 * (10 - 15 * s + 6 * s**2)
        speed = 30 * s**2 * (1 - s) ** 2 / self.transfer[0]
        acceleration = 60 * s * (1 - s) * (1 - 2 * s) / self.transfer[0] ** 2
        # Clohessy and Wiltshire: what acts on the chaser without thrust.
        drift = [
            3 * rate**2 * rho[0] + 2 * rate * rho_dot[1],
            -2 * rate * rho_dot[0],
            -(rate**2) * rho[2],
        ]
        self.begins = acts
        for i in AXES:
            way = self.point[i] - origin[i]
            self.reference[i] = origin[i] + way * shape
            wanted = (
                way * acceleration
                - drift[i]
                + 2 * self.damping[0] * self.bandwidth[0] * (way * speed - rho_dot[i])
                + self.bandwidth[0] ** 2 * (self.reference[i] - rho[i])
            )
            change = wanted * self.cycle[0] + self.kept[i]
            fire = min(abs(change) / self.thrust[0], self.cycle[0])
            self.fire[i] = copysign(fire, change) if fire >= self.shortest[0] else 0.0
            # Thrusters at their limit owe nothing.
            self.kept[i] = change if self.fire[i] == 0.0 else 0.0
