"""Recorded motion: BVH files, the text in which motion capture is exchanged.

A BVH joint with c channels is c rows of a `Tree`, all at one place: its position channels first, as
slides, then its rotation channels in the order of the file, as hinges.
"""

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from math import radians
from pathlib import Path
from typing import NamedTuple, Protocol

import numpy as np

from ikteach.arrays import Array, ArrayLike
from ikteach.body import Effectors, Joint, Tree, forward
from ikteach.checks import number, numbers, shown
from ikteach.formats.source import MOST_JOINTS, content

AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
CHANNEL = re.compile(r"([xyz])(position|rotation)", re.IGNORECASE)
DATA = Path(__file__).parents[1] / "data"
LARGEST_BVH = 64 * 2**20  # bytes of a file
LINE = re.compile(r"\r\n|\r|\n")  # and no other: names may hold what Unicode takes for an end
WIDE = (b"\xff\xfe", b"\xfe\xff")  # what UTF-16 begins with


class Recording(NamedTuple):
    """A body and how it moved: poses theta (T, n), dt seconds apart.

    tree, effectors  the effectors are the ends of the skeleton, named "<joint>.end"
    theta            (T, n) [rad, or m for slides]
    dt               [s]
    """

    tree: Tree
    effectors: Effectors
    theta: Array
    dt: float

    @property
    def times(self) -> Array:
        """Time of each frame, the first at 0, (T,) [s]."""
        return np.asarray(self.dt * np.arange(len(self.theta)), dtype=float)


def read_bvh(source: str | Path, *, scale: float = 1.0) -> Recording:
    """Read a BVH file, or its text, as body and poses.

    source  a path, or the text itself, of more than one line
    scale   metres per unit of the file, for lengths and positions

    Effectors are the End Sites in the order of the file, and joints from which nothing hangs and
    that lack one. A joint without channels is folded into its children. A position channel adds to
    the joint's OFFSET, where Blender puts it in its place: the two differ only where a joint has
    both. A file whose position channels repeat the OFFSETs of its joints means the latter, and is
    read so. ValueError names the line that is wrong; OSError if there is no such file.
    """
    if not (scale := number("scale", scale)):
        raise ValueError("scale must be more than 0")
    lines = Lines(_decoded(content(source, LARGEST_BVH, "BVH")))
    nodes = _hierarchy(lines)
    rows, columns, ends = _rows(nodes, scale)
    if not rows:
        raise ValueError("BVH: no joint has channels, so nothing moves")
    frames, dt = _frame_lines(lines)
    units = np.array([scale if row.slide else radians(1) for row in rows])
    table = _table(lines, frames, len(rows))
    theta = (table - _repeated(nodes, table))[:, columns] * units
    tree = Tree.of(rows)
    return Recording(tree, Effectors.of(tree, ends), theta, dt)


def recorded_walk() -> Recording:
    """Read the recorded walk that comes with the package.

    131 frames at 30 Hz; "This data was obtained from mocap.cs.cmu.edu" (`ikteach/data/README.md`).
    """
    return read_bvh(DATA / "cmu_12_01_walk.bvh", scale=0.056444)


def _decoded(data: bytes) -> str:
    """Decode UTF-8 or, with its mark, UTF-16; what is neither becomes �, in names alone."""
    text = data.decode("utf-16" if data.startswith(WIDE) else "utf-8-sig", errors="replace")
    if "\0" in text:
        raise ValueError("BVH: this is not text")
    return text


class Line(NamedTuple):
    """A line of the file that says something.

    It has its number, its words and all of its text.
    """

    number: int
    words: list[str]
    text: str

    @property
    def keyword(self) -> str:
        """Its first word, in capitals."""
        return self.words[0].upper()

    def wrong(self, why: str) -> ValueError:
        """Say what is wrong with this line."""
        return ValueError(f"BVH, line {self.number}: {why}: {shown(self.text)}")

    def numbers(self, words: Sequence[str], count: int) -> Array:
        """Read so many finite numbers, (count,)."""
        if len(words) != count:
            raise self.wrong(f"{count} numbers are wanted, not {len(words)}")
        try:
            values = np.array(words, dtype=float)
        except ValueError:
            values = None
        if values is None or "_" in self.text:  # which Python takes for part of a number
            if re.search(r"\d,\d", self.text):
                raise self.wrong("numbers have a decimal point, and no comma")
            raise self.wrong("there is a word where a number should be")
        if not np.isfinite(values).all():
            raise self.wrong("a number is not finite")
        return values


