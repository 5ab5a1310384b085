"""The picture of a foot's path, seen from the side."""

from matplotlib.figure import Figure

from ikteach.arrays import Array
from ikteach.view.widgets.picture import Still, png_of


def foot_path(path: Array, ground: float) -> Still:
    """Draw height over z of a foot through one cycle.

    path    (m, 2) height and z [m] at phases that are equally far apart
    ground  the height up to which it stands [m]
    """
    y, z = path.T
    stands = y < ground
    figure = Figure(figsize=(5.5, 2.4), layout="constrained")
    axes = figure.subplots()
    axes.axhline(0, color="0.6", lw=1)
    axes.plot(z, y, "-", color="#0072b2", lw=1, label="path")
    axes.plot(z[stands][::8], y[stands][::8], "s", color="#d55e00", ms=4, label="stands")
    axes.plot(z[~stands][::8], y[~stands][::8], "o", color="#0072b2", ms=3, label="swings")
    axes.set(xlabel="z [m], forward to the right", ylabel="height [m]", title="Your foot")
    axes.legend(fontsize=8)
    words = (
        f"Your foot, from the side: z from {z.min():.3g} to {z.max():.3g} m, height from "
        f"{y.min():.3g} to {y.max():.3g} m. It stands for {stands.mean():.0%} of the cycle"
    )
    if stands.any():
        words += f", at z from {z[stands].min():.3g} to {z[stands].max():.3g} m"
    return Still(png_of(figure), f"{words}. Squares, 1/50 of a cycle apart, are where it stands.")
