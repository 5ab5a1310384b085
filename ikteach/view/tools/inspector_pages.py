"""The pages of the glass: one tick as pictures, each with its numbers in words and in a table."""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ikteach.arrays import Array
from ikteach.motion.anatomy import Anatomy
from ikteach.view import charts
from ikteach.view.stage.colours import BLUE
from ikteach.view.widgets.picture import png_of


class Page(NamedTuple):
    """A picture (PNG), its words and its numbers.

    `text` is a sentence on the things to look for.
    """

    title: str
    text: str
    png: bytes
    alt: str
    table: pd.DataFrame


class Names(NamedTuple):
    """Names of the rows and columns of J."""

    effectors: Sequence[str]
    joints: Sequence[str]

    @property
    def rows(self) -> list[str]:
        """Effector and coordinate, as in the rows of J."""
        return [f"{name} {axis}" for name in self.effectors for axis in "xyz"]


def error_page(one: Anatomy, names: Names) -> Page:
    """Show e = t − s."""
    e = one.e.reshape(-1, 3)
    figure, axes = _figure()
    _bars(axes, names.effectors, dict(zip("xyz", 100 * e.T, strict=True)))
    axes.set(ylabel="error [cm]", title="e = target − effector")
    table = pd.DataFrame(e, index=list(names.effectors), columns=list("xyz"))
    table["distance"] = np.linalg.norm(e, axis=1)
    far = _list(f"{name} {100 * d:.1f} cm" for name, d in table["distance"].items())
    text = "How far each effector is from its target, coordinate by coordinate: the 3k numbers "
    text += "that the solver is to bring to zero."
    words = f"Bars of the error. From its target: {far}."
    return Page("The error e", text, png_of(figure), words, table)


def jacobian_page(one: Anatomy, names: Names) -> Page:
    """Show J as a heat map."""
    figure, axes = _figure(height=4.6)
    image = _heat(axes, one.J, names.rows, names.joints)
    figure.colorbar(image, ax=axes, pad=0.01)
    _number(axes, one.J)
    axes.set_title("J [m/rad]: how far each effector moves for a small turn of each joint")
    zeros = float((one.J == 0).mean())
    row, column = divmod(int(abs(one.J).argmax()), one.J.shape[1])
    alt = (
        f"Heat map of J, {one.J.shape[0]} rows by {one.J.shape[1]} columns. {zeros:.0%} of it is "
        f"zero. The largest entry is {one.J[row, column]:.3f} m/rad: {names.joints[column]} moves "
        f"{names.rows[row]}."
    )
    text = "A row for each coordinate of each effector, a column for each joint. White is zero: "
    text += "that joint does not carry that effector, or turns it elsewhere."
    table = pd.DataFrame(one.J, index=names.rows, columns=list(names.joints))
    return Page("The Jacobian J", text, png_of(figure), alt, table)


def svd_page(one: Anatomy, names: Names) -> Page:
    """Show J = U Σ Vᵀ."""
    r = len(one.sigma)
    figure = Figure(figsize=(10, 4.4), dpi=100, layout="constrained")
    left, middle, right = figure.subplots(1, 3, width_ratios=[1, 0.8, 1.5])
    number = [str(i + 1) for i in range(r)]
    _heat(left, one.U, names.rows, number)
    left.set(title="U: directions of the error", xlabel="direction")
    middle.barh(number, one.sigma, color=BLUE)
    middle.invert_yaxis()
    middle.set(title="Σ: σ [m/rad]", ylabel="direction")
    middle.grid(axis="x", alpha=0.3)
    for i, sigma in enumerate(one.sigma):
        middle.text(sigma, i, f" {sigma:.3g}", va="center", fontsize=7)
    middle.set_xlim(0, 1.25 * max(one.sigma[0], 1e-9))
    _heat(right, one.Vt, number, names.joints)
    right.set(title="Vᵀ: turns of the joints", ylabel="direction")
    strongest, weakest = (_most(one.Vt[i], names.joints) for i in (0, -1))
    alt = (
        f"Three pictures: U, the {r} singular values and V transposed. The singular values are "
        f"{_list(f'{s:.3g}' for s in one.sigma)} m/rad. The strongest direction turns mostly "
        f"{strongest}, the weakest {weakest}."
    )
    table = pd.DataFrame(
        one.Vt, index=pd.Index(number, name="direction"), columns=list(names.joints)
    )
    table.insert(0, "σ", one.sigma)
    text = (
        "J turned into independent directions: turning the joints along a row of Vᵀ moves the "
        "effectors along the same column of U, σ metres per radian."
    )
    return Page("J = U Σ Vᵀ", text, png_of(figure), alt, table)


def directions_page(one: Anatomy, names: Names) -> Page:
    """Show how each method treats each singular direction."""
    number = [str(i + 1) for i in range(len(one.sigma))]
    figure = Figure(figsize=(10, 4.8), dpi=100, layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=[1, 2])
    above.bar(number, 100 * abs(one.alpha), color="0.45")
    above.set(title="|α| = |uᵀe|: how much of the error lies along each direction [cm]")
    above.grid(axis="y", alpha=0.3)
    _bars(below, number, one.filters)
    below.set(xlabel="singular direction, strongest first", ylabel="filter factor")
    below.set_title("σ f: the share of it that a step takes away (1 is all)")
    below.axhline(1, color="0.3", lw=0.8, ls=":")
    each = "; ".join(
        f"{name}: {_list(f'{value:.2f}' for value in values)}"
        for name, values in one.filters.items()
    )
    alt = (
        f"Bars for each of {len(number)} singular directions, strongest first. Share of the error "
        f"along it that a step takes away. {each}. The tick is taken by {one.method}."
    )
    table = pd.DataFrame({"σ": one.sigma, "α": one.alpha}, index=pd.Index(number, name="direction"))
    for name, f in one.responses.items():
        table[f"f of {name}"], table[f"σ f of {name}"] = f, one.filters[name]
    text = (
        "Every method answers Δθ = Σ f α v, direction by direction. They differ in f alone: whom "
        "they trust, whom they damp, whom they leave out."
    )
    return Page("What each method does to each direction", text, png_of(figure), alt, table)


