"""Families of chapters 7 to 12: gaits, measures, one iteration, directions."""

from dataclasses import replace

import numpy as np

from ikteach import figures, forward, gait, locate, step
from ikteach.body import Effectors, Joint, Tree
from ikteach.motion import clip
from ikteach.motion.paths.quality import norms, score_of
from ikteach.motion.paths.walk import Walk
from ikteach.motion.track import Track
from ikteach.publish.pack.bank import Numeric, family, on_grid

PHASES = 2 * np.pi * (np.arange(20_000) + 0.5) / 20_000


@family("07.period")
def _period(rng: np.random.Generator) -> Numeric:
    """Ask how long a cycle of a gait takes."""
    speed = on_grid(rng, 3, 12, 0.2)
    return Numeric(
        f"A foot's target goes as z = A sin(ω τ) with ω = {speed:g} rad/s. How long does a cycle "
        "take?",
        float(replace(gait.walking, speed=speed).period),
        "s",
        "2π / ω.",
        {"A cycle is 2π of phase.": 1 / speed, "This is cycles per second.": speed / (2 * np.pi)},
    )


@family("07.pace")
def _pace(rng: np.random.Generator) -> Numeric:
    """Ask for the speed at which a foot stands still."""
    A, speed, share = (
        on_grid(rng, 0.2, 0.5, 0.02),
        on_grid(rng, 4, 8, 0.2),
        on_grid(rng, 0.3, 0.8, 0.1),
    )
    z, h = round(share * A, 3), 1e-5
    walk = replace(gait.walking, speed=speed, front_z_leg=A)
    tau = _when(walk, z)
    ahead, behind = walk(np.array([tau + h, tau - h]))[:, 1, 2]
    back = float(behind - ahead) / (2 * h)
    return Numeric(
        f"A foot goes as z = A sin(ω τ), seen from the body, with A = {A:g} m and ω = {speed:g} "
        f"rad/s. It is at z = {z:g} m and goes back. At what speed of the body does it stand still "
        "on the ground at this moment?",
        back,
        "m/s",
        "ω √(A² − z²). It changes with z: no one speed will do for a whole stance.",
        {"So it is at z = 0 alone.": A * speed},
    )


def _when(walk: gait.Gait, z: float) -> float:
    """Find when the right foot is at z and goes back, by halving."""
    times = np.linspace(0, walk.period, 1000)
    feet = walk(times)[:, 1, 2]
    low, high = times[feet.argmax()], times[feet.argmax()] + walk.period / 2
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if walk(middle)[1, 2] > z else (low, middle)
    return float(low)


@family("08.jitter")
def _jitter(rng: np.random.Generator) -> Numeric:
    """Ask for the jitter of one joint."""
    degrees = np.cumsum(rng.integers(-6, 7, 5)).astype(float)
    tree, effectors = figures.planar_arm([1.0])
    theta = np.radians(degrees)[:, None]
    run = Track(
        "by hand",
        tree,
        effectors,
        np.arange(5.0),
        np.zeros((5, 1, 3)),
        theta[0],
        theta,
        np.zeros((5, 1)),
        np.zeros(5),
        np.zeros((5, 1), bool),
        0.0,
    )
    shaken = float(np.degrees(run.jitter[2:]).mean())
    told = ", ".join(f"{angle:g}°" for angle in degrees)
    return Numeric(
        f"One joint stands at {told} in five ticks. What is its mean ‖Δ²θ‖ over the last three?",
        shaken,
        "°",
        "Differences of differences: a joint that turns evenly has none.",
        {"These are first differences: how fast it turns.": float(abs(np.diff(degrees)).mean())},
    )


@family("09.iteration")
def _iteration(rng: np.random.Generator) -> Numeric:
    """Ask where one tick of a clipped joint ends."""
    start, asked = on_grid(rng, 20, 60, 1), on_grid(rng, 15, 40, 1)
    most, over = on_grid(rng, 6, 12, 1), on_grid(rng, 1, 5, 1)
    upper = start + most - over
    tree = Tree.of([Joint("hinge", upper=np.radians(upper))])
    effectors = Effectors.of(tree, {"hand": ("hinge", (1, 0, 0))})

    def solver(J: np.ndarray, e: np.ndarray) -> np.ndarray:
        return np.full(1, np.radians(asked))

    bound = np.radians(most)
    done = step(
        tree, np.radians([start]), effectors, np.zeros((1, 3)), solver, max_step=bound, limits=clip
    )
    return Numeric(
        f"A joint stands at {start:g}°, and its upper limit is {upper:g}°. The solver asks for "
        f"{asked:g}°; no joint may turn by more than {most:g}° per tick, and the rule at limits is "
        "clip. Where does it stand after the tick?",
        float(np.degrees(done.theta[0])),
        "°",
        "First the cap, then the limit.",
        {
            "The limit comes after the cap.": start + most,
            "There is a cap, and a limit.": start + asked,
        },
    )


