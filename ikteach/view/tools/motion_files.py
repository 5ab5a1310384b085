"""A panel that brings motions in from files, and takes what was played to other programs."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import ipywidgets as widgets
import numpy as np

from ikteach.checks import function
from ikteach.files import write_whole
from ikteach.formats.bvh import read_bvh, write_bvh
from ikteach.formats.gltf import write_glb
from ikteach.motion.live.session import Session
from ikteach.motion.path import Motion
from ikteach.study.walks import imported
from ikteach.view.live.panel import tick_box
from ikteach.view.tools.recorder import LABEL
from ikteach.view.widgets import doors
from ikteach.view.widgets.cell import Cell

MOST_NAME = 40  # letters of a file's name that become the motion's


class MotionFiles(Cell):
    """A panel for motions as files.

    What was played is saved as BVH, or as glTF; a recording of a person, a BVH file, becomes a
    motion of the targets.

    session  whose record is saved, as the shown method made it, with its way over the ground
    take     is given the motion that was opened

    Whatever the unit of a file that is opened: the motion has the size of our legs.
    """

    def __init__(
        self,
        session: Session,
        take: Callable[[Motion], object],
        *,
        folder: str | Path = ".",
        slot: str | None = "motion files",
    ) -> None:
        session, folder = doors.a(Session, "session", session), doors.folder(folder)
        take = function("take", take)
        super().__init__(slot)
        self.session, self.folder, self._take = session, folder, take
        self.name = widgets.Text(value="played", description="Motion file", style=LABEL)
        self.replace = tick_box("replace a file of that name")
        self.bvh = self.button("Save as BVH", self._save_bvh)
        self.glb = self.button("Save as GLB", self._save_glb)
        self.opening = self.button("Open a BVH file as a motion", self._open)
        self.children = [
            self.name,
            self.replace,
            widgets.HBox([self.bvh, self.glb, self.opening], layout={"flex_flow": "row wrap"}),
            self.status,
        ]

    def _path(self, ending: str) -> Path:
        """Join name and ending to a file."""
        name = self.name.value.strip()
        if not name:
            raise ValueError("the motion needs a file name")
        name = name if name.lower().endswith(ending) else name + ending
        return self.folder / name

    def _played(self) -> dict[str, Any]:
        """Give what was played, as the writers take it."""
        log = self.session.log()
        if not len(log):
            raise ValueError("there is nothing to save yet: let the figure move first")
        dt = log.dt * float(np.diff(log.tick).mean()) if len(log) > 1 else log.dt
        way = np.zeros((len(log), 3))
        way[:, 2] = log.advance
        return {"run": log.tracks()[self.session.method], "way": way, "dt": dt}

    def _save_bvh(self) -> None:
        self._write(self._path(".bvh"), write_bvh(**self._played()))

    def _save_glb(self) -> None:
        self._write(self._path(".glb"), write_glb(**self._played(), name=self.session.gait.name))

    def _write(self, path: Path, content: str | bytes) -> None:
        try:
            write_whole(path, content, overwrite=self.replace.value)
        except FileExistsError as error:
            words = str(error).partition(";")[0]
            raise FileExistsError(f"{words}; tick the box to replace it") from None
        frames = len(self.session.record)
        self.status.say(f"{frames} frames by {self.session.method} are saved in {path}.")

    def _open(self) -> None:
        path = self._path(".bvh")
        motion = imported(read_bvh(path), path.stem[:MOST_NAME])
        self._take(motion)
        said = " ".join(motion.notes)
        self.status.say(f"{path.name} is open: {motion.span:.1f} s, among the motions. {said}")
