"""Chapter 7: how fast a body goes over its feet, and a path on which feet do not skate."""

from dataclasses import replace
from typing import Any

import numpy as np

from ikteach.arrays import Array, Mask
from ikteach.course.checking import Answer, exercise, expect
from ikteach.course.forms import agree
from ikteach.motion import gait

SAMPLES = 400  # of one cycle
GROUND = 1e-6  # [m]; a foot no higher stands on the ground
CLEARANCE, HIGHEST = 0.03, 0.6  # [m]
REACH = 0.6  # [m] ahead and behind
STEPS = 0.2, 1.2  # [m] that a stance may be long
SLIP = 0.03  # of the stance's length
JUMP = 5e-4  # [m]; what is left of a jump when the samples become dense


@exercise(
    "07.pace",
    returns=(),
    hints=[
        "How fast does z = A sin(ωτ) change, and when is it at the given place?",
        "ż = Aω cos(ωτ), and cos² = 1 − sin² = 1 − (z/A)². A speed has no sign.",
        "`return abs(omega) * np.sqrt(A**2 - z**2)`",
    ],
)
def pace(answer: Answer) -> None:
    """pace(A, omega, z): the speed of the body at which a foot at z stands still [m/s]."""
    rng = np.random.default_rng(7)
    shares = [0.0, 0.0, 0.6, -0.6, 0.99, -0.99, *rng.uniform(-1, 1, 6)]
    for share in shares:
        A, omega = rng.uniform(0.1, 3, 2).round(2) * rng.choice([-1, 1], 2)
        walk = replace(gait.walking, front_z_leg=float(A), speed=float(omega))
        T, dt = np.arcsin(share) / omega, 1e-5 / abs(omega)
        z = walk(np.array([T - dt, T, T + dt]))[:, 1, 2]
        where = f"At z = {z[1]:.4g} m with A = {A:g} m and ω = {omega:g} rad/s"
        found = float(answer(float(A), float(omega), float(z[1])))
        expect(found >= 0, f"{where} you say {found:.3g} m/s: a speed is not negative.")
        agree(
            found,
            abs(z[2] - z[0]) / (2 * dt),
            f"{where} the foot goes back at {{wanted}} m/s, and you say {{found}}.",
            near=1e-3,
        )


def foot(answer: Answer, samples: int) -> Array:
    """A foot through two cycles, (2 · samples, 2): height and z [m]."""
    made: Array = answer(np.arange(2 * samples) / samples)
    return made


def _drawn(answer: Answer) -> Any:
    from ikteach.view.widgets.foot import foot_path

    return foot_path(foot(answer, SAMPLES)[: SAMPLES + 1], GROUND)


@exercise(
    "07.path",
    returns=lambda phase: (*phase.shape, 2),
    hints=[
        "For which part of the cycle must a foot stand, if one of two must always stand?",
        "Cut the cycle in two: a stance of 0.6 of it, in which z falls in a straight line, and a "
        "swing in which z comes back smoothly and the height is like sin²: zero at both ends.",
        "`swing = np.clip((np.mod(phase, 1) - 0.6) / 0.4, 0, 1)` and `np.stack([height, z], -1)`",
    ],
    drawn=_drawn,
    seconds=20,
)
def path(answer: Answer) -> None:
    """path(phase (m,)) -> (m, 2): height over the ground and z of a foot [m], phase in cycles."""
    both = foot(answer, SAMPLES)
    goes_round(answer, both)
    y, z = both[:SAMPLES].T
    expect(y.min() > -GROUND, f"The foot goes {-100 * y.min():.2g} cm into the ground.")
    expect(
        abs(z).max() <= REACH,
        f"The foot is {abs(z).max():.2f} m from the body; a leg reaches {REACH:g} m.",
    )
    coarse, fine = (abs(np.diff(foot(answer, n), axis=0)).max() for n in (8, 32) * np.array(400))
    expect(
        fine < max(0.6 * coarse, JUMP),
        f"The foot jumps by {100 * fine:.2g} cm at once: so much lies between phases that are "
        f"1/{32 * 400} of a cycle apart, and {100 * coarse:.2g} cm between those of 1/{8 * 400}.",
    )
    stands = y < GROUND
    expect(stands.any(), f"The foot never stands on the ground: it is at {100 * y.min():.2g} cm.")
    expect(
        CLEARANCE <= y.max() <= HIGHEST,
        f"The foot lifts by {100 * y.max():.3g} cm; it needs 3 cm to clear the ground, and no leg "
        "lifts it more than 60 cm.",
    )
    neither = ~(stands | np.roll(stands, SAMPLES // 2))
    expect(
        not neither.any(),
        f"There are moments when neither this foot nor the other one, half a cycle apart, stands: "
        f"at phase {neither.argmax() / SAMPLES:.2f} is one.",
    )
    does_not_skate(z, stands)


def goes_round(answer: Answer, both: Array) -> None:
    """A cycle later, and in whatever order phases are asked for, it is the same foot."""
    apart = abs(both[:SAMPLES] - both[SAMPLES:])
    i, which = np.unravel_index(apart.argmax(), apart.shape)
    agree(
        both[SAMPLES + i, which],
        both[i, which],
        f"A walk goes round and round, but the {('height', 'z')[which]} at phase "
        f"{i / SAMPLES:.2f} is {{wanted}} m, and a cycle later {{found}}.",
        size=0.1,
    )
    order = np.random.default_rng(70).permutation(SAMPLES)
    agree(
        answer(order / SAMPLES - 7.0),
        both[order],
        "Where the foot is must follow from the phase alone: asked in another order, and seven "
        "cycles earlier, you say {found} m in place of {wanted}.",
        size=0.1,
    )


def does_not_skate(z: Array, stands: Mask) -> None:
    """While it stands it goes back with the body, which has one speed."""
    carried = np.diff(z, append=z[:1])[stands & np.roll(stands, -1)] * SAMPLES
    expect(
        carried.size > 0 and carried.mean() < 0,
        "While it stands, a foot must go back under the body: z must fall, and it "
        f"{'rises' if carried.size and carried.mean() > 0 else 'does not'}.",
    )
    speed = -float(np.median(carried))
    length, slip = abs(carried).sum() / SAMPLES, abs(carried + speed).sum() / SAMPLES
    expect(
        slip <= SLIP * length,
        f"While it stands, the foot skates: over {100 * length:.1f} cm of ground it slides "
        f"{100 * slip:.2g} cm, for its speed is from {-carried.max():.3g} to "
        f"{-carried.min():.3g} m per cycle.",
    )
    expect(
        STEPS[0] <= length <= STEPS[1],
        f"A stance is {length:.3g} m long; a step of {STEPS[0]:g} to {STEPS[1]:g} m is wanted.",
    )
