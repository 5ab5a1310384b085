"""Chapter 7: how fast a body goes over its feet, and a path on which feet do not skate."""

from dataclasses import replace

import numpy as np

from ikteach.course.checking import Answer, exercise, expect
from ikteach.motion import gait

SAMPLES = 400  # of one cycle
GROUND = 1e-6  # [m]; a foot no higher stands on the ground
CLEARANCE = 0.03  # [m]


@exercise(
    "07.pace",
    returns=(),
    hints=[
        "Where is the foot under the body, and how fast does z = A sin(ωT) change there?",
        "The derivative is Aω cos(ωT). A speed has no sign: what if A or ω has one?",
    ],
)
def pace(answer: Answer) -> None:
    """pace(A, omega): the speed of the body at which the foot under it stands still [m/s]."""
    rng = np.random.default_rng(7)
    for A, omega in [(0.25, 5.6), (0.5, 9.0), (-0.25, 5.6), *rng.uniform(0.1, 3, (4, 2))]:
        walk = replace(gait.walking, front_z_leg=float(A), speed=float(omega))
        T, dt = np.pi / abs(omega), 1e-6  # half a period: the foot is under the body
        z = walk(np.array([T - dt, T + dt]))[:, 1, 2]
        speed = abs(z[1] - z[0]) / (2 * dt)
        found = float(answer(float(A), float(omega)))
        expect(found >= 0, f"`{answer.call}` is {found:.3g}: a speed is not negative.")
        expect(
            abs(found - speed) < 1e-3 * speed,
            f"`{answer.call}` is {found:.3g} m/s; there the foot goes back at {speed:.3g} m/s.",
        )


@exercise(
    "07.path",
    returns=lambda phase: (*phase.shape, 2),
    hints=[
        "Cut the cycle in two: a stance of 0.6 of it, on the ground, and a swing through the air.",
        "In the stance z falls in a straight line. In the swing it comes back smoothly, and the "
        "height is something like 0.06 sin²: zero at both ends.",
    ],
)
def path(answer: Answer) -> None:
    """path(phase (m,)) -> (m, 2): height over the ground and z of a foot [m], phase in cycles."""
    phase = np.arange(2 * SAMPLES) / SAMPLES
    y, z = answer(phase).T
    for what, values in (("height", y), ("z", z)):
        expect(
            np.allclose(values[:SAMPLES], values[SAMPLES:], atol=1e-6),
            f"The {what} at phase p + 1 is not that at phase p: a walk goes round and round.",
        )
    expect(y.min() > -GROUND, f"The foot goes {-100 * y.min():.1f} cm into the ground.")
    jump = max(abs(np.diff(y)).max(), abs(np.diff(z)).max())
    expect(jump < 0.05, f"The foot jumps by {100 * jump:.0f} cm at once.")
    stands = y < GROUND
    expect(stands.any(), "The foot never stands on the ground.")
    expect(
        y.max() >= CLEARANCE,
        f"The foot lifts by {100 * y.max():.1f} cm; it needs 3 cm to clear the ground.",
    )
    other = np.roll(stands, SAMPLES // 2)
    expect(
        (stands | other).all(),
        "There are moments when neither this foot nor the other one, half a cycle apart, stands.",
    )
    speed = np.diff(z) * SAMPLES
    carried = speed[stands[:-1] & stands[1:]]
    expect(
        carried.mean() < 0,
        "While it stands, a foot must go back under the body: z must fall.",
    )
    slide = abs(carried - carried.mean()).max() / abs(carried.mean())
    expect(
        slide < 0.02,
        f"While it stands, the foot's speed differs by {100 * slide:.0f} % from its mean: "
        "it skates over the ground.",
    )
