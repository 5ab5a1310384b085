"""Recorded motion: BVH files, the text that motion capture is exchanged in.

A BVH joint with c channels is c rows of a `Tree`: its position channels first, as slides, then its
rotation channels in the order of the file, as hinges, all at one place. Each End Site is an
effector. A position channel adds to the joint's OFFSET (some programs put it in its place: the two
differ only where a joint has both).
"""

import re
from collections.abc import Iterator, Sequence
from math import radians
from pathlib import Path
from typing import NamedTuple, Protocol

import numpy as np

from ikteach.arrays import Array, Index
from ikteach.body import Effectors, Joint, Tree, forward

AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
CHANNEL = re.compile(r"([xyz])(position|rotation)", re.IGNORECASE)
LARGEST = 64 * 2**20  # bytes of a file
LONG = 60  # letters of a line that an error shows


class Recording(NamedTuple):
    """A body and how it moved: poses theta (T, n), dt seconds apart.

    Its effectors are the End Sites, named "<joint>.end".
    """

    tree: Tree
    effectors: Effectors
    theta: Array
    dt: float

    @property
    def times(self) -> Array:
        """Time of each frame, the first at 0, (T,) [s]."""
        return np.asarray(self.dt * np.arange(len(self.theta)), dtype=float)


class Line(NamedTuple):
    """A line of the file that is not empty: its number, its words, and all of it."""

    number: int
    words: list[str]
    text: str

    def wrong(self, why: str) -> ValueError:
        """Say what is wrong with this line."""
        shown = self.text if len(self.text) <= LONG else f"{self.text[:LONG]} …"
        return ValueError(f"BVH, line {self.number}: {why}: {shown!r}")

    def numbers(self, words: Sequence[str], count: int | None = None) -> list[float]:
        """Read finite numbers, `count` of them if given."""
        try:
            values = [float(word) for word in words]
        except ValueError:
            raise self.wrong("there is a word where a number should be") from None
        if not np.isfinite(values).all():
            raise self.wrong("a number is not finite")
        if count is not None and len(values) != count:
            raise self.wrong(f"{count} numbers are wanted, not {len(values)}")
        return values


class Node(NamedTuple):
    """A joint of the file while it is read: its name, and its place in the row that carries it."""

    name: str
    row: str | None
    offset: Array


class Skeleton(NamedTuple):
    """What the first part of a file says: rows, End Sites, and the channel that turns each row."""

    rows: list[Joint]
    sites: dict[str, tuple[str, Sequence[float]]]
    columns: list[int]


def read_bvh(source: str | Path, *, scale: float = 1.0) -> Recording:
    """Read a BVH file, or its text, into a body and its poses.

    source  a path, or the text itself (which begins with HIERARCHY)
    scale   metres per unit of the file, for lengths and positions

    A joint without channels is folded into its children. ValueError names the line that is wrong;
    OSError if there is no such file.
    """
    lines = _lines(_text(source))
    skeleton = _skeleton(lines, scale)
    frames, dt = _frame_lines(lines)
    units = [scale if row.slide else radians(1) for row in skeleton.rows]
    table = _table(lines, frames, len(units))
    if not skeleton.rows:
        raise ValueError("BVH: no joint has channels, so nothing moves")
    tree = Tree.of(skeleton.rows)
    if not skeleton.sites:
        last = skeleton.rows[-1].name
        skeleton.sites[f"{last}.end"] = (last, (0, 0, 0))
    theta = table[:, skeleton.columns] * units
    return Recording(tree, Effectors.of(tree, skeleton.sites), theta, dt)


def _text(source: str | Path) -> str:
    """The text of a file, or the text that was given."""
    if isinstance(source, str) and source.lstrip("\ufeff \t\r\n").upper().startswith("HIERARCHY"):
        return source
    path = Path(source)
    if path.stat().st_size > LARGEST:
        raise ValueError(f"{path.name} is larger than {LARGEST // 2**20} MB")
    try:
        return path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError:
        raise ValueError(f"{path.name} is no BVH file: it is not text") from None


