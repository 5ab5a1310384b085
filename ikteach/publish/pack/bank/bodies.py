"""Families of chapters 0 to 2 and 10: bodies, their Jacobians, singular poses."""

from itertools import pairwise

import numpy as np

from ikteach import figures, forward, jacobian, locate
from ikteach.body import Effectors, Joint, Tree
from ikteach.motion.reach.packages import ReachingFigure, in_chest, look
from ikteach.publish.pack.bank import Numeric, family, on_grid
from ikteach.solvers import cramer, determinant
from ikteach.solvers.singularity import manipulability


@family("prerequisites.arc")
def _arc(rng: np.random.Generator) -> Numeric:
    """Ask for the way of a point that is turned."""
    radius, degrees = on_grid(rng, 0.2, 1.5, 0.05), on_grid(rng, 4, 20, 1)
    tree, effectors = figures.planar_arm([radius])
    J = jacobian(tree, forward(tree, [0.0]), effectors)
    way = float(np.linalg.norm(J @ [np.radians(degrees)]))
    return Numeric(
        f"A hand is {radius:g} m from the axis of its joint. The joint turns by {degrees:g}°. "
        "How long is the arc on which the hand goes?",
        way,
        "m",
        "The radius times the angle in radians.",
        {"The angle must be in radians here.": radius * degrees},
    )


@family("00.hand")
def _hand(rng: np.random.Generator) -> Numeric:
    """Ask where a hand of two links is."""
    a, b = on_grid(rng, 0.4, 1.5, 0.1), on_grid(rng, 0.4, 1.5, 0.1)
    one, two = on_grid(rng, 10, 60, 5), on_grid(rng, 20, 100, 5)
    tree, effectors = figures.planar_arm([a, b])
    x, y, _ = locate(forward(tree, np.radians([one, two])), effectors)[0]
    straight = a * np.sin(np.radians(one)) + b * np.sin(np.radians(two))
    return Numeric(
        f"An arm in the plane has links of {a:g} m and {b:g} m. The first is turned by {one:g}° "
        f"from the x axis, the second by {two:g}° from the first, both to the left. Where is the "
        "hand? Give y.",
        float(y),
        "m",
        "The second link points along the sum of the two angles.",
        {"The second angle is measured from the first link.": straight, "This is x.": float(x)},
    )


@family("00.nearest")
def _nearest(rng: np.random.Generator) -> Numeric:
    """Ask how near a hand comes to its shoulder."""
    a, b = on_grid(rng, 0.7, 1.5, 0.05), on_grid(rng, 0.2, 0.6, 0.05)
    tree, effectors = figures.planar_arm([a, b])
    folded = locate(forward(tree, [0.0, np.pi]), effectors)[0]
    return Numeric(
        f"Two links of {a:g} m and {b:g} m turn all the way round in a plane. What is the least "
        "distance from the shoulder at which the hand can be?",
        float(np.linalg.norm(folded)),
        "m",
        "Folded back, the links leave their difference: a ring can be reached, and no disc.",
        {
            "The hand can be at the shoulder only if both links are equally long.": 0.0,
            "This is the greatest distance.": a + b,
        },
    )


@family("00.poses")
def _poses(rng: np.random.Generator) -> Numeric:
    """Ask how many ways of moving are left."""
    k = int(rng.integers(2, 6))
    n = 3 * k + int(rng.integers(2, 12))
    left = n - int(np.linalg.matrix_rank(rng.normal(size=(3 * k, n))))
    return Numeric(
        f"A body has {n} joints. {k} of its points are each to stay at a place in space. "
        "J has full rank. In how many independent ways can the joints still turn a little?",
        float(left),
        "",
        "Each place takes three coordinates away: n − 3k.",
        {"A place in space has three coordinates.": n - k, "The places take some away.": n},
    )


@family("01.arrow")
def _arrow(rng: np.random.Generator) -> Numeric:
    """Ask how long the arrow of a column is."""
    x, y, z = (on_grid(rng, 0.1, 0.9, 0.05) for _ in range(3))
    tree = Tree.of([Joint("hinge")])
    effectors = Effectors.of(tree, {"hand": ("hinge", (x, y, z))})
    J = jacobian(tree, forward(tree, [0.0]), effectors)
    return Numeric(
        f"A hinge stands at the origin and turns about the z axis. The hand is at ({x:g}, {y:g}, "
        f"{z:g}) m. How long is the hinge's column of J?",
        float(np.linalg.norm(J)),
        "m/rad",
        "v × (s − p) is as long as the hand is far from the axis; what lies along it is lost.",
        {
            "Only the distance from the axis counts, not that from the origin.": np.hypot(
                x, np.hypot(y, z)
            )
        },
    )


