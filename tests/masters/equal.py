"""Fly the same systems with every master that can be had, compare bit for bit, and write it down.

    equal.py WORK HARNESS OUT.md

In open loop each is compared with a replay of the harness, in closed loop with the first master of the same order and
step. WORK/fmu holds the four FMUs. Exit code 1 if a master differs, or if the document is not what stood in OUT.md.
"""

import csv
import shlex
import subprocess
import sys
from pathlib import Path

from case import EXAMPLE, Case, ssp
from master import MODULES, NOT_HERE

HERE = Path(__file__).parent
STEPS = (1.0, 0.25)
SEED, RUN, STOP = 7, 3, 600.0
# Scenario, filter and their settings in the open loop.
WORLDS = (
    ("leo_venting", "fixed_q", {"fixed_q.s": "3e-6", "chaser.q_coupled": "false"}),
    ("leo_venting", "milton", {}),
    ("leo_venting", "hybrid", {}),
    ("nrho_venting", "milton", {}),
    ("formation", "hybrid", {}),
)
# What the archive of `pack` is bound to: scenario, filter, seed and run; and who loads it.
PACKED = ("leo_venting", "hybrid", 1, 0)
LOADERS = ("fmpy_ssp", "libcosim", "ecos")
AXES = {1: "x", 2: "y", 3: "z"}
# Estimates that a replay has, in both frames: name here, pattern of its column.
INERTIAL = {
    "est.r_tc_n": "est_pos_{}_m",
    "est.v_tc_n": "est_vel_{}_m_s",
    "est.a_t_n": "est_acc_{}_m_s2",
    "est.b_c_bc": "est_bias_{}_m_s2",
}
ACCELERATIONS = ("est.a_t_n", "est.d_lvlh")
LVLH = {"est.rho_lvlh": "est_pos_{}_m", "est.rho_dot_lvlh": "est_vel_{}_m_s", "est.d_lvlh": "est_acc_{}_m_s2"}


def elements(vectors):
    return [f"{vector}[{i}]" for vector in vectors for i in AXES]


