"""Bodies, poses and targets for hypothesis."""

from math import pi

import numpy as np
from hypothesis import strategies as st

from ikteach import Effectors, Joint, Tree, figures

SHAPES = st.sampled_from([(), (3,), (2, 3)])
SEEDS = st.integers(0, 2**32 - 1)


@st.composite
def bodies(draw, limits=False, slides=True, directions=False):
    """Any tree: hinges and slides, branches, effectors anywhere and several on one joint.

    The last effectors are directions, if these are asked for.
    """
    n, k = draw(st.integers(1, 9)), draw(st.integers(1, 4))
    rng = np.random.default_rng(draw(SEEDS))
    joints = []
    for j in range(n):
        parent = draw(st.none() | st.integers(0, j - 1)) if j else None
        lower, upper = sorted(rng.uniform(-pi, pi, 2)) if limits else (-np.inf, np.inf)
        joints.append(
            Joint(
                f"j{j}",
                parent=None if parent is None else f"j{parent}",
                offset=rng.choice([0.0, 1.0]) * rng.normal(size=3),
                axis=rng.normal(size=3),
                slide=slides and draw(st.integers(0, 4)) == 0,
                lower=lower,
                upper=upper,
            )
        )
    tree = Tree.of(joints)
    carriers = draw(st.lists(st.integers(0, n - 1), min_size=k, max_size=k))
    points = {f"e{i}": (f"j{j}", rng.normal(size=3)) for i, j in enumerate(carriers)}
    turned = draw(st.integers(0, k)) if directions else 0
    vectors = dict(list(points.items())[k - turned :])
    points = {name: at for name, at in points.items() if name not in vectors}
    return figures.Figure(tree, Effectors.of(tree, points, directions=vectors))


KNOWN = st.sampled_from([figures.human(), figures.double_y(), figures.y_shape()])


def anybody(**options):
    """A random body or one of the course."""
    return st.one_of(bodies(**options), KNOWN)


def poses(tree, rng, shape=()):
    """Poses within the limits, and no further than half a turn from 0."""
    lower, upper = np.maximum(tree.lower, -pi), np.minimum(tree.upper, pi)
    return rng.uniform(lower, upper, (*shape, len(tree)))