def _lines(text: str) -> Iterator[Line]:
    """The lines that are not empty; a brace behind a word stands on a line of its own."""
    for number, line in enumerate(text.lstrip("\ufeff").splitlines(), start=1):
        for part in re.split(r"([{}])", line):
            if words := part.split():
                yield Line(number, words, line.strip())


def _next(lines: Iterator[Line], what: str) -> Line:
    """The next line; ValueError if the file ends before it."""
    for line in lines:
        return line
    raise ValueError(f"BVH: the file ends where {what} should be")


def _skeleton(lines: Iterator[Line], scale: float) -> Skeleton:
    """Read from HIERARCHY to MOTION."""
    first = _next(lines, "HIERARCHY")
    if first.words[0].upper() != "HIERARCHY":
        raise first.wrong("a BVH file begins with HIERARCHY")
    found, column = Skeleton([], {}, []), 0
    stack: list[Node] = []
    named: dict[str, int] = {}
    opening: str | None = None  # the joint, or the End Site, whose brace comes next
    while (line := _next(lines, "MOTION")).words[0].upper() != "MOTION":
        word, rest = line.words[0].upper(), line.words[1:]
        if word in ("ROOT", "JOINT", "END"):
            if opening is not None:
                raise line.wrong("a brace { is missing before this")
            above = stack[-1] if stack else None
            if word != "ROOT" and above is None:
                raise line.wrong("this hangs from nothing")
            name = " ".join(rest) or "joint"
            opening = f"{above.name}.end" if word == "END" and above else name
            named[opening] = named.get(opening, 0) + 1
            if named[opening] > 1:  # names need not be unique in a file, in a tree they are
                opening = f"{opening}.{named[opening]}"
            ends = word == "END"
        elif word == "{":
            if opening is None:
                raise line.wrong("a brace { without a joint")
            above = stack[-1] if stack else Node("", None, np.zeros(3))
            stack.append(above._replace(name=opening))
            opening = None
        elif word == "}" and stack:
            node = stack.pop()
            if ends and node.row is not None:
                found.sites[node.name] = (node.row, node.offset.tolist())
            ends = False
        elif word == "OFFSET" and stack:
            node = stack[-1]
            offset = scale * np.array(line.numbers(rest, 3))
            stack[-1] = node._replace(offset=node.offset + offset)
        elif word == "CHANNELS" and stack:
            stack[-1], column = _hang(found, stack[-1], line, column)
        else:
            raise line.wrong("this word means nothing here")
    if stack or opening is not None:
        raise line.wrong(f"{(stack[-1].name if stack else opening)!r} has no closing brace }}")
    return found


def _hang(found: Skeleton, node: Node, line: Line, column: int) -> tuple[Node, int]:
    """Add a row for each channel: positions first, each part in the order of the file."""
    words = line.words[1:]
    if not words or not words[0].isdigit() or int(words[0]) != len(words) - 1:
        raise line.wrong("CHANNELS is followed by their number and their names")
    channels = []
    for at, word in enumerate(words[1:], start=column):
        match = CHANNEL.fullmatch(word)
        if match is None:
            raise line.wrong(f"there is no channel {word!r}")
        channels.append((match[2].lower() == "rotation", at, match[1].lower()))
    names = [f"{node.name}.{axis}{'' if turns else 'pos'}" for turns, _, axis in channels]
    if len(set(names)) < len(names):
        raise line.wrong("a channel stands here twice")
    for turns, at, axis in sorted(channels, key=lambda channel: channel[0]):
        name = f"{node.name}.{axis}{'' if turns else 'pos'}"
        found.rows.append(Joint(name, node.row, node.offset.tolist(), AXES[axis], slide=not turns))
        found.columns.append(at)
        node = Node(node.name, name, np.zeros(3))
    return node, column + len(channels)


