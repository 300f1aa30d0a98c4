"""Fly the closed loop of this folder with FMPy, measure it and draw it.

    closed_loop.py --fmus FOLDER [--svg FILE] [--document FILE] [--quick]

FOLDER holds fmu-truth.fmu, fmu-nav.fmu, Guidance.fmu and LifeSupport.fmu. Prints how far the chaser is from where it
should be and what that costs, how good estimates are when a command that rests on them acts, and what momentum pulses
have. Exit code 1 if the loop does not hold its point or a pulse loses momentum.
"""

import argparse
import sys
from math import dist, sqrt
from pathlib import Path

from coupling import Loop, Slave
from pulse import share

# What is set besides scenario and filter.
SETTINGS = (Path(__file__).parent / "settings.txt").read_text().split()
DURATION, SETTLED, ERRORS_UNTIL = 5680.0, 300.0, 1500.0
PULSE_M_S2 = 1e-2
HELD_WITHIN_M = 1.0


def seated(fmus, name, settings=(), filter_name=None):
    slave = Slave(fmus / f"{name}.fmu", name)
    for target, text in (assignment.split("=") for assignment in settings):
        model, variable = target.split(".", 1)
        if model == name:
            slave.set_text(variable, text)
    if filter_name and name == "fmu-nav":
        slave.set_text("filter", filter_name)
    return slave


def in_lvlh(r_c, v_c, r_tc, v_tc):
    """Position of the chaser in the target's LVLH axes: radial, along track, across."""

    def cross(a, b):
        return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]

    def along(axis):
        return -sum(a * b for a, b in zip(axis, r_tc)) / sqrt(sum(a * a for a in axis))

    r = [c + t for c, t in zip(r_c, r_tc)]
    across = cross(r, [c + t for c, t in zip(v_c, v_tc)])
    return [along(r), along(cross(across, r)), along(across)]


def root_mean_square(values):
    return sqrt(sum(v * v for v in values) / len(values))


def fly(fmus, filter_name, step, scheme, duration=DURATION, closed=True):
    """One flight, a row for each step.

    place, reference: where the chaser is and should be, LVLH, m; off: between them. est, pred, taken: error of position
    as the filter says it and as guidance takes it, when the command that rests on it acts, m. dv: m/s. flow: kg/s.
    """
    names = ["fmu-truth", "fmu-nav", "Guidance", "LifeSupport"] if closed else ["fmu-truth", "fmu-nav"]
    loop = Loop([seated(fmus, name, SETTINGS if closed else (), filter_name) for name in names], scheme)
    truth, nav, guidance, life = (loop.slaves + [None, None])[:4]
    loop.start()
    rows = []

    def estimates():
        return [nav.vector(name) for name in ("est.r_tc_n", "pred.r_tc_n", "pred.v_tc_n")] + [nav.get("pred.time")]

    for k in range(round(duration / step)):
        before = estimates()
        loop.step(step, k)
        # What guidance has read in this step: a Jacobi master gives it what stood before the step.
        read = before if scheme == "jacobi" else estimates()
        t, r_tc = (k + 1) * step, truth.vector("truth.r_tc_n")
        est, pred, speed, pred_time = read
        taken = [r + v * (t - pred_time) for r, v in zip(pred, speed)]
        row = {"t": t, "est": dist(est, r_tc), "pred": dist(pred, r_tc), "taken": dist(taken, r_tc)}
        if closed:
            row["place"] = in_lvlh(
                truth.vector("truth.r_c_n"), truth.vector("truth.v_c_n"), r_tc, truth.vector("truth.v_tc_n")
            )
            row["reference"] = guidance.vector("guidance.reference")
            # With its own commands.
            row["taken"] = dist(guidance.vector("guidance.r_tc_n"), r_tc)
            row["dv"], row["flow"] = guidance.get("guidance.dv"), life.get("life.flow")
            row["off"] = dist(row["place"], row["reference"])
        rows.append(row)
    loop.close()
    return rows


class Table:
    """A table in Markdown, printed row by row."""

    def __init__(self, *heads):
        self.lines = []
        self.row(*heads)
        self.row(*["---"] * len(heads))

    def row(self, *cells):
        self.lines.append("| " + " | ".join(cells) + " |")
        print(self.lines[-1], flush=True)


