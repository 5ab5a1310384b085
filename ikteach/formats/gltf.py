"""Runs as animated models: glTF in one binary file (.glb), which Blender, Unity and browsers open.

A row of the body is a node: a hinge turns it, a slide moves it. A bone is an octahedron, as
Blender draws one, from a joint to the next. pygltflib (MIT, extra `gltf`) writes the container.
"""

from collections.abc import Iterator
from typing import Any

import numpy as np

from ikteach.arrays import Array, ArrayLike
from ikteach.body import Effectors, Tree
from ikteach.formats.bvh import Run, poses_of

NO_GLTF = "glTF needs the pygltflib library: pip install 'ikteach[gltf]'"
COLOUR = [0.37, 0.56, 0.71, 1.0]
BELLY = 0.15  # how far along a bone is thickest, and
THICK = 0.08  # how thick, as shares of its length
VERTICES = 34962  # ARRAY_BUFFER of the standard
SHORTEST = 1e-6  # of a bone [m]


def write_glb(
    run: Run, *, name: str = "run", dt: float | None = None, way: ArrayLike | None = None
) -> bytes:
    """Write a run as a .glb file, in metres, y up.

    name  of the animation
    dt    seconds per frame; the mean of the run's if not given
    way   (T, 3) [m] where the ground under the figure has gone, as a treadmill goes

    Nodes are the rows, and the effectors that are points, by their names; all hang from one called
    "ground". ValueError if a shape is wrong, a number not finite or there is no frame; ImportError
    without pygltflib.
    """
    theta, dt, gone = poses_of(run, dt, way)
    if not len(theta):
        raise ValueError("there is no frame to write")
    tree, model = run.tree, _Model()
    nodes = model.body(tree, run.effectors)
    times = model.put(dt * np.arange(len(theta)), "SCALAR", bounds=True)
    model.move(nodes["ground"], times, "translation", gone)
    for j in range(len(tree)):
        if tree.slide[j]:
            moved = tree.offsets[j] + theta[:, j, None] * tree.axes[j]
            model.move(j, times, "translation", moved)
        else:
            model.move(j, times, "rotation", quaternions(tree.axes[j], theta[:, j]))
    return model.packed(name, nodes["ground"])