class Lines:
    """The lines that say something, one after the other.

    A brace stands alone, wherever the file has it; what begins with # or // is a comment.
    """

    def __init__(self, text: str) -> None:
        self.number = 0
        self._lines = self._all(text)

    def _all(self, text: str) -> Iterator[Line]:
        for self.number, line in enumerate(LINE.split(text), start=1):
            if not line.lstrip().startswith(("#", "//")):
                for part in re.split(r"([{}])", line):
                    if words := part.split():
                        yield Line(self.number, words, line.strip())

    def __iter__(self) -> Iterator[Line]:
        return self._lines

    def expect(self, what: str) -> Line:
        """Go to the next line.

        ValueError if the file ends before it.
        """
        for line in self._lines:
            return line
        raise ValueError(f"BVH, line {self.number}: the file ends where {what} should be")


class Channel(NamedTuple):
    """A column of the table of frames; positions sort before rotations."""

    turns: bool
    column: int
    axis: str

    @property
    def suffix(self) -> str:
        """What its row's name has behind that of the joint."""
        return f"{self.axis}{'' if self.turns else 'pos'}"


@dataclass
class Node:
    """A joint of the file, or an End Site.

    `above` is None for a ROOT.
    """

    name: str
    above: "Node | None"
    is_end: bool
    offset: Array | None = None  # in units of the file
    channels: list[Channel] = field(default_factory=list)
    bare: bool = True  # nothing hangs from it
    row: str | None = None  # the row that carries what hangs from it,
    at: Array = field(default_factory=lambda: np.zeros(3))  # and where in its frame [m]

    def read_offset(self, line: Line) -> None:
        """Read its OFFSET."""
        if self.offset is not None:
            raise line.wrong(f"a second OFFSET of {shown(self.name)}")
        self.offset = line.numbers(line.words[1:], 3)

    def read_channels(self, line: Line, column: int) -> int:
        """Read its CHANNELS, from this column on; return the next."""
        words = line.words[2:]
        if self.is_end or self.channels:
            raise line.wrong(f"these are no CHANNELS for {shown(self.name)}")
        if line.words[1:2] != [str(len(words))]:
            raise line.wrong("CHANNELS is followed by their number and their names")
        for at, word in enumerate(words, start=column):
            match = CHANNEL.fullmatch(word)
            if match is None:
                raise line.wrong(f"there is no channel {shown(word)}")
            self.channels.append(Channel(match[2].lower() == "rotation", at, match[1].lower()))
        if len({channel.suffix for channel in self.channels}) < len(words):
            raise line.wrong("a channel stands here twice")
        return column + len(words)


def _hierarchy(lines: Lines) -> list[Node]:
    """Read from HIERARCHY to MOTION: the joints and End Sites, in the order of the file."""
    line = lines.expect("HIERARCHY")
    if line.keyword != "HIERARCHY":
        raise line.wrong("a BVH file begins with HIERARCHY")
    nodes: list[Node] = []
    taken: set[str] = set()
    inside: list[Node] = []  # those whose brace is open
    opening: Node | None = None  # that whose brace comes next
    column = 0
    while (line := lines.expect("MOTION")).keyword != "MOTION":
        if opening is not None:
            if line.keyword != "{":
                raise line.wrong("a brace { is missing before this")
            nodes.append(opening)
            inside.append(opening)
            opening = None
        elif line.keyword in ("ROOT", "JOINT", "END"):
            opening = _opened(line, inside[-1] if inside else None, taken)
        elif not inside:
            raise line.wrong("this means nothing here")
        elif line.keyword == "OFFSET":
            inside[-1].read_offset(line)
        elif line.keyword == "CHANNELS":
            column = inside[-1].read_channels(line, column)
        elif line.keyword == "}":
            if (node := inside.pop()).offset is None:
                raise line.wrong(f"{shown(node.name)} ends without an OFFSET")
        else:
            raise line.wrong("this means nothing here")
    if inside or opening:
        raise line.wrong(f"{shown((opening or inside[-1]).name)} has no closing brace }}")
    return nodes