def _frame_lines(lines: Iterator[Line]) -> tuple[int, float]:
    """How many frames there are, and how many seconds apart."""
    line = _next(lines, "Frames:")
    match = re.fullmatch(r"Frames:\s*(\d+)", line.text, re.IGNORECASE)
    if match is None:
        raise line.wrong("after MOTION comes 'Frames:' and their number")
    frames = int(match[1])
    line = _next(lines, "Frame Time:")
    match = re.fullmatch(r"Frame\s+Time:\s*(\S+)", line.text, re.IGNORECASE)
    if match is None:
        raise line.wrong("after Frames comes 'Frame Time:' and seconds")
    (dt,) = line.numbers([match[1]])
    if not dt > 0:
        raise line.wrong("the time of a frame must be more than 0")
    return frames, dt


def _table(lines: Iterator[Line], frames: int, columns: int) -> Array:
    """The values of the channels, (frames, columns)."""
    rows: list[list[float]] = []
    for line in lines:
        if len(rows) == frames:
            raise line.wrong(f"there are more than the {frames} frames that were announced")
        rows.append(line.numbers(line.words, columns))
    if len(rows) < frames:
        raise ValueError(f"BVH: {frames} frames are announced, but the file ends after {len(rows)}")
    if not rows:
        raise ValueError("BVH: there are no frames")
    return np.array(rows)


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


def write_bvh(run: Run, *, scale: float = 100.0, dt: float | None = None) -> str:
    """Write a run as the text of a BVH file, lengths times `scale`: 100 makes centimetres.

    Rows that stand in one place, one on the other, become one joint with three rotation channels,
    and with three position channels if a slide is among them. Where their axes are x, y and z, each
    at most once, the channels are the angles themselves; else the joint's turn is written as z, y,
    x. A body with several joints on the ground gets a ROOT "ground" that does not move.

    dt  seconds per frame; that of run.times if not given. ValueError if the run has no frames.
    """
    theta = np.asarray(run.theta, dtype=float)
    if theta.ndim != 2 or not len(theta):
        raise ValueError(f"a BVH file holds one run with frames, not theta of {theta.shape}")
    if dt is None:
        dt = float(np.diff(run.times).mean()) if len(theta) > 1 else 1 / 30
    body = _Written(run.tree, run.effectors, theta, scale)
    head = body.hierarchy()
    table = np.concatenate(body.values, axis=1) if body.values else np.zeros((len(theta), 0))
    rows = [" ".join(f"{value:.12g}" for value in row) for row in table]
    return "\n".join(
        [*head, "MOTION", f"Frames: {len(theta)}", f"Frame Time: {dt:.10g}", *rows, ""]
    )


