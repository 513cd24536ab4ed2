"""Time against error and time against size, both log-log."""

import os

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.ticker import NullFormatter
from statistics import median

STYLES = {
    "contact-normal": dict(color="#c1121f", marker="o", linewidth=2.2, zorder=5),
    "aspher": dict(color="#1d3557", marker="s"),
    "tamaas": dict(color="#2a9d8f", marker="^"),
    "ContactMechanics": dict(color="#b07d12", marker="D"),
}
TITLES = {"ellipse": "Ellipse (the paper's)", "sphere": "Sphere", "rough": "Rough surface, 10 % contact"}
ACCURACY = 1e-6


def _best(points):
    """Fastest time for each error or better: the corner points."""
    corners, least = [], float("inf")
    for point in sorted(points, key=lambda point: point["seconds"]):
        if point["error"] < least:
            corners.append(point)
            least = point["error"]
    return corners


def _finish(figure, axes, path):
    for axis in axes:
        axis.grid(True, which="major", color="0.85", linewidth=0.8)
        axis.set_axisbelow(True)
        for side in ("top", "right"):
            axis.spines[side].set_visible(False)
    handles = {}
    for axis in axes:
        for handle, label in zip(*axis.get_legend_handles_labels()):
            handles.setdefault(label, handle)
    labels = [name for name in STYLES if name in handles]
    figure.legend([handles[name] for name in labels], labels, loc="lower center", ncol=len(labels), frameon=False)
    figure.savefig(path, dpi=140, bbox_inches="tight", pad_inches=0.1)
    plt.close(figure)


def draw(measured, folder):
    """Both pictures."""
    kinds = [kind for kind in TITLES if any(one["problem"] == kind for one in measured)]
    size = 512
    at_size = [kind for kind in kinds if any((one["problem"], one["size"]) == (kind, size) for one in measured)]
    figure, axes = plt.subplots(
        1, len(at_size), figsize=(4.2 * len(at_size), 4.4), sharey=True, squeeze=False
    )
    figure.subplots_adjust(left=0.07, right=0.985, top=0.91, bottom=0.24, wspace=0.08)
    for axis, kind in zip(axes[0], at_size):
        for one in measured:
            if (one["problem"], one["size"]) != (kind, size):
                continue
            for name, points in one["points"].items():
                corners = _best(points)
                if corners:
                    axis.loglog(
                        [point["error"] for point in corners],
                        [point["seconds"] for point in corners],
                        label=name,
                        **STYLES[name],
                    )
        axis.set_title(f"{TITLES[kind]}, {size} x {size}", fontsize=11)
        axis.set_xlabel("checked error (looser to tighter)")
        axis.invert_xaxis()
    axes[0, 0].set_ylabel("processor seconds, whole call, one thread")
    _finish(figure, axes[0], os.path.join(folder, "performance_error.png"))

    figure, axes = plt.subplots(1, len(kinds), figsize=(4.2 * len(kinds), 4.4), sharey=True)
    figure.subplots_adjust(left=0.07, right=0.985, top=0.91, bottom=0.24, wspace=0.08)
    for axis, kind in zip(axes, kinds):
        for name, style in STYLES.items():
            at = sorted(
                (one["size"], median(time for time, _ in result["times"]))
                for one in measured
                if one["problem"] == kind
                for result in one["results"]
                if result["solver"] == name and result["accuracy"] == ACCURACY
            )
            if at:
                axis.loglog([m for m, _ in at], [seconds for _, seconds in at], label=name, **style)
        sizes = sorted({one["size"] for one in measured})
        axis.set_xlim(sizes[0] / 1.2, sizes[-1] * 1.2)
        axis.set_xticks(sizes, [str(m) for m in sizes])
        axis.xaxis.set_minor_formatter(NullFormatter())
        axis.set_title(TITLES[kind], fontsize=11)
        axis.set_xlabel("elements in each direction")
    axes[0].set_ylabel("processor seconds for a checked error of 1e-6")
    _finish(figure, axes, os.path.join(folder, "performance_size.png"))