def _opened(line: Line, above: Node | None, taken: set[str]) -> Node:
    """Begin a joint, or an End Site."""
    is_end = line.keyword == "END"
    if (line.keyword == "ROOT") != (above is None):
        raise line.wrong("this hangs from nothing" if above is None else "a ROOT inside a joint")
    if above is not None:
        if above.is_end:
            raise line.wrong("nothing hangs from an End Site")
        above.bare = False
    name = f"{above.name}.end" if is_end and above else " ".join(line.words[1:]) or "joint"
    if len(taken) == MOST_JOINTS:
        raise line.wrong(f"a body has at most {MOST_JOINTS} joints and ends")
    return Node(_free(name, taken), above, is_end)


def _free(name: str, taken: set[str]) -> str:
    """Take a name that is free: in a file two joints may have one, in a tree not."""
    free, count = name, 1
    while free in taken:
        count += 1
        free = f"{name}.{count}"
    taken.add(free)
    return free


Ends = dict[str, tuple[str, Sequence[float]]]


def _rows(nodes: list[Node], scale: float) -> tuple[list[Joint], list[int], Ends]:
    """Make rows, the column that moves each, and the ends."""
    rows: list[Joint] = []
    columns: list[int] = []
    ends: Ends = {}
    taken = {node.name for node in nodes}
    for node in nodes:
        if node.above is not None:
            node.row, node.at = node.above.row, node.above.at
        node.at = node.at + scale * np.asarray(node.offset)
        for channel in sorted(node.channels):
            name = f"{node.name}.{channel.suffix}"
            place, axis = node.at.tolist(), AXES[channel.axis]
            rows.append(Joint(name, node.row, place, axis, slide=not channel.turns))
            columns.append(channel.column)
            node.row, node.at = name, np.zeros(3)
        if node.bare and node.row is not None:
            name = node.name if node.is_end else _free(f"{node.name}.end", taken)
            ends[name] = (node.row, node.at.tolist())
    return rows, columns, ends


def _frame_lines(lines: Lines) -> tuple[int, float]:
    """Read how many frames there are, and how many seconds apart."""
    line = lines.expect("Frames:")
    match = re.fullmatch(r"Frames\s*:\s*([0-9]{1,9})", line.text, re.IGNORECASE)
    if match is None:
        raise line.wrong("after MOTION comes 'Frames:' and their number")
    frames = int(match[1])
    line = lines.expect("Frame Time:")
    match = re.fullmatch(r"Frame\s+Time\s*:\s*(\S+)", line.text, re.IGNORECASE)
    if match is None:
        raise line.wrong("after Frames comes 'Frame Time:' and seconds")
    dt = float(line.numbers([match[1]], 1)[0])
    if not dt > 0:
        raise line.wrong("the time of a frame must be more than 0")
    return frames, dt


def _table(lines: Lines, frames: int, columns: int) -> Array:
    """Read the values of the channels, (frames, columns)."""
    rows: list[Array] = []
    for line in lines:
        if len(rows) == frames:
            raise line.wrong(f"there are more than the {frames} frames that were announced")
        rows.append(line.numbers(line.words, columns))
    if len(rows) < frames:
        said = f"{frames} frames are announced, and the file ends after {len(rows)}"
        raise ValueError(f"BVH, line {lines.number}: {said}")
    return np.array(rows).reshape(frames, columns)


def _repeated(nodes: list[Node], table: Array) -> Array:
    """Find what position channels repeat of the OFFSETs, by column (c,) [units of the file].

    They do if they are nearer to the OFFSETs than to nothing, of all joints below a ROOT together.
    """
    offsets, places = np.zeros(table.shape[1]), np.zeros(table.shape[1], dtype=bool)
    for node in nodes:
        for channel in node.channels if node.above is not None else ():
            if not channel.turns and node.offset is not None:
                offsets[channel.column] = node.offset["xyz".index(channel.axis)]
                places[channel.column] = True
    if not len(table) or not offsets.any():
        return np.zeros(table.shape[1])
    usual = np.where(places, np.median(table, axis=0), 0)
    repeat = np.linalg.norm(usual - offsets) < np.linalg.norm(usual)
    return offsets * repeat


class Run(Protocol):
    """What can be written: a `Recording`, a `Track`, anything with these."""

    @property
    def tree(self) -> Tree:
        """The body."""

    @property
    def effectors(self) -> Effectors:
        """Its effectors."""

    @property
    def theta(self) -> Array:
        """Its poses, (T, n)."""

    @property
    def times(self) -> Array:
        """The time of each, (T,) [s]."""


