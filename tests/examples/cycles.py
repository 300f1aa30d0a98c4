"""Step the guidance of examples/05_closed_loop by itself, with a master's times: cycles.py EXAMPLE

Prints, by step and by how times come about, how many cycles there are and how many are planned. Exit code 1 unless each is
planned once, at its first communication point.
"""

import sys
from fractions import Fraction
from itertools import accumulate, repeat
from math import ceil
from types import ModuleType, SimpleNamespace

UNTIL_S = 5680


class Slave:
    """What guidance needs of PythonFMU, so that no environment has to be made."""

    def __init__(self, **kwargs):
        pass

    def register_variable(self, variable, **kwargs):
        pass


def slave_class(example):
    sys.path.insert(0, example)
    module = sys.modules["pythonfmu"] = ModuleType("pythonfmu")
    module.Fmi2Slave, module.Real = Slave, lambda *args, **kwargs: None
    module.Fmi2Causality = SimpleNamespace(input=None, output=None, parameter=None)
    module.Fmi2Variability = SimpleNamespace(fixed=None)
    from guidance import Guidance

    return Guidance


def planned(guidance, times, step):
    """Number of each step in which a cycle is planned; the first is 1."""
    guidance.r_c[:], guidance.v_c[:], guidance.r_tc[:] = [6.8e6, 0.0, 0.0], [0.0, 7656.0, 0.0], [0.0, -8.0, 0.0]
    steps, plan = [], guidance.plan
    number = 0

    def counted(*state):
        steps.append(number)
        plan(*state)

    guidance.plan = counted
    for number, time in enumerate(times, 1):
        guidance.pred_time[0] = guidance.est_time[0] = time + step
        guidance.do_step(time, step)
    return steps


def main(example):
    slave, good = slave_class(example), True
    for text in ("1", "0.3", "0.25", "0.2", "0.1", "0.02"):
        step, exact = float(text), Fraction(text)
        count = int(UNTIL_S / exact)
        ways = {"accumulated": accumulate(repeat(step, count - 1), initial=0.0), "k*h": (k * step for k in range(count))}
        for way, times in ways.items():
            guidance = slave(instance_name="guidance")
            cycle, start = int(guidance.cycle[0]), int(guidance.start[0])
            wanted = [ceil(begins / exact) for begins in range(start, UNTIL_S + 1, cycle)]
            # The last may begin within the step that is left.
            wanted = [number for number in wanted if number <= count]
            found = planned(guidance, times, step)
            good = good and found == wanted
            print(f"{text} s, {way}: {len(set(found) & set(wanted))} of {len(wanted)} cycles, {len(found)} plans")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