@family("01.zeros")
def _zeros(rng: np.random.Generator) -> Numeric:
    """Ask how many entries of J the tree makes zero."""
    trunk, limbs, each = (int(rng.integers(*ends)) for ends in ((2, 6), (2, 5), (2, 6)))
    joints = [Joint(f"trunk{i}", f"trunk{i - 1}" if i else None) for i in range(trunk)]
    for limb in range(limbs):
        names = [f"trunk{trunk - 1}", *(f"limb{limb}.{i}" for i in range(each))]
        joints += [Joint(name, below) for below, name in pairwise(names)]
    tree = Tree.of(joints)
    ends = {f"end{limb}": (f"limb{limb}.{each - 1}", (1, 0, 0)) for limb in range(limbs)}
    none = 3 * int((~Effectors.of(tree, ends).carried).sum())
    entries = 3 * limbs * len(tree)
    return Numeric(
        f"A trunk of {trunk} joints carries {limbs} limbs of {each} joints each, with an effector "
        "at the end of each limb. How many entries of J are 0 in every pose?",
        float(none),
        "entries",
        "A joint moves only what hangs from it; each effector has three rows.",
        {
            "Each effector has three rows.": none / 3,
            "These are the entries that need not be 0.": entries - none,
            "A joint of the trunk carries every limb.": none + 3 * limbs * trunk,
        },
    )


@family("01.once")
def _once(rng: np.random.Generator) -> Numeric:
    """Ask how far a linear step is off."""
    length, degrees = on_grid(rng, 0.4, 2, 0.1), on_grid(rng, 20, 70, 5)
    tree, effectors = figures.planar_arm([length])
    turn = np.radians([degrees])
    start, J = forward(tree, [0.0]), jacobian(tree, forward(tree, [0.0]), effectors)
    linear = locate(start, effectors)[0] + J @ turn
    off = float(np.linalg.norm(locate(forward(tree, turn), effectors)[0] - linear))
    return Numeric(
        f"One link of {length:g} m turns by {degrees:g}°. How far is its end from where the linear "
        "model s + JΔθ says it is?",
        off,
        "m",
        "The end goes on a circle, the model along its tangent, by the radius times the angle.",
        {
            "J is exact for a step of no length only.": 0.0,
            "This is how far the model goes.": length * float(turn[0]),
        },
    )


@family("01.cramer")
def _cramers(rng: np.random.Generator) -> Numeric:
    """Ask for one unknown by Cramer's rule."""
    J, r = rng.integers(-3, 4, (3, 3)), rng.integers(1, 6, 3)
    x = cramer(J, r)
    printed = f"The rows of J are {', '.join(_row(row) for row in J)}, and r = {_row(r)}."
    return Numeric(
        f"{printed} J x = r. What is the first number of x?",
        float(x[0]),
        "",
        "det J₁ / det J, where J₁ is J with r in place of its first column.",
        {
            "This is J r; J⁻¹ r is wanted.": float((J @ r)[0]),
            "Divide by det J.": float(x[0] * determinant(J)),
        },
    )


@family("02.sigma")
def _sigma(rng: np.random.Generator) -> Numeric:
    """Ask for the largest singular value of a triangle."""
    a, b, c = (int(rng.integers(1, 6)) for _ in range(3))
    J = np.array([[a, 0], [b, c]], dtype=float)
    largest = float(np.linalg.svdvals(J)[0])
    return Numeric(
        f"The rows of J are {_row(J[0])}, {_row(J[1])}. What is its largest singular value?",
        largest,
        "",
        "The root of the larger eigenvalue of JᵀJ.",
        {
            "Take the root: the eigenvalue of JᵀJ is σ².": largest**2,
            "This is the larger eigenvalue of J itself.": max(a, c),
        },
    )