def poses_of(run: Run, dt: float | None, way: ArrayLike | None) -> tuple[Array, float, Array]:
    """Check poses (T, n), seconds a frame, and the way (T, 3).

    ValueError for a run of several poses at once, and for a way of another length.
    """
    theta = numbers("theta", run.theta)
    if theta.ndim != 2:
        raise ValueError(f"a file holds one run, theta (T, n), not {theta.shape}")
    if dt is None:
        dt = float(np.diff(run.times).mean()) if len(theta) > 1 else 1 / 30
    if not (dt := number("dt", dt)):
        raise ValueError("dt must be more than 0")
    gone = np.zeros((len(theta), 3)) if way is None else numbers("way", way)
    if gone.shape != (len(theta), 3) or not np.isfinite(gone).all():
        raise ValueError(f"way needs finite numbers ({len(theta)}, 3), not {gone.shape}")
    return theta, dt, gone


def write_bvh(
    run: Run, *, scale: float = 100.0, dt: float | None = None, way: ArrayLike | None = None
) -> str:
    """Write a run as the text of a BVH file.

    scale  units of the file per metre: 100 makes centimetres, which `read_bvh(…, scale=0.01)` reads
    dt     seconds per frame; the mean of the run's if not given
    way    (T, 3) [m] where the ground under the figure has gone, as a treadmill goes

    Rows that stand in one place, one on the other, become one joint with three rotation channels,
    and with three position channels if a slide is among them or it is the ROOT. Where their axes
    are x, y and z, each at most once, the channels are the angles themselves; else the joint's turn
    is written as z, y, x. A body with several joints on the ground, or with a way, gets a ROOT
    "ground". ValueError if a shape is wrong or a number not finite.
    """
    if not (scale := number("scale", scale)):
        raise ValueError("scale must be more than 0")
    theta, dt, gone = poses_of(run, dt, way)
    writer = _Writer(run.tree, run.effectors, theta, scale)
    head = writer.hierarchy(gone)
    table = np.concatenate(writer.values, axis=1)
    frames = [f"Frames: {len(theta)}", f"Frame Time: {dt:.12g}"]
    rows = [" ".join(f"{value:.12g}" for value in row) for row in table + 0.0]
    return "\n".join([*head, "MOTION", *frames, *rows, ""])


