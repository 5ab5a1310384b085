"""Chapter 1's live figure: the columns of J as arrows, by formula or by differences."""

from typing import Any

import numpy as np

from ikteach.arrays import Array
from ikteach.body import forward, jacobian, locate
from ikteach.body.figures import Figure
from ikteach.body.partials import by_differences
from ikteach.markup import Markup
from ikteach.view.live.bench import Bench, Shown
from ikteach.view.live.joints import Joints
from ikteach.view.live.panel import choice, dropdown, log_slider
from ikteach.view.live.pull import handles_of, pull
from ikteach.view.webgl.scene import Scene
from ikteach.view.widgets import doors

WAYS = ("v × (s − p)", "finite differences")


class ColumnPoser(Bench):
    """A figure posed by sliders, with columns of J.

    The columns at one effector are arrows: half a metre on the screen is 1 m/rad. They are those of
    the formula, or of differences.
    """

    def __init__(self, figure: Figure, *, slot: str | None = "columns") -> None:
        tree, effectors = figure = doors.figure(figure)
        joints = Joints(figure)
        scene = Scene(*figure, width=460, height=480, slot=None)
        handles = handles_of(scene, joints)
        names = list(effectors.names)
        options = {
            "effector": dropdown("effector", names, names[-1]),
            "way": choice("columns by", list(WAYS)),
            "h": log_slider("h of the differences [rad]", 1e-3, -6.0, 0.5, readout_format=".0e"),
        }

        def show(*, effector: str, way: str, h: float, **values: Any) -> Shown:
            theta, i = joints.theta(values), names.index(effector)
            frames = forward(tree, theta)
            rows = slice(3 * i, 3 * i + 3)
            J = jacobian(tree, frames, effectors)[rows]
            differences = by_differences(tree, theta, effectors, h=h)[rows]
            columns = J if way == WAYS[0] else differences
            s = locate(frames, effectors)
            handles.follow(s)
            scene.show(theta, s, effector=i, columns=columns)
            least = 1e-9 * scene.stage.unit  # of what is no rounding [m/rad]
            moved = np.flatnonzero(abs(J).max(axis=0) > least)
            words = (
                f"{len(moved)} of {len(tree)} columns move {effector}. Formula and differences "
                f"with h = {h:.2g} rad differ by at most {abs(J - differences).max():.2g} m/rad."
            )
            return _lengths(words, tree.names, columns, least)

        panel = [*options.values(), joints.widget]
        super().__init__(show, options | joints.controls, slot=slot, scene=scene, panel=panel)
        self.joints, self.targets = joints, handles
        pull(self, handles, joints)
        scene.switch("columns of J")

    def theta(self) -> Array:
        """Give the pose of the sliders, (n,) [rad or m]."""
        return self.joints.theta(self.values)


def _lengths(words: str, joints: tuple[str, ...], columns: Array, least: float) -> Shown:
    """Say how long the columns (3, n) are that are longer than `least`."""
    lengths = ", ".join(
        f"{name} {length:.3g}"
        for name, length in zip(joints, np.linalg.norm(columns, axis=0), strict=True)
        if length > least
    )
    below = Markup("<p>{}<br>Lengths [m/rad]: {}.</p>").format(words, lengths)
    return Shown(b"", f"{words} Lengths: {lengths}.", below)