class _Written:
    """A body as it is written: its rows in groups, and the values of its channels (T, c)."""

    def __init__(self, tree: Tree, effectors: Effectors, theta: Array, scale: float) -> None:
        self.tree, self.effectors, self.theta, self.scale = tree, effectors, theta, scale
        self.frames = forward(tree, theta)
        self.groups = list(_groups(tree))
        self.group_of = {int(j): g for g, rows in enumerate(self.groups) for j in rows}
        self.values: list[Array] = []

    def hierarchy(self) -> list[str]:
        """The lines from HIERARCHY on."""
        tops = self._children(None)
        if len(tops) == 1:
            return ["HIERARCHY", *self._joint(tops[0], "ROOT", 0)]
        inside = [line for g in tops for line in self._joint(g, "JOINT", 1)]
        self.values.insert(0, np.zeros((len(self.theta), 3)))
        channels = "\tCHANNELS 3 Zrotation Yrotation Xrotation"
        return ["HIERARCHY", "ROOT ground", "{", "\tOFFSET 0 0 0", channels, *inside, "}"]

    def _children(self, group: int | None) -> list[int]:
        """The groups that hang from this one, or from the ground."""
        above = [int(self.tree.parents[rows[0]]) for rows in self.groups]
        return [g for g, j in enumerate(above) if (self.group_of[j] if j >= 0 else None) == group]

    def _joint(self, group: int, kind: str, depth: int) -> list[str]:
        """The lines of a joint and of all that hangs from it."""
        rows, tab = self.groups[group], "\t" * depth
        channels, values = self._channels(rows)
        self.values.append(values)
        lines = [
            f"{tab}{kind} {self._name(rows)}",
            f"{tab}{{",
            f"{tab}\tOFFSET {self._place(self.tree.offsets[rows[0]])}",
            f"{tab}\tCHANNELS {len(channels)} {' '.join(channels)}",
        ]
        children = self._children(group)
        for child in children:
            lines += self._joint(child, "JOINT", depth + 1)
        ends = [
            offset
            for joint, offset in zip(self.effectors.joints, self.effectors.offsets, strict=True)
            if self.group_of[int(joint)] == group
        ]
        for offset in ends or ([] if children else [np.zeros(3)]):
            site = [f"{tab}\tEnd Site", f"{tab}\t{{", f"{tab}\t\tOFFSET {self._place(offset)}"]
            lines += [*site, f"{tab}\t}}"]
        return [*lines, f"{tab}}}"]

    def _name(self, rows: Index) -> str:
        """The name of a group: what its rows' names have in common, or that of its last row."""
        names = [self.tree.names[j] for j in rows]
        stems = {re.sub(r"\.[xyz](pos)?$", "", name) for name in names}
        return re.sub(r"\s+", "_", stems.pop() if len(stems) == 1 else names[-1])

    def _place(self, offset: Array) -> str:
        return " ".join(f"{self.scale * x:.12g}" for x in offset)

    def _channels(self, rows: Index) -> tuple[list[str], Array]:
        """The channels of a group and their values (T, c)."""
        tree, names, values = self.tree, [], []
        above = int(tree.parents[rows[0]])
        R = self.frames.orientations[:, above] if above >= 0 else np.eye(3)
        if tree.slide[rows].any():
            p = self.frames.positions[:, above] if above >= 0 else np.zeros(3)
            at = np.matvec(np.swapaxes(R, -1, -2), self.frames.positions[:, rows[-1]] - p)
            names += ["Xposition", "Yposition", "Zposition"]
            values.append(self.scale * (at - tree.offsets[rows[0]]))
        letters = [_letter(tree.axes[j]) for j in rows if not tree.slide[j]]
        if None not in letters and len(set(letters)) == len(letters):
            rest = [letter for letter in "ZYX" if letter not in letters]
            names += [f"{letter}rotation" for letter in [*letters, *rest]]
            angles = np.zeros((len(self.theta), 3))
            for c, j in enumerate(j for j in rows if not tree.slide[j]):
                angles[:, c] = self.theta[:, j] * tree.axes[j].sum()  # −1 where the axis is
        else:
            names += ["Zrotation", "Yrotation", "Xrotation"]
            angles = zyx(np.swapaxes(R, -1, -2) @ self.frames.orientations[:, rows[-1]])
        return names, np.concatenate([*values, np.degrees(angles)], axis=1)


def _groups(tree: Tree) -> Iterator[Index]:
    """The rows of each place: chains in which nothing stands between one row and the next.

    Slides come first in a group, as BVH has it, and no group has more than three hinges.
    """
    children = np.bincount(tree.parents[tree.parents >= 0], minlength=len(tree))
    group: dict[int, list[int]] = {}
    for j, above in enumerate(tree.parents.tolist()):
        rows = group.get(above, [])
        joins = (
            bool(rows)
            and children[above] == 1
            and not tree.offsets[j].any()
            and not (tree.slide[j] and not tree.slide[above])
        )
        group[j] = rows if joins else []
        group[j].append(j)
    for rows in {id(rows): rows for rows in group.values()}.values():
        yield np.array(rows, dtype=np.intp)


def _letter(axis: Array) -> str | None:
    """X, Y or Z if the axis is one of these, either way round."""
    return "XYZ"[int(abs(axis).argmax())] if abs(axis).max() == 1 else None


def zyx(R: Array) -> Array:
    """Find the angles (..., 3) about z, y and x with R = Rz Ry Rx; they do not leap in time."""
    y = np.arctan2(-R[..., 2, 0], np.hypot(R[..., 0, 0], R[..., 1, 0]))
    z = np.arctan2(R[..., 1, 0], R[..., 0, 0])
    x = np.arctan2(R[..., 2, 1], R[..., 2, 2])
    return np.stack([np.unwrap(z, axis=0), y, np.unwrap(x, axis=0)], axis=-1)