class _Writer:
    """A body as it is written: its rows in groups, the values (T, c) of their channels."""

    def __init__(self, tree: Tree, effectors: Effectors, theta: Array, scale: float) -> None:
        self.tree, self.effectors, self.theta, self.scale = tree, effectors, theta, scale
        self.frames = forward(tree, theta)
        self.groups = _groups(tree, effectors)
        group_of = {j: g for g, rows in enumerate(self.groups) for j in rows}
        above = [int(tree.parents[rows[0]]) for rows in self.groups]
        self.children: dict[int, list[int]] = {g: [] for g in range(-1, len(self.groups))}
        for g, j in enumerate(above):
            self.children[group_of.get(j, -1)].append(g)
        self.values: list[Array] = []

    def hierarchy(self, way: Array) -> list[str]:
        """Write the lines from HIERARCHY on, and keep the values."""
        tops = self.children[-1]
        alone = len(tops) == 1 and not way.any()
        todo: list[tuple[int, int | str]] = []  # how deep, and a group or a brace that closes
        lines = ["HIERARCHY"]
        if not alone:
            gone = [self.scale * way, np.zeros_like(way)]
            lines += self._joint(0, "ROOT ground", np.zeros(3), XYZ + ZYX, gone)
            todo.append((0, "}"))
        todo += [(0 if alone else 1, g) for g in reversed(tops)]
        while todo:
            depth, item = todo.pop()
            if isinstance(item, str):
                lines.append("\t" * depth + item)
                continue
            rows, kind = self.groups[item], "JOINT" if depth else "ROOT"
            kind = f"{kind} {self._name(rows)}"
            offset = self.tree.offsets[rows[0]]
            lines += self._joint(depth, kind, offset, *self._channels(rows, depth == 0))
            lines += self._ends(item, depth + 1)
            todo.append((depth, "}"))
            todo += [(depth + 1, child) for child in reversed(self.children[item])]
        return lines

    def _joint(
        self, depth: int, name: str, offset: Array, channels: list[str], values: list[Array]
    ) -> list[str]:
        """Write the first lines of a joint."""
        self.values += values
        inside = [f"OFFSET {self._place(offset)}", f"CHANNELS {len(channels)} {' '.join(channels)}"]
        tab = "\t" * depth
        return [f"{tab}{name}", f"{tab}{{", *(f"{tab}\t{line}" for line in inside)]

    def _ends(self, group: int, depth: int) -> list[str]:
        """Write the End Sites of a group; one whose effectors are elsewhere ends in its place."""
        rows, tab = self.groups[group], "\t" * depth
        ends = [self.effectors.offsets[i] for i in _points(self.effectors, rows[-1])]
        if not ends and not self.children[group]:
            ends = [np.zeros(3)]
        lines: list[str] = []
        for end in ends:
            lines += [f"{tab}End Site", f"{tab}{{", f"{tab}\tOFFSET {self._place(end)}", f"{tab}}}"]
        return lines

    def _name(self, rows: list[int]) -> str:
        """Name a group by what its rows' names have in common, or by its last row."""
        names = [self.tree.names[j] for j in rows]
        stems = {re.sub(r"\.[xyz](pos|\.slide)?$", "", name) for name in names}
        return re.sub(r"[\s{}]+", "_", stems.pop() if len(stems) == 1 else names[-1])

    def _place(self, offset: Array) -> str:
        return " ".join(f"{self.scale * x:.12g}" for x in offset)

    def _channels(self, rows: list[int], is_root: bool) -> tuple[list[str], list[Array]]:
        """Name the channels of a group, and give their values (T, c)."""
        tree, above = self.tree, int(self.tree.parents[rows[0]])
        still = above < 0
        p = np.zeros(3) if still else self.frames.positions[:, above]
        R = np.eye(3) if still else self.frames.orientations[:, above]
        names: list[str] = []
        values: list[Array] = []
        if tree.slide[rows].any() or is_root:  # many programs want a ROOT that can go
            at = np.matvec(np.swapaxes(R, -1, -2), self.frames.positions[:, rows[-1]] - p)
            names += XYZ
            values.append(self.scale * (at - tree.offsets[rows[0]]))
        hinges = [j for j in rows if not tree.slide[j]]
        letters = [_letter(tree.axes[j]) for j in hinges]
        if "" not in letters and len(set(letters)) == len(letters):
            letters += [letter for letter in "ZYX" if letter not in letters]
            angles = np.zeros((len(self.theta), 3))
            angles[:, : len(hinges)] = self.theta[:, hinges] * tree.axes[hinges].sum(axis=-1)  # ±1
            names += [f"{letter}rotation" for letter in letters]
        else:
            angles = zyx(np.swapaxes(R, -1, -2) @ self.frames.orientations[:, rows[-1]])
            names += ZYX
        return names, [*values, np.degrees(angles)]


XYZ = ["Xposition", "Yposition", "Zposition"]
ZYX = ["Zrotation", "Yrotation", "Xrotation"]


def _groups(tree: Tree, effectors: Effectors) -> list[list[int]]:
    """Find the rows of each place: chains in which nothing hangs between one row and the next.

    Slides come first in a group, as BVH has it.
    """
    children = Counter(tree.parents.tolist())
    carriers = set(effectors.joints.tolist())
    group: dict[int, list[int]] = {}
    for j, above in enumerate(tree.parents.tolist()):
        joins = (
            above in group
            and children[above] == 1
            and above not in carriers
            and not tree.offsets[j].any()
            and not (tree.slide[j] and not tree.slide[above])
        )
        group[j] = group[above] if joins else []
        group[j].append(j)
    return list({id(rows): rows for rows in group.values()}.values())


def _points(effectors: Effectors, joint: int) -> list[int]:
    """Find the effectors of a joint that are points."""
    return np.flatnonzero((effectors.joints == joint) & (effectors.w == 1)).tolist()


def _letter(axis: Array) -> str:
    """X, Y or Z if the axis is one of these, either way round, else nothing."""
    return "XYZ"[int(abs(axis).argmax())] if abs(axis).max() == 1 else ""


def zyx(R: Array) -> Array:
    """Find the angles (T, 3) about z, y and x [rad] with R = Rz Ry Rx.

    They do not leap from frame to frame.
    """
    y = np.arctan2(-R[..., 2, 0], np.hypot(R[..., 0, 0], R[..., 1, 0]))
    z = np.arctan2(R[..., 1, 0], R[..., 0, 0])
    x = np.arctan2(R[..., 2, 1], R[..., 2, 2])
    return np.stack([np.unwrap(z, axis=0), y, np.unwrap(x, axis=0)], axis=-1)
