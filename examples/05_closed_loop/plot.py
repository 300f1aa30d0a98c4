"""Draw a flight of closed_loop.py."""

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt  # noqa: E402

INK, TRUTH, WANTED, ESTIMATE, VENT = "#333333", "#1f5f99", "#e08a1e", "#8a8a8a", "#b03a2e"


def draw(rows, path, points=350):
    """Path, distance from the reference beside the estimate's error, and what it costs, into an SVG file."""
    # The same bytes from the same flight.
    plt.rcParams.update({"svg.hashsalt": "closed loop", "font.size": 8, "axes.edgecolor": INK, "axes.linewidth": 0.6})
    thin = rows[:: max(1, len(rows) // points)]
    flown = [row for row in thin if row["dv"] > 0]
    minutes = [row["t"] / 60 for row in flown]
    figure, (way, off, cost) = plt.subplots(1, 3, figsize=(10.5, 3.0), layout="constrained")

    way.plot([row["place"][1] for row in thin], [row["place"][0] for row in thin], color=TRUTH, lw=1.2, label="chaser")
    reference = [row["reference"] for row in flown]
    way.plot([r[1] for r in reference], [r[0] for r in reference], color=WANTED, lw=0.9, ls="--", label="reference")
    way.plot(0, 0, "o", color=INK, ms=5, label="target")
    way.set(xlabel="along track [m]", ylabel="radial [m]", title="path, LVLH axes of the target")

    off.plot(minutes, [row["off"] for row in flown], color=TRUTH, lw=1.0, label="from reference")
    off.plot(minutes, [row["taken"] for row in flown], color=ESTIMATE, lw=0.6, label="error of what guidance takes")
    off.set(xlabel="time [min]", ylabel="distance [m]", title="how well it holds")
    off.set_ylim(0, 1.5 * max(row["off"] for row in flown))
    venting = [row["flow"] > 0 for row in rows]
    for before, after, row in zip(venting, venting[1:], rows[1:]):
        if after and not before:
            off.axvline(row["t"] / 60, color=VENT, lw=0.8, alpha=0.6, label="a vent begins")

    cost.plot(minutes, [row["dv"] for row in flown], color=TRUTH, lw=1.2, label="spent")
    cost.set(xlabel="time [min]", ylabel="delta-v [m/s]", title="what it costs", ylim=(0, None))
    for axes in (way, off, cost):
        axes.grid(color="#dddddd", lw=0.5)
        axes.spines[["top", "right"]].set_visible(False)
        handles = dict(zip(*reversed(axes.get_legend_handles_labels())))
        axes.legend(handles.values(), handles.keys(), frameon=False, fontsize=7)
    figure.savefig(path, metadata={"Date": None, "Creator": None})