def read_csv(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def difference(theirs, ours):
    """The first place where rows differ from those that they are held to; None if nowhere. A NaN differs from all."""
    for their, our in zip(theirs, ours):
        for name, text in our.items():
            if float(their[name]).hex() != float(text).hex() or text == "nan":
                return f"sample {our['est.count']}: `{name}` is {their[name]}, not {text}"
    return None


def fly(work, module, scheme, case):
    """Rows of a flight."""
    path, out = case.write(), Path(case.folder) / f"{case.name}.csv"
    command = [sys.executable, HERE / "run_one.py", module, scheme, path, out]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(f"{scheme} {case.name}: {done.stdout[-2000:]}{done.stderr[-2000:]}")
    return read_csv(out)


def index(model_path, enumeration, item):
    """Number of an item, for `scenario_index` and `filter_index`."""
    types = ssp.Model(model_path).root.find("TypeDefinitions")
    of = next(
        t for t in types if any(i.get("name") == item for i in t.iter("Item")) and t.get("name").lower() == enumeration
    )
    return next(i.get("value") for i in of.iter("Item") if i.get("name") == item)


class Tools:
    """Masters that are here: scheme, its order and its module, and versions."""

    def __init__(self):
        self.schemes, self.versions, self.skipped = [], [], []
        for module in MODULES:
            probe = subprocess.run([sys.executable, HERE / "run_one.py", module], capture_output=True, text=True)
            if probe.returncode:
                self.skipped.append(module)
                print(f"SKIPPED {module}: {probe.stderr.strip().splitlines()[-1]}")
                continue
            version, *schemes = probe.stdout.strip().splitlines()
            self.versions += [version] if version not in self.versions else []
            self.schemes += [(module, *line.rsplit("\t", 1)) for line in schemes]


def replay(work, harness, scenario, filter_name, settings, seed=SEED, run=RUN):
    """Estimates of the harness, by the names of the FMU."""
    out = work / "replay.csv"
    options = [f"--set=fmu-nav.{name}={value}" for name, value in settings.items()]
    command = [harness[0], "replay", *harness[1:], "--scenario", scenario, "--filters", filter_name, *options]
    subprocess.run(
        [*command, "--run", str(run), "--seed", str(seed), "--out", out], check=True, stdout=subprocess.DEVNULL
    )
    names = LVLH if scenario == "formation" else INERTIAL
    rows = []
    for row in read_csv(out):
        if float(row["t_s"]) > STOP:
            break
        rows.append({"est.count": row["sample"]})
        for name, pattern in names.items():
            cells = {f"{name}[{i}]": row[pattern.format(axis)] for i, axis in AXES.items()}
            # A filter without an acceleration state has none to compare.
            rows[-1] |= {name: cell for name, cell in cells.items() if cell or not name.startswith(ACCELERATIONS)}
    return rows


def open_loop(work, harness, tools):
    """Verdict of each master, order and step by world."""
    fmus = [str(work / "fmu" / f"{name}.fmu") for name in ("fmu-truth", "fmu-nav")]
    table, same = {}, True
    for scenario, filter_name, settings in WORLDS:
        reference = replay(work, harness, scenario, filter_name, settings)
        names = ["est.count", *elements(LVLH if scenario == "formation" else INERTIAL)]
        both = {"study_seed": str(SEED), "run": str(RUN)}
        chosen = {
            model: both | {"scenario_index": index(path, "scenario", scenario)}
            for model, path in zip(("fmu-truth", "fmu-nav"), fmus)
        }
        chosen["fmu-nav"] |= {"filter_index": index(fmus[1], "filter", filter_name)} | settings
        for module, scheme, order in tools.schemes:
            for step in STEPS:
                read = [["fmu-nav", name] for name in names]
                rows = fly(work, module, scheme, Case("open", fmus, chosen, read, step, STOP, str(work / "case")))
                # Who hands over one step late sees the last sample only after the end.
                expected = len(reference) - (order == "jacobi")
                found = difference(rows, reference)
                if len(rows) != expected:
                    found = f"{len(rows)} samples, not {expected}"
                same = same and not found
                table.setdefault((scheme, order, step), []).append(found or f"equal, {len(rows)}")
                print(f"{scheme} {step:g} s {scenario} {filter_name}: {found or 'equal'}", flush=True)
    return table, same


def packed(work, harness, tools):
    """Verdict of each master that loads the archive of `pack`, which holds both FMUs and their values."""
    fmus = [str(work / "fmu" / f"{name}.fmu") for name in ("fmu-truth", "fmu-nav")]
    archive = str(work / "fmu" / "relative-navigation.ssp")
    scenario, filter_name, seed, run = PACKED
    reference = replay(work, harness, scenario, filter_name, {}, seed, run)
    # For a tool that reads no bindings; the others find the same in the archive.
    both = {"study_seed": str(seed), "run": str(run), "scenario_index": index(fmus[0], "scenario", scenario)}
    settings = {"truth": both, "nav": both | {"filter_index": index(fmus[1], "filter", filter_name)}}
    read = [["nav", name] for name in ["est.count", *elements(INERTIAL)]]
    table, same = {}, True
    for module, scheme, order in tools.schemes:
        if module not in LOADERS:
            continue
        for step in STEPS:
            case = Case("packed", fmus, settings, read, step, STOP, str(work / "case"), archive, list(settings), scenario)
            rows = fly(work, module, scheme, case)
            found = difference(rows, reference)
            if len(rows) != len(reference) - 1:
                found = f"{len(rows)} samples, not {len(reference) - 1}"
            same = same and not found
            table[scheme, order, step] = [found or f"equal, {len(rows)}"]
            print(f"{scheme} {step:g} s packed archive: {found or 'equal'}", flush=True)
    return table, same


def closed_loop(work, tools):
    """Verdict of each master against the first of the same order and step."""
    names = ("fmu-truth", "fmu-nav", "Guidance", "LifeSupport")
    fmus = [str(work / "fmu" / f"{name}.fmu") for name in names]
    both = {"study_seed": str(SEED), "run": str(RUN)}
    settings = {"fmu-truth": dict(both), "fmu-nav": both | {"filter_index": index(fmus[1], "filter", "snc")}}
    for assignment in (EXAMPLE / "settings.txt").read_text().split():
        target, text = assignment.split("=")
        model, name = target.split(".", 1)
        settings[model][name] = text
    read = [
        ["fmu-nav", name]
        for name in ("est.count", *elements(["est.r_tc_n", "est.v_tc_n", "pred.r_tc_n", "pred.v_tc_n"]))
    ]
    read += [["fmu-truth", name] for name in elements(["truth.r_tc_n", "truth.v_tc_n"])]
    read += [["Guidance", name] for name in ["guidance.dv", *elements(["a_cmd_c_n"])]]
    read += [["LifeSupport", name] for name in ["life.flow", *elements(["f_dist_t_bt"])]]
    table, firsts, same = {}, {}, True
    for step in STEPS:
        for module, scheme, order in tools.schemes:
            rows = fly(work, module, scheme, Case("closed", fmus, settings, read, step, STOP, str(work / "case")))
            if not float(rows[-1]["guidance.dv"]) or not any(float(row["life.flow"]) for row in rows):
                raise RuntimeError(f"{scheme}: nothing is commanded or vented")
            first, reference = firsts.setdefault((order, step), (scheme, rows))
            found = (
                difference(rows, reference)
                if len(rows) == len(reference)
                else f"{len(rows)} samples, not {len(reference)}"
            )
            same = same and not found
            said = "the one compared with" if first == scheme else f"equal, {len(rows)}"
            table[scheme, order, step] = [found or said]
            print(f"{scheme} {step:g} s closed loop: {found or said}", flush=True)
    return table, same


def markdown(heads, table):
    lines = ["| master | order | step [s] | " + " | ".join(heads) + " |", "|---" * (len(heads) + 3) + "|"]
    return lines + [
        f"| {scheme} | {order} | {step:g} | " + " | ".join(cells) + " |"
        for (scheme, order, step), cells in table.items()
    ]


def document(tools, opened, archived, closed):
    """The rendered document."""
    text = (HERE / "masters.md.in").read_text()
    parts = {
        "@versions@": ", ".join(tools.versions),
        "@not_here@": "\n".join(f"* {name}: {why}." for name, why in NOT_HERE.items()),
        "@open@": "\n".join(markdown([f"`{world[0]}`, `{world[1]}`" for world in WORLDS], opened)),
        "@packed@": "\n".join(markdown(["`{}`, `{}`".format(*PACKED)], archived)),
        "@closed@": "\n".join(markdown(["closed loop"], closed)),
        "@stop@": f"{STOP:g}",
    }
    for mark, part in parts.items():
        text = text.replace(mark, part)
    return text


def main(work, harness, out):
    work, out = Path(work), Path(out)
    tools = Tools()
    for name, why in NOT_HERE.items():
        print(f"SKIPPED {name}: {why}")
    opened, open_same = open_loop(work, shlex.split(harness), tools)
    archived, archived_same = packed(work, shlex.split(harness), tools)
    closed, closed_same = closed_loop(work, tools)
    if not (open_same and archived_same and closed_same):
        return 1
    if tools.skipped:
        print(f"{out} stays as it is: not every master is here")
        return 0
    text = document(tools, opened, archived, closed)
    before = out.read_text() if out.exists() else ""
    out.write_text(text)
    if text != before:
        print(f"{out} was not what this run has found, and is rewritten: commit it")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
