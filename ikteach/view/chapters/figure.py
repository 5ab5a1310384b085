"""Chapter 0's live figure: posed by sliders, it says where its effectors are."""

from typing import Any

from ikteach.arrays import Array
from ikteach.body import forward, locate
from ikteach.body.figures import Figure
from ikteach.markup import minus
from ikteach.view.live.bench import Bench, Shown
from ikteach.view.live.joints import Joints
from ikteach.view.live.pull import handles_of, pull
from ikteach.view.stage.lengths import Lengths
from ikteach.view.webgl.scene import Scene
from ikteach.view.widgets import doors
from ikteach.view.widgets.prose import grid


class Poser(Bench):
    """A figure with a slider for each joint.

    Each slider goes from limit to limit; balls mark the effectors, and can be pulled.
    """

    def __init__(self, figure: Figure, *, slot: str | None = "poser") -> None:
        figure = doors.figure(figure)
        joints = Joints(figure)
        scene = Scene(*figure, width=460, height=480, slot=None)
        handles = handles_of(scene, joints)

        def show(**values: Any) -> Shown:
            theta = joints.theta(values)
            s = locate(forward(figure.tree, theta), figure.effectors)
            handles.follow(s)
            scene.show(theta, s)
            return _places(figure, s, Lengths.of_places(scene.stage.extent.radius))

        super().__init__(show, joints.controls, slot=slot, scene=scene, panel=[joints.widget])
        self.joints, self.targets = joints, handles
        pull(self, handles, joints)

    def theta(self) -> Array:
        """Give the pose of the sliders, (n,) [rad or m]."""
        return self.joints.theta(self.values)


def _places(figure: Figure, s: Array, unit: Lengths) -> Shown:
    """Say where the effectors s (k, 3) are."""
    tree, effectors = figure
    places = list(zip(effectors.names, s, strict=True))
    rows = [[name, *(minus(unit.number(x, 3)) for x in place)] for name, place in places]
    heads = ["", "x (left)", "y (up)", "z (forward)"]
    words = ", ".join(
        f"{name} ({', '.join(minus(unit.number(x, 2)) for x in place)})" for name, place in places
    )
    return Shown(
        b"",
        f"A figure of {len(tree)} joints. Its effectors, in {unit.name}: {words}.",
        grid(heads, rows, f"where the effectors are [{unit.name}]"),
    )
