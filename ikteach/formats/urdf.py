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
from heapq import heappop, heappush
from pathlib import Path
from typing import NamedTuple
from xml.parsers import expat

import numpy as np

from ikteach.arrays import Array, ArrayLike
from ikteach.body import Effectors, Frames, Joint, Tree
from ikteach.checks import shown
from ikteach.formats.source import MOST_JOINTS, content
from ikteach.names import unknown

LARGEST_URDF = 16 * 2**20  # bytes of a file
ARM = Path(__file__).parents[1] / "data" / "arm7.urdf"  # an arm of seven hinges
LINE = " line"  # where an element stands in the file: no attribute has a blank in its name
MOVES = {"revolute", "continuous", "prismatic"}


class Link(NamedTuple):
    """Where a link is in the frame of its row.

    row  index of the row that carries it
    C    (3, 3)
    d    (3,) [m]
    """

    row: int | None
    C: Array
    d: Array


class Mimic(NamedTuple):
    """A joint that repeats another: θ = multiplier · θ_joint + offset.

    It is read, and not obeyed: the row moves by itself.
    """

    joint: str
    multiplier: float
    offset: float


class Robot(NamedTuple):
    """A robot as a body.

    Its effectors are the links from which nothing hangs.

    links   {name: Link}, all of them
    mimics  {joint: Mimic}
    """

    tree: Tree
    effectors: Effectors
    links: Mapping[str, Link]
    mimics: Mapping[str, Mimic]

    def place(self, frames: Frames, link: str) -> tuple[Array, Array]:
        """Find p (..., 3) and R (..., 3, 3) of a link in these frames.

        LookupError suggests another link.
        """
        if link not in self.links:
            raise LookupError(unknown("link", link, self.links))
        row, C, d = self.links[link]
        if row is None:
            batch = frames.positions.shape[:-2]
            return np.broadcast_to(d, (*batch, 3)), np.broadcast_to(C, (*batch, 3, 3))
        R = frames.orientations[..., row, :, :]
        return frames.positions[..., row, :] + R @ d, R @ C


class Edge(NamedTuple):
    """A joint of the file and the links that it joins."""

    element: ET.Element
    name: str
    parent: str
    child: str

    def wrong(self, why: str) -> ValueError:
        """Say what is wrong with this joint, and where."""
        return wrong(self.element, f"the joint {shown(self.name)} {why}")


def read_urdf(source: str | Path) -> Robot:
    """Read a URDF file, or its text, as a body.

    source  a path, or the text itself, which begins with "<"

    A joint without limits is endless; where one of them is missing it is 0, as URDF has it. What
    does not move (inertia, looks, transmissions) is passed over. ValueError names the line, and the
    joint or link that is wrong: joints must be fixed, revolute, continuous or prismatic. OSError if
    there is no such file.
    """
    robot = _root(content(source, LARGEST_URDF, "URDF"))
    edges = list(_edges(robot))
    mimics = {edge.name: mimic for edge in edges if (mimic := _mimic(edge, edges)) is not None}
    below: dict[str, list[int]] = {}
    for place, edge in enumerate(edges):
        below.setdefault(edge.parent, []).append(place)
    ground = _ground(robot, edges)
    links = {ground: Link(None, np.eye(3), np.zeros(3))}
    rows: list[Joint] = []
    ready = below.get(ground, []).copy()  # a heap: the order of the file, where it can
    while ready:
        edge = edges[heappop(ready)]
        links[edge.child] = _hang(edge, links[edge.parent], rows)
        for place in below.get(edge.child, []):
            heappush(ready, place)
    if lost := [edge.name for edge in edges if edge.child not in links]:
        first = next(edge for edge in edges if edge.name == lost[0])
        raise first.wrong("hangs from itself in a circle")
    if not 0 < len(rows) <= MOST_JOINTS:
        raise ValueError(f"URDF: {len(rows)} joints move, and it must be from 1 to {MOST_JOINTS}")
    tree = Tree.of(rows)
    ends = {
        name: (tree.names[link.row], link.d.tolist())
        for name, link in links.items()
        if name not in below and link.row is not None
    }
    return Robot(tree, Effectors.of(tree, ends), links, mimics)


def _root(data: bytes) -> ET.Element:
    """Parse the <robot> element, its tags without namespaces."""
    wide = data.startswith((b"\xff\xfe", b"\xfe\xff"))
    root = _parsed(data.decode("utf-16" if wide else "utf-8-sig", errors="replace"))
    for element in root.iter():
        space, _, tag = element.tag.rpartition("}")
        if "xacro" in space or tag.startswith("xacro:"):
            tag = tag.removeprefix("xacro:")[:40]
            raise wrong(element, f"<xacro:{tag}> is left: let xacro expand this file first")
        element.tag = tag
    if root.tag != "robot":
        raise wrong(root, f"the root is <{root.tag[:40]}>, and should be <robot>")
    return root