@family("02.volume")
def _volume(rng: np.random.Generator) -> Numeric:
    """Ask for √det(JJᵀ) of two links."""
    a, b, bend = on_grid(rng, 0.5, 1.5, 0.1), on_grid(rng, 0.5, 1.5, 0.1), on_grid(rng, 10, 80, 5)
    tree, effectors = figures.planar_arm([a, b])
    J = jacobian(tree, forward(tree, np.radians([20, bend])), effectors)[:2]
    return Numeric(
        f"Two links of {a:g} m and {b:g} m in a plane, the elbow bent by {bend:g}°. What is "
        "√det(JJᵀ), the manipulability?",
        float(manipulability(J)),
        "m²/rad²",
        "a b |sin β|: it is 0 where the arm is straight.",
        {"A straight arm has none, so it goes with the sine.": a * b * np.cos(np.radians(bend))},
    )


@family("02.unit")
def _unit(rng: np.random.Generator) -> Numeric:
    """Ask for a determinant in another unit."""
    name, size = [("centimetres", 100), ("millimetres", 1000)][int(rng.integers(2))]
    length, bend = on_grid(rng, 0.5, 1.5, 0.1), on_grid(rng, 10, 80, 5)
    tree, effectors = figures.planar_arm([length, length])
    J = jacobian(tree, forward(tree, np.radians([20, bend])), effectors)[:2]
    metres = round(float(manipulability(J)), 3)
    J *= np.sqrt(metres / float(manipulability(J)))  # so that it is as it is printed
    return Numeric(
        f"An arm of two hinges in a plane has √det(JJᵀ) = {metres:g}, lengths in metres. What is "
        f"it for the same pose with lengths in {name}?",
        float(manipulability(size * J)),
        "",
        "Each of two rows counts: the square of the unit. The pose is the same.",
        {
            "The pose is the same, the number is not.": metres,
            "There are two rows, so it goes with the square.": metres * size,
        },
    )


@family("10.det")
def _det(rng: np.random.Generator) -> Numeric:
    """Ask for det J of a shoulder with two axes and an elbow."""
    a, b = on_grid(rng, 0.25, 0.4, 0.01), on_grid(rng, 0.2, 0.35, 0.01)
    lift, elbow = on_grid(rng, 15, 50, 5), on_grid(rng, 20, 80, 5)
    joints = [Joint("y", axis=(0, 1, 0)), Joint("x", "y", axis=(1, 0, 0))]
    tree = Tree.of([*joints, Joint("elbow", "x", offset=(0, a, 0), axis=(1, 0, 0))])
    effectors = Effectors.of(tree, {"hand": ("elbow", (0, b, 0))})
    frames = forward(tree, np.radians([0, lift, elbow]))
    place = locate(frames, effectors)[0]
    rho = round(float(np.hypot(place[0], place[2])), 4)
    d = abs(float(determinant(jacobian(tree, frames, effectors))))
    return Numeric(
        f"An arm has links of {a:g} m and {b:g} m, its elbow is bent by {elbow:g}°, and the hand "
        f"is {rho:g} m from the axis of the shoulder that stands upright. How large is det J, "
        "without its sign?",
        d,
        "m³/rad³",
        "ρ L₁ L₂ sin θ₃: 0 where the arm is straight, and where the hand is on that axis.",
        {
            "The distance from the axis counts too.": d / rho,
            "A straight arm is singular: it goes with the sine.": rho
            * a
            * b
            * np.cos(np.radians(elbow)),
        },
    )


@family("10.nod")
def _nod(rng: np.random.Generator) -> Numeric:
    """Ask for the nod that brings the sight to a cursor."""
    y, z, eyes = on_grid(rng, -0.2, 0.1, 0.05), on_grid(rng, 0.4, 0.8, 0.05), 0.15  # within limits
    body, back = ReachingFigure(), 0.0
    neck = body.tree.offsets[body.neck] - in_chest(body, np.zeros(3), back)
    nods = np.degrees(look(body, neck + [0, y, z], back, eyes))
    return Numeric(
        f"A cursor is {y:g} m above the neck (below it if negative) and {z:g} m ahead of it. The "
        f"eyes are {eyes:g} m above the neck, and look at right angles to the line from it. By how "
        "many degrees does the neck nod down, so that the line of sight meets the cursor?",
        float(nods),
        "°",
        "arcsin(eyes / distance) − atan2(y, z): the line of sight passes the neck at that height.",
        {"The eyes are above the neck.": float(np.degrees(-np.arctan2(y, z)))},
    )


def _row(row: np.ndarray) -> str:
    return f"({', '.join(f'{float(x):g}' for x in row)})"
