"""Robots: URDF files, the XML in which robots are described.

One row of a `Tree` per movable joint, in the order of the file and by its name; fixed joints are
folded into what they hold. A link that hangs in row r has its frame at

    R_link = R_r C        p_link = p_r + R_r d

and a joint with origin (xyz, rpy) and axis a hangs there with

    offset = d + C xyz        axis = C R(rpy) a        C' = C R(rpy)
"""

import math
import xml.etree.ElementTree as ET
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ikteach.arrays import Array, ArrayLike
from ikteach.body import Effectors, Frames, Joint, Tree

LARGEST = 16 * 2**20  # bytes of a file
MOVES = {"revolute", "continuous", "prismatic"}


class Link(NamedTuple):
    """Where a link is: in the frame of row `row` (None: the ground), turned by C, moved by d.

    row  index of the row that carries it
    C    (3, 3)
    d    (3,) [m]
    """

    row: int | None
    C: Array
    d: Array


class Mimic(NamedTuple):
    """A joint that repeats another: θ = multiplier · θ_joint + offset. It is read, not obeyed."""

    joint: str
    multiplier: float
    offset: float


class Robot(NamedTuple):
    """A robot as a body; its effectors are the links from which nothing hangs.

    links   {name: Link}, all of them
    mimics  {joint: Mimic}
    """

    tree: Tree
    effectors: Effectors
    links: Mapping[str, Link]
    mimics: Mapping[str, Mimic]

    def place(self, frames: Frames, link: str) -> tuple[Array, Array]:
        """Find p (..., 3) and R (..., 3, 3) of a link in these frames of the tree."""
        row, C, d = self.links[link]
        if row is None:
            batch = frames.positions.shape[:-2]
            return np.broadcast_to(d, (*batch, 3)), np.broadcast_to(C, (*batch, 3, 3))
        R = frames.orientations[..., row, :, :]
        return frames.positions[..., row, :] + R @ d, R @ C


class Edge(NamedTuple):
    """A joint of the file: its element, and the links that it joins."""

    element: ET.Element
    name: str
    parent: str
    child: str


def read_urdf(source: str | Path) -> Robot:
    """Read a URDF file, or its text, into a body.

    ValueError names the joint or link that is wrong; a joint that is neither fixed, revolute,
    continuous nor prismatic is refused. OSError if there is no such file.
    """
    robot = _root(_text(source))
    edges = list(_edges(robot))
    order = {edge.child: place for place, edge in enumerate(edges)}
    links = {_ground(robot, edges): Link(None, np.eye(3), np.zeros(3))}
    rows: list[Joint] = []
    mimics: dict[str, Mimic] = {}
    waiting = list(edges)
    while waiting:
        ready = [edge for edge in waiting if edge.parent in links]
        if not ready:
            raise ValueError(f"URDF: the joint {waiting[0].name!r} hangs from itself in a circle")
        edge = min(ready, key=lambda edge: order[edge.child])  # the order of the file, where it can
        waiting.remove(edge)
        links[edge.child] = _hang(edge, links[edge.parent], rows)
        if (mimic := _mimic(edge)) is not None:
            mimics[edge.name] = mimic
    if not rows:
        raise ValueError("URDF: no joint moves")
    tree = Tree.of(rows)
    parents = {edge.parent for edge in edges}
    ends = {
        name: (tree.names[link.row], link.d.tolist())
        for name, link in links.items()
        if name not in parents and link.row is not None
    }
    return Robot(tree, Effectors.of(tree, ends), links, mimics)


def _text(source: str | Path) -> str | bytes:
    """The text of a file, or the text that was given."""
    if isinstance(source, str) and source.lstrip("\ufeff \t\r\n").startswith("<"):
        return source.lstrip("\ufeff \t\r\n")
    path = Path(source)
    if path.stat().st_size > LARGEST:
        raise ValueError(f"{path.name} is larger than {LARGEST // 2**20} MB")
    return path.read_bytes()


def _root(text: str | bytes) -> ET.Element:
    """The <robot> element."""
    entity = b"<!ENTITY" if isinstance(text, bytes) else "<!ENTITY"
    if entity in text:  # type: ignore[operator]
        raise ValueError("URDF: entities are not read")  # they can grow without end
    try:
        root = ET.fromstring(text)
    except ET.ParseError as error:
        raise ValueError(f"URDF: this is no XML ({error})") from None
    if root.tag != "robot":
        raise ValueError(f"URDF: the root is <{root.tag[:40]}>, and should be <robot>")
    return root


