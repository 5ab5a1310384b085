"""The bones of whom a motion was recorded from, beside whoever follows it."""

import numpy as np
import pytest

from ikteach import figures
from ikteach.formats.bvh import recorded_walk
from ikteach.motion.paths.skeleton import bones_at
from ikteach.study.walks import for_human, imported, three_walks


@pytest.fixture(scope="module")
def walks():
    return three_walks(recorded_walk())


def ends(path, of):
    """Where a bone ends, seen from the pelvis (T, 3)."""
    return path.skeleton.targets[:, path.skeleton.names.index(f"{of}, to")]


def test_a_recorded_walk_brings_the_bones_of_the_walker(walks):
    (tree, _), path = walks["recorded"]
    skeleton = path.skeleton
    assert len(skeleton.targets) == len(path.targets)
    bones = skeleton.targets.reshape(len(path.targets), -1, 2, 3)
    length = np.linalg.norm(bones[:, :, 1] - bones[:, :, 0], axis=-1)
    assert length.std(axis=0).max() < 1e-9, "bones are stiff"
    # Its legs are as long as ours, and it stands on the floor that we stand on.
    rest = figures.walker().tree.offsets
    ours = sum(np.linalg.norm(rest[tree.index(row)]) for row in ("knee.l", "ankle.l"))
    theirs = sum(
        float(length[0, [*skeleton.names].index(f"{bone}, to") // 2])
        for bone in ("LeftLeg", "LeftFoot")
    )
    assert theirs == pytest.approx(ours, rel=0.02)
    pelvis = path.targets[:, path.names.index("pelvis")]
    lowest = (bones[..., 1] + pelvis[:, None, None, 1]).min(axis=(1, 2))
    assert abs(np.median(lowest) - path.floor) < 0.05
    # Upright, heading along z, left on the left: knees and hands are about where ours are.
    for row, bone in (("knee.l", "LeftLeg"), ("knee.r", "RightLeg"), ("hand.r", "RightHand")):
        far = ends(path, bone) + pelvis - path.targets[:, path.names.index(row)]
        assert np.linalg.norm(far, axis=-1).mean() < 0.17, row


def test_bones_are_at_the_pelvis_or_in_the_origin_and_go_with_the_phase(walks):
    (tree, effectors), path = walks["recorded"]
    for phase in (0.0, 1.3, 1.3 + 2 * np.pi):
        targets = path.on(tree, effectors).at(phase)
        bones = bones_at(path, phase, effectors, targets)
        root = targets[effectors.names.index("pelvis")]
        assert np.linalg.norm(bones - root, axis=-1).min() < 0.2
        human = for_human(path, (tree, effectors), "walk")
        seen = bones_at(human, phase, figures.human().effectors, human.at(phase))
        np.testing.assert_allclose(seen + root, bones, atol=1e-9)
    assert "skeleton" not in path.settings()
    assert bones_at(walks["natural"][1], 0.0, effectors, targets) is None


def test_a_recording_that_is_opened_brings_its_bones():
    path = imported(recorded_walk(), "mine")
    assert path.skeleton is not None
    assert ends(path, "LeftLeg").shape[1:] == (3,)