@family("11.support")
def _support(rng: np.random.Generator) -> Numeric:
    """Ask for how much of a cycle both feet stand."""
    duty = on_grid(rng, 0.54, 0.72, 0.01)
    stands = Walk(duty=duty).stands(PHASES)
    left, right = stands[:, 1:3].any(axis=1), stands[:, 3:5].any(axis=1)
    return Numeric(
        f"In a walk each foot stands for {100 * duty:g} % of its cycle, half a cycle after the "
        "other. For how much of the cycle do both stand?",
        float(100 * (left & right).mean()),
        "%",
        "2 · duty − 1: what both have together is more than a whole cycle by that much.",
        {
            "This is how long one foot swings.": 100 * (1 - duty),
            "There are two such times in a cycle.": 100 * (duty - 0.5),
        },
    )


@family("11.score")
def _score(rng: np.random.Generator) -> Numeric:
    """Ask for the score of two sides that are off."""
    left, right = on_grid(rng, 2, 12, 1), -on_grid(rng, 2, 12, 1)
    found = {name: np.stack([norm + left, norm + right]) for name, norm in norms().items()}
    return Numeric(
        f"Every angle of the left side is {left:g}° above the norm all through the stride, every "
        f"one of the right side {-right:g}° below it. What is the score, the root of the mean of "
        "the squared differences?",
        score_of(found),
        "°",
        "Squares are averaged: two sides that are off in opposite ways are not well together.",
        {
            "Signs must not cancel: average the squares.": abs(left + right) / 2,
            "This is the mean of the sizes; the root of the mean square is asked.": (left - right)
            / 2,
        },
    )


@family("12.error")
def _error(rng: np.random.Generator) -> Numeric:
    """Ask for the error of a direction that is off."""
    length, degrees = on_grid(rng, 0.05, 0.5, 0.05), on_grid(rng, 40, 150, 10)
    tree = Tree.of([Joint("hinge")])
    arrow = {"ahead": ("hinge", (length, 0, 0))}
    effectors = Effectors.of(tree, {"tip": ("hinge", (1, 0, 0))}, directions=arrow)
    there, here = (
        locate(forward(tree, [angle]), effectors)[1] for angle in (np.radians(degrees), 0.0)
    )
    return Numeric(
        f"A direction has the length ℓ = {length:g} m, and is off by {degrees:g}°. How long is its "
        "error?",
        float(np.linalg.norm(there - here)),
        "m",
        "2ℓ sin(φ/2): the distance between the tips of two arrows.",
        {
            "This is the arc; the error is the straight line.": length * np.radians(degrees),
            "Half of the angle stands in the sine.": 2 * length * np.sin(np.radians(degrees)),
        },
    )


@family("12.lock")
def _lock(rng: np.random.Generator) -> Numeric:
    """Ask how near three hinges are to being two."""
    order, middle = ["XYZ", "YXZ", "ZXY", "ZYX"][int(rng.integers(4))], on_grid(rng, 15, 85, 5)
    axes = {"X": (1, 0, 0), "Y": (0, 1, 0), "Z": (0, 0, 1)}
    rows = [
        Joint(letter, order[i - 1] if i else None, axis=axes[letter])
        for i, letter in enumerate(order)
    ]
    tree = Tree.of(rows)
    frames = forward(tree, np.radians([20, middle, 40]))
    directions = {letter: (letter, axes[letter]) for letter in order}
    point = {"tip": (order[-1], (0.3, 0.4, 0.5))}
    found = locate(frames, Effectors.of(tree, point, directions=directions))[1:]
    return Numeric(
        f"Three hinges in one place turn about {order[0]}, {order[1]}, {order[2]}, and the middle "
        f"one stands at {middle:g}°. What is the smallest singular value of their three axes?",
        float(np.linalg.svdvals(found)[-1]),
        "",
        "√(1 − sin of the middle angle): 0 at 90°, where two axes are one line.",
        {"It is 0 at 90°, but it is not the cosine.": float(np.cos(np.radians(middle)))},
    )
