"""Write .glb files into a folder, and beside each where its rows and effectors are, as JSON.

`tests/page/gltf.test.js` opens them with three's loader.
"""

import json
import sys
from pathlib import Path

import numpy as np

from ikteach import Effectors, Joint, Tree, figures, forward, locate
from ikteach.formats.bvh import Recording
from ikteach.formats.gltf import write_glb


def skew():
    """A slide, and hinges about skew axes; two joints hang from the ground."""
    tree = Tree.of(
        [
            Joint("slide <b>", None, (0.1, 0.2, 0.3), (1, 2, 3), slide=True),
            Joint("hinge", "slide <b>", (0, 0.5, 0), (1, -1, 0.5)),
            Joint("other", None, (0, 0, 0), (0, 1, 0)),
        ]
    )
    return tree, Effectors.of(tree, {"end": ("hinge", (0.3, 0, 0)), "hinge": ("other", (0, 0, 1))})


def main(folder):
    rng = np.random.default_rng(5)
    for name, (tree, effectors) in {"human": figures.human(), "skew": skew()}.items():
        theta = rng.uniform(-3, 3, (22, len(tree))).cumsum(axis=0) / 4
        way = rng.normal(size=(22, 3))
        run = Recording(tree, effectors, theta, 1 / 30)
        (folder / f"{name}.glb").write_bytes(write_glb(run, way=way))
        frames = forward(tree, theta)
        facts = {
            "dt": 1 / 30,
            "rows": list(tree.names),
            "effectors": list(effectors.names),
            "positions": (frames.positions + way[:, None]).tolist(),
            "orientations": frames.orientations.tolist(),
            "ends": (locate(frames, effectors) + way[:, None]).tolist(),
        }
        (folder / f"{name}.json").write_text(json.dumps(facts))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
