"""One, two or four views of a scene at once, all drawn by one renderer (see panes.js)."""

from typing import Any

import pythreejs as three

from ikteach.view.stage.stage import CAMERAS, Stage
from ikteach.view.stage.views import checked_views, views_of
from ikteach.view.webgl.cameras import Cameras
from ikteach.view.widgets.closing import close_all


class Views:
    """The views of a scene, and the renderer that draws them.

    The first is free; those beside it are parallel projections from fixed sides, until turned.

    scene  what they show
    size   (width, height) of the picture [pixels]

    free   the cameras of the first view
    """

    def __init__(self, stage: Stage, scene: three.Scene, size: tuple[int, int]) -> None:
        self._stage, self._scene, self._aspect = stage, scene, size[0] / size[1]
        self.free = Cameras(stage, self._aspect, switched=self._show)
        self._side, self._count = stage.side, 1
        self._beside: dict[str, Cameras] = {}
        self.renderer = three.Renderer(
            scene=scene,
            camera=self.free.current,
            antialias=False,
            width=size[0],
            height=size[1],
            controls=[self.free.turning],
        )

    @property
    def count(self) -> int:
        """Tell how many views there are; may be set, ValueError."""
        return self._count

    @count.setter
    def count(self, count: int) -> None:
        self._count = checked_views(self._stage, count)
        before, beside = self._beside, self._names[1:]
        self._beside = {name: before.get(name) or self._from(name) for name in beside}
        self._show()
        for name, one in before.items():
            if name not in beside:
                close_all(one.current, one.turning)

    @property
    def more(self) -> int:
        """Give the number of views that comes next.

        After the most it is one again.
        """
        counts = [*views_of(self._stage)]
        return counts[(counts.index(self._count) + 1) % len(counts)]

    @property
    def panes(self) -> list[dict[str, Any]]:
        """List names of views, and ways (3,) to their cameras.

        The free one has no way.
        """
        return [{"name": name, "way": CAMERAS.get(name)} for name in self._names]

    def look_from(self, side: str) -> None:
        """Put the first camera to a side.

        LookupError for an unknown one.
        """
        self.free.look_from(side)
        self._side = side

    def put_back(self, view: int) -> None:
        """Put the camera of a view back to its side."""
        if 0 < view < self._count:
            name = self._names[view]
            self._beside[name].look_from(name)
        else:
            self.free.look_from(self._side)

    def _from(self, side: str) -> Cameras:
        """Make the camera of a view from a side."""
        cameras = Cameras(self._stage, self._aspect, parallel=True)
        cameras.look_from(side)
        return cameras

    @property
    def _names(self) -> tuple[str, ...]:
        return views_of(self._stage)[self._count]

    def _show(self) -> None:
        """Have the renderer draw by the cameras in use."""
        shown = [self.free, *self._beside.values()]
        # The scene listens to what is in it, so that a turned camera has it drawn again.
        there = self._scene.children
        new = [one.current for one in shown if one.current not in there]
        if first := [camera for camera in new if camera is not self.free.perspective]:
            self._scene.children = [*there, *first]
        with self.renderer.hold_sync():
            self.renderer.camera = self.free.current
            self.renderer.controls = [one.turning for one in shown]