class _Model:
    """A glTF model that grows, and the numbers that it refers to."""

    def __init__(self) -> None:
        try:
            import pygltflib
        except ImportError as error:
            raise ImportError(NO_GLTF) from error
        self.lib: Any = pygltflib
        look = pygltflib.PbrMetallicRoughness(
            baseColorFactor=COLOUR, metallicFactor=0, roughnessFactor=0.8
        )
        self.gltf: Any = pygltflib.GLTF2(
            asset=pygltflib.Asset(version="2.0", generator="ikteach"),
            materials=[pygltflib.Material(pbrMetallicRoughness=look)],
        )
        self.animation: Any = pygltflib.Animation(samplers=[], channels=[])
        self.data = bytearray()

    def body(self, tree: Tree, effectors: Effectors) -> dict[str, int]:
        """Add nodes for rows, the ground, effectors and bones."""
        nodes = self.gltf.nodes
        for j, name in enumerate(tree.names):
            below = np.flatnonzero(tree.parents == j).tolist()
            nodes.append(
                self.lib.Node(name=name, translation=tree.offsets[j].tolist(), children=below)
            )
        tops = np.flatnonzero(tree.parents < 0).tolist()
        nodes.append(self.lib.Node(name="ground", children=tops))
        ground = len(nodes) - 1
        for i, name in enumerate(effectors.names):
            if effectors.w[i]:
                place = effectors.offsets[i].tolist()
                self._hang(int(effectors.joints[i]), name=name, translation=place)
        for joint, end in bones(tree, effectors):
            self._hang(joint if joint >= 0 else ground, mesh=self._mesh(octahedron(end)))
        return {"ground": ground}

    def _hang(self, joint: int, **what: Any) -> None:
        self.gltf.nodes.append(self.lib.Node(**what))
        self.gltf.nodes[joint].children.append(len(self.gltf.nodes) - 1)

    def _mesh(self, triangles: Array) -> int:
        """Add triangles (f, 3, 3) with flat faces."""
        a, b, c = np.moveaxis(triangles, 1, 0)
        normals = np.cross(b - a, c - a)
        normals = np.repeat(normals / np.linalg.norm(normals, axis=1, keepdims=True), 3, axis=0)
        places = self.put(triangles.reshape(-1, 3), "VEC3", VERTICES, bounds=True)
        shading = self.put(normals, "VEC3", VERTICES)
        attributes = self.lib.Attributes(POSITION=places, NORMAL=shading)
        primitive = self.lib.Primitive(attributes=attributes, material=0)
        self.gltf.meshes.append(self.lib.Mesh(primitives=[primitive]))
        return len(self.gltf.meshes) - 1

    def put(
        self, values: ArrayLike, kind: str, target: int | None = None, *, bounds: bool = False
    ) -> int:
        """Add numbers, as floats of four bytes; return their index."""
        floats = np.ascontiguousarray(values, dtype="<f4")
        ends = {"min": floats.min(axis=0), "max": floats.max(axis=0)} if bounds else {}
        self.gltf.bufferViews.append(
            self.lib.BufferView(
                buffer=0, byteOffset=len(self.data), byteLength=floats.nbytes, target=target
            )
        )
        self.gltf.accessors.append(
            self.lib.Accessor(
                bufferView=len(self.gltf.bufferViews) - 1,
                componentType=self.lib.FLOAT,
                count=len(floats),
                type=kind,
                **{end: np.atleast_1d(value).tolist() for end, value in ends.items()},
            )
        )
        self.data += floats.tobytes()
        return len(self.gltf.accessors) - 1

    def move(self, node: int, times: int, what: str, values: Array) -> None:
        """Animate the rotation (T, 4) or the translation (T, 3) of a node."""
        output = self.put(values, "VEC4" if what == "rotation" else "VEC3")
        self.animation.samplers.append(self.lib.AnimationSampler(input=times, output=output))
        target = self.lib.AnimationChannelTarget(node=node, path=what)
        sampler = len(self.animation.samplers) - 1
        self.animation.channels.append(self.lib.AnimationChannel(sampler=sampler, target=target))

    def packed(self, name: str, root: int) -> bytes:
        """Close the model."""
        self.animation.name = name
        self.gltf.animations = [self.animation]
        self.gltf.scenes, self.gltf.scene = [self.lib.Scene(nodes=[root])], 0
        self.gltf.buffers = [self.lib.Buffer(byteLength=len(self.data))]
        self.gltf.set_binary_blob(bytes(self.data))
        return b"".join(self.gltf.save_to_bytes())


def bones(tree: Tree, effectors: Effectors) -> Iterator[tuple[int, Array]]:
    """Go through the bones: who carries each, its end (3,) [m].

    It is a joint, or -1 for the ground.
    """
    ends = [*zip(tree.parents.tolist(), tree.offsets, strict=True)]
    points = effectors.w == 1
    ends += zip(effectors.joints[points].tolist(), effectors.offsets[points], strict=True)
    for joint, end in ends:
        if np.linalg.norm(end) > SHORTEST:
            yield joint, end


def octahedron(end: Array) -> Array:
    """Make the eight triangles (8, 3, 3) of a bone from the origin to `end` (3,)."""
    length = np.linalg.norm(end)
    y = end / length
    x = np.cross(y, np.eye(3)[abs(y).argmin()])
    x /= np.linalg.norm(x)
    z = np.cross(x, y)
    ring = [BELLY * end + THICK * length * side for side in (x, z, -x, -z)]
    around = [*zip(ring, ring[1:] + ring[:1], strict=True)]
    faces = [(np.zeros(3), a, b) for a, b in around] + [(end, b, a) for a, b in around]
    return np.array(faces)


def quaternions(axis: Array, theta: Array) -> Array:
    """Return turns by θ (T,) about an axis as quaternions (T, 4).

    The real part is the last; the axis has length 1.
    """
    half = theta[:, None] / 2
    return np.concatenate([np.sin(half) * axis, np.cos(half)], axis=1)