def step_page(one: Anatomy, names: Names) -> Page:
    """Show Δθ before and after cap and limits."""
    stages = {"wanted": one.wanted, "after the cap": one.capped, "after the limits": one.dtheta}
    degrees = {name: np.degrees(values) for name, values in stages.items()}
    figure = Figure(figsize=(10, 4.6), dpi=100, layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True)
    _bars(above, names.joints, {"wanted": degrees.pop("wanted")})
    above.set(ylabel="Δθ [°]", title="what the solver asks of each joint")
    _bars(below, names.joints, degrees, first=1)
    below.set(ylabel="Δθ [°]", title="what is left of it")
    _turn(below)
    held = [name for name, stopped in zip(names.joints, one.held, strict=True) if stopped]
    top = below.get_xaxis_transform()
    for name in held:
        at = list(names.joints).index(name)
        below.text(at, 0.05, "held", fontsize=8, ha="center", transform=top, weight="bold")
    most = "; ".join(
        f"{name}: {_most(np.degrees(values), names.joints, '°')}" for name, values in stages.items()
    )
    shortened = not np.array_equal(one.wanted, one.capped)
    alt = (
        f"Bars of the step of each joint. Largest, {most}. The cap "
        f"{'shortened' if shortened else 'did not shorten'} the step. Held by limits: "
        f"{', '.join(held) or 'none'}."
    )
    table = pd.DataFrame(
        {name: np.degrees(values) for name, values in stages.items()}, index=list(names.joints)
    )
    table["held"] = one.held
    text = "What the solver asks for, what the cap leaves, and what the joints' limits let by."
    return Page("Δθ, before and after cap and limits", text, png_of(figure), alt, table)


def movement_page(one: Anatomy, names: Names) -> Page:
    """Show predicted against actual movement."""
    figure, axes = _figure()
    moved = {"predicted: JΔθ": one.predicted.ravel(), "actual": one.actual.ravel()}
    _bars(axes, names.rows, {name: 100 * values for name, values in moved.items()})
    axes.set(ylabel="movement [cm]", title="how far the effectors go in this tick")
    _turn(axes)
    miss = np.linalg.norm(one.actual - one.predicted, axis=1)
    went = np.linalg.norm(one.actual, axis=1)
    each = _list(
        f"{name} went {100 * w:.2f} cm, {100 * m:.2f} cm from where J had said"
        for name, w, m in zip(names.effectors, went, miss, strict=True)
    )
    table = pd.DataFrame({"wanted: e": one.e, **moved}, index=names.rows)
    text = (
        "J speaks of small steps. What it predicts and what happens part with the square of the "
        "step: half the step, a quarter of the gap."
    )
    words = f"Bars of movement. {each}."
    return Page("Predicted against actual", text, png_of(figure), words, table)


PAGES: Sequence[Callable[[Anatomy, Names], Page]] = (
    error_page,
    jacobian_page,
    svd_page,
    directions_page,
    step_page,
    movement_page,
)


def _figure(height: float = 3.8) -> tuple[Figure, Axes]:
    figure = Figure(figsize=(10, height), dpi=100, layout="constrained")
    return figure, figure.subplots()


def _turn(axes: Axes, size: int = 8) -> None:
    """Write the labels below slantwise: they are long."""
    for label in axes.get_xticklabels():
        label.set(rotation=60, ha="right", rotation_mode="anchor", fontsize=size)


def _bars(axes: Axes, labels: Sequence[str], groups: dict[str, Array], first: int = 0) -> None:
    charts.draw_bars(axes, labels, groups, first=first)
    axes.axhline(0, color="0.3", lw=0.8)
    axes.legend(fontsize=8, ncols=len(groups))


def _heat(axes: Axes, matrix: Array, rows: Sequence[str], columns: Sequence[str]) -> Any:
    """Draw a matrix in colours, long names of columns slantwise; give the image."""
    image = charts.draw_heat(axes, matrix, rows, columns)
    if max(map(len, columns), default=0) > 2:
        _turn(axes, 8 if len(columns) <= 14 else 7)
    return image


def _number(axes: Axes, matrix: Array) -> None:
    """Write into its squares the numbers of a matrix that is not too large."""
    most = abs(matrix).max()
    for (i, j), value in np.ndenumerate(matrix if matrix.size <= 400 else np.zeros((0, 0))):
        if abs(value) >= 0.005:
            ink = "white" if abs(value) > 0.6 * most else "0.2"
            axes.text(j, i, f"{value:.2f}", ha="center", va="center", fontsize=6, color=ink)


def _most(values: Array, names: Sequence[str], unit: str = "") -> str:
    """Name the largest, and how large it is."""
    i = int(abs(values).argmax())
    return f"{names[i]} by {values[i]:.2f}{unit}"


def _list(parts: Any) -> str:
    return ", ".join(parts)