def holds(fmus, filters, steps, schemes):
    """Flights by filter, step and scheme, their table, and whether all hold their point."""
    table = Table(
        "filter", "step [s]", "master", "farthest off after 300 s [m]", "in the last hour [m]", "delta-v [m/s]"
    )
    flights, held = {}, True
    for filter_name in filters:
        for step in steps:
            for scheme in schemes:
                rows = flights[filter_name, step, scheme] = fly(fmus, filter_name, step, scheme)
                worst = max(row["off"] for row in rows if row["t"] >= SETTLED)
                late = max(row["off"] for row in rows if row["t"] >= DURATION - 3600.0)
                spent = f"{rows[-1]['dv']:.3f}"
                table.row(f"`{filter_name}`", f"{step:g}", scheme, f"{worst:.2f}", f"{late:.2f}", spent)
                held = held and worst < HELD_WITHIN_M
    return flights, table, held


def errors(fmus, flights, steps, schemes):
    """The table of estimates when a command that rests on them acts, 300 s to 1500 s."""
    heads = ["`est`", "`pred`", "taken"]
    table = Table("step [s]", "master", *(f"{flown}: {name} [m]" for flown in ("approach", "loop") for name in heads))
    for step in steps:
        for scheme in schemes:
            approach = fly(fmus, "snc", step, scheme, ERRORS_UNTIL, closed=False)
            cells = []
            for rows in (approach, flights["snc", step, scheme]):
                scored = [row for row in rows if SETTLED <= row["t"] <= ERRORS_UNTIL]
                cells += [f"{root_mean_square([row[name] for row in scored]):.3f}" for name in ("est", "pred", "taken")]
            table.row(f"{step:g}", scheme, *cells)
    return table


def velocity(fmus, begins, width, step):
    """Velocity of the target relative to the chaser after a pulse on the chaser along x."""
    truth = seated(fmus, "fmu-truth")
    truth.start()
    for k in range(round(8 / step)):
        truth.set("a_cmd_c_n[1]", PULSE_M_S2 * share(begins, begins + width, k * step, step))
        truth.fmu.doStep(k * step, step)
    v = truth.vector("truth.v_tc_n")
    truth.close()
    return v


def momentum(fmus, steps):
    """The table of pulses against what they give, and whether none loses any."""
    table = Table("pulse of 1e-2 m/s2 [s]", "step [s]", "gives [m/s]", "less what it should give [m/s]")
    kept = True
    for begins, width in ((2.25, 0.5), (2.75, 0.5), (2.0, 0.3), (2.35, 0.3), (2.85, 0.3)):
        for step in steps:
            given = dist(velocity(fmus, begins, width, step), velocity(fmus, begins, 0.0, step))
            missed = given - PULSE_M_S2 * width
            # Gravity differs along the way that the pulse has made: 1e-6 of it in each second squared, over eight.
            kept = kept and abs(missed) < 1e-4 * PULSE_M_S2 * width
            table.row(f"[{begins:g}, {begins + width:g})", f"{step:g}", f"{given:.6f}", f"{missed:.1e}")
    return table, kept


def insert(path, tables):
    """Puts tables between their marks in a document."""
    text = path.read_text()
    for mark, table in tables.items():
        begin, end = f"<!-- {mark}: begin -->\n", f"<!-- {mark}: end -->"
        before, rest = text.split(begin)
        text = before + begin + "".join(line + "\n" for line in table.lines) + end + rest.split(end)[1]
    path.write_text(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--fmus", required=True, type=Path, help="folder of the four FMUs")
    parser.add_argument("--svg", type=Path, help="draw the flight of snc at 1 s into this file")
    parser.add_argument("--document", type=Path, help="put the tables between their marks in this file")
    parser.add_argument("--quick", action="store_true", help="one flight and one pulse")
    arguments = parser.parse_args()

    filters, steps, schemes = ["snc", "hybrid"], [1.0, 0.25], ["gauss-seidel", "jacobi"]
    if arguments.quick:
        filters, steps, schemes = filters[:1], steps[:1], schemes[:1]
    flights, loops, held = holds(arguments.fmus, filters, steps, schemes)
    tables = {"loops": loops, "errors": errors(arguments.fmus, flights, steps, schemes)}
    tables["momentum"], kept = momentum(arguments.fmus, steps)
    if arguments.document:
        insert(arguments.document, tables)
    if arguments.svg:
        from plot import draw

        draw(flights["snc", 1.0, "gauss-seidel"], arguments.svg)
    if not held:
        print(f"a loop is {HELD_WITHIN_M} m or more from where it should be", file=sys.stderr)
    if not kept:
        print("a pulse has lost momentum", file=sys.stderr)
    return 0 if held and kept else 1


if __name__ == "__main__":
    sys.exit(main())