def _parsed(text: str) -> ET.Element:
    """Parse XML into elements that know their lines; entities are refused."""
    spaced = "xmlns" in text  # else xacro's prefix, which nothing then declares, is part of a name
    parser, builder = (
        expat.ParserCreate(namespace_separator="}" if spaced else None),
        ET.TreeBuilder(),
    )
    body = text.lstrip()
    above = text.count("\n", 0, len(text) - len(body))

    def start(tag: str, attributes: dict[str, str]) -> None:
        builder.start(tag, {**attributes, LINE: str(above + parser.CurrentLineNumber)})

    def entity(*_: object) -> None:  # which can grow without end
        raise ValueError(f"URDF, line {above + parser.CurrentLineNumber}: entities are not read")

    parser.StartElementHandler, parser.EndElementHandler = start, builder.end
    parser.EntityDeclHandler = entity
    try:
        parser.Parse(body, True)
    except expat.ExpatError as error:
        why = expat.ErrorString(error.code)
        raise ValueError(f"URDF, line {above + error.lineno}: this is no XML ({why})") from None
    return builder.close()


def wrong(element: ET.Element, why: str) -> ValueError:
    """Say what is wrong, and in which line."""
    return ValueError(f"URDF, line {element.get(LINE)}: {why}")


def _named(robot: ET.Element, tag: str) -> Iterator[tuple[str, ET.Element]]:
    """Go through the links, or the joints, each with a name of its own."""
    names = set()
    for element in robot.findall(tag):
        name = element.get("name")
        if not name:
            raise wrong(element, f"a {tag} has no name")
        if name in names:
            raise wrong(element, f"there are two {tag}s called {shown(name)}")
        names.add(name)
        yield name, element


def _edges(robot: ET.Element) -> Iterator[Edge]:
    """Go through the joints of the file, and check what each of them joins."""
    links = {name for name, _ in _named(robot, "link")}
    children = set()
    for name, element in _named(robot, "joint"):
        ends = []
        for end in ("parent", "child"):
            found = element.find(end)
            link = found.get("link") if found is not None else None
            if link is None:
                raise wrong(element, f"the joint {shown(name)} has no {end}")
            if link not in links:
                why = unknown("link", link, links)
                raise wrong(element, f"the joint {shown(name)} has a {end}, but there is {why}")
            ends.append(link)
        if ends[1] in children:
            raise wrong(element, f"the link {shown(ends[1])} hangs from two joints")
        children.add(ends[1])
        yield Edge(element, name, *ends)


def _ground(robot: ET.Element, edges: list[Edge]) -> str:
    """Find the one link that hangs from nothing."""
    children = {edge.child for edge in edges}
    tops = [name for name, _ in _named(robot, "link") if name not in children]
    if len(tops) != 1:
        raise ValueError(
            f"URDF: one link must hang from nothing, not {len(tops)}: {shown(tops[:4])}"
        )
    return tops[0]


def _hang(edge: Edge, above: Link, rows: list[Joint]) -> Link:
    """Add the row of a joint that moves; return where its child link is."""
    origin = edge.element.find("origin")
    xyz = _numbers(edge, origin, "xyz", (0, 0, 0))
    C = above.C @ rpy(*_numbers(edge, origin, "rpy", (0, 0, 0)))
    at, kind = above.d + above.C @ xyz, edge.element.get("type")
    if kind == "fixed":
        return Link(above.row, C, at)
    if kind not in MOVES:
        allowed = "only fixed, revolute, continuous and prismatic joints are read"
        raise edge.wrong(f"is {shown(kind)}; {allowed}")
    axis = _numbers(edge, edge.element.find("axis"), "xyz", (1, 0, 0))
    if not axis.any():
        raise edge.wrong("has the axis zero")
    lower, upper = _limits(edge, kind)
    if lower > upper:
        raise edge.wrong(f"has its lower limit {lower:g} above its upper {upper:g}")
    parent = None if above.row is None else rows[above.row].name
    slide, place = kind == "prismatic", at.tolist()
    axis = C @ (axis / abs(axis).max())
    rows.append(Joint(edge.name, parent, place, axis.tolist(), slide, lower, upper))
    return Link(len(rows) - 1, C, np.zeros(3))


def _limits(edge: Edge, kind: str) -> tuple[float, float]:
    """Read the lower and the upper limit [rad or m]; a continuous joint has none."""
    limit = edge.element.find("limit")
    if kind == "continuous" or limit is None:
        return -math.inf, math.inf
    (lower,), (upper,) = (_numbers(edge, limit, end, (0,)) for end in ("lower", "upper"))
    return float(lower), float(upper)


def _mimic(edge: Edge, edges: list[Edge]) -> Mimic | None:
    """Read which joint this one repeats, if any."""
    mimic = edge.element.find("mimic")
    if mimic is None:
        return None
    names = [other.name for other in edges if other is not edge]
    if (joint := mimic.get("joint")) not in names:
        why = unknown("other joint", joint, names)
        raise edge.wrong(f"has a mimic, but there is {why}")
    (times,), (plus,) = (
        _numbers(edge, mimic, key, default)
        for key, default in (("multiplier", (1,)), ("offset", (0,)))
    )
    return Mimic(joint, float(times), float(plus))


def _numbers(edge: Edge, element: ET.Element | None, key: str, default: ArrayLike) -> Array:
    """Read the numbers of an attribute, as many as the default has."""
    wanted = np.asarray(default, dtype=float)
    text = element.get(key) if element is not None else None
    if text is None:
        return wanted
    try:
        values = np.array(text.split(), dtype=float)
    except ValueError:
        values = np.empty(0)
    if values.shape != wanted.shape or not np.isfinite(values).all() or "_" in text:
        needs = "a number" if len(wanted) == 1 else f"{len(wanted)} numbers"
        of = f"{key} of the joint {shown(edge.name)}"
        raise wrong(edge.element, f"{of} must be {needs}, not {shown(text)}")
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