def _edges(robot: ET.Element) -> Iterator[Edge]:
    """The joints of the file, checked one by one."""
    names, children = set(), set()
    links = {link.get("name") for link in robot.findall("link")}
    for element in robot.findall("joint"):
        name = element.get("name")
        if not name:
            raise ValueError("URDF: a joint has no name")
        if name in names:
            raise ValueError(f"URDF: there are two joints called {name!r}")
        ends = []
        for end in ("parent", "child"):
            found = element.find(end)
            link = found.get("link") if found is not None else None
            if link is None:
                raise ValueError(f"URDF: the joint {name!r} has no {end}")
            if link not in links:
                raise ValueError(
                    f"URDF: the joint {name!r} has the {end} {link!r}, which is no link"
                )
            ends.append(link)
        if ends[1] in children:
            raise ValueError(f"URDF: the link {ends[1]!r} hangs from two joints")
        names.add(name)
        children.add(ends[1])
        yield Edge(element, name, *ends)


def _ground(robot: ET.Element, edges: list[Edge]) -> str:
    """The one link that hangs from nothing."""
    children = {edge.child for edge in edges}
    tops = [link.get("name") for link in robot.findall("link") if link.get("name") not in children]
    if len(tops) != 1 or tops[0] is None:
        raise ValueError(f"URDF: one link hangs from nothing, not {len(tops)}: {tops[:4]}")
    return tops[0]


def _hang(edge: Edge, above: Link, rows: list[Joint]) -> Link:
    """Add the row of a joint that moves; where its child link is."""
    origin = edge.element.find("origin")
    xyz = _numbers(edge, origin, "xyz", (0, 0, 0))
    C = above.C @ rpy(*_numbers(edge, origin, "rpy", (0, 0, 0)))
    at, kind = above.d + above.C @ xyz, edge.element.get("type")
    if kind == "fixed":
        return Link(above.row, C, at)
    if kind not in MOVES:
        raise ValueError(f"URDF: the joint {edge.name!r} is {kind!r}; rows are hinges and slides")
    axis = C @ _numbers(edge, edge.element.find("axis"), "xyz", (1, 0, 0))
    lower, upper = _limits(edge, kind)
    parent = None if above.row is None else rows[above.row].name
    rows.append(
        Joint(
            edge.name,
            parent,
            at.tolist(),
            axis.tolist(),
            slide=kind == "prismatic",
            lower=lower,
            upper=upper,
        )
    )
    return Link(len(rows) - 1, C, np.zeros(3))


def _limits(edge: Edge, kind: str) -> tuple[float, float]:
    """Lower and upper limit [rad or m]; a joint that turns for ever has none."""
    limit = edge.element.find("limit")
    if kind == "continuous" or limit is None:
        return -math.inf, math.inf
    (lower,), (upper,) = (_numbers(edge, limit, end, (0,)) for end in ("lower", "upper"))
    return float(lower), float(upper)


def _mimic(edge: Edge) -> Mimic | None:
    mimic = edge.element.find("mimic")
    if mimic is None:
        return None
    (times,), (plus,) = (
        _numbers(edge, mimic, key, default)
        for key, default in (("multiplier", (1,)), ("offset", (0,)))
    )
    return Mimic(str(mimic.get("joint")), float(times), float(plus))


def _numbers(edge: Edge, element: ET.Element | None, key: str, default: ArrayLike) -> Array:
    """The numbers of an attribute, as many as the default has."""
    wanted = np.asarray(default, dtype=float)
    text = element.get(key) if element is not None else None
    if text is None:
        return wanted
    try:
        values = np.array(text.split(), dtype=float)
    except ValueError:
        values = np.empty(0)
    if values.shape != wanted.shape or not np.isfinite(values).all():
        shown = text if len(text) <= 40 else f"{text[:40]} …"
        raise ValueError(
            f"URDF: {key} of the joint {edge.name!r} must be {len(wanted)} numbers, not {shown!r}"
        )
    return values


def rpy(roll: float, pitch: float, yaw: float) -> Array:
    """Make the rotation Rz(yaw) Ry(pitch) Rx(roll), (3, 3)."""
    (cr, cp, cy), (sr, sp, sy) = np.cos([roll, pitch, yaw]), np.sin([roll, pitch, yaw])
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )
