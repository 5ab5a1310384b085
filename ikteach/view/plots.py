"""What pictures drawn by matplotlib have in common, and distances over the cycle of a gait."""

import io

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from ikteach.arrays import Array
from ikteach.body import Effectors, Tree
from ikteach.markup import as_label
from ikteach.view.stage.colours import effector_colour
from ikteach.view.widgets.picture import Still

STYLES = ("-", "--", "-.", ":")
LEAST = 1e-4  # [m] distances below it are drawn as it: the axes are logarithmic


def as_png(pixels: Array) -> bytes:
    """RGBA pixels (h, w, 4) as a PNG of few colours."""
    from PIL import Image  # comes with matplotlib

    out = io.BytesIO()
    # A palette is a third of the bytes and half of the time of full colour.
    few = Image.fromarray(pixels[..., :3]).quantize(
        48, method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE
    )
    few.save(out, "PNG", compress_level=1)
    return out.getvalue()


def phase_plot(table: pd.DataFrame) -> Still:
    """Distance to target over the cycle, a panel a method (the table of `study.by_phase`)."""
    methods = list(table.columns.unique(level=0))
    figure = Figure(figsize=(2.6 * len(methods), 2.8), dpi=100, layout="constrained")
    panels = figure.subplots(1, len(methods), sharey=True, squeeze=False)[0]
    for axes, method in zip(panels, methods, strict=True):
        for i, (effector, error) in enumerate(table[method].items()):
            colour, style = effector_colour(i), STYLES[i % len(STYLES)]
            axes.semilogy(
                table.index, np.maximum(error, LEAST), style, color=colour, label=as_label(effector)
            )
        axes.set(title=as_label(method), xlabel="phase of the cycle", xlim=(0, 1))
        axes.grid(alpha=0.3)
    panels[0].set_ylabel("distance to target [m]")
    panels[0].legend(fontsize=7)
    words = "; ".join(
        f"{method}: "
        + ", ".join(f"{name} {error.mean():.3f} m" for name, error in table[method].items())
        for method in methods
    )
    out = io.BytesIO()
    figure.savefig(out, format="png")
    return Still(out.getvalue(), f"Distance to target over the gait cycle. Means: {words}.")


def bones(tree: Tree, effectors: Effectors, p: Array, s: Array) -> list[tuple[Array, Array]]:
    """Start and end of each straight piece of the body."""
    joints = [
        (p[parent] if parent >= 0 else np.zeros(3), p[j]) for j, parent in enumerate(tree.parents)
    ]
    return joints + [(p[j], point) for j, point in zip(effectors.joints, s, strict=True)]
