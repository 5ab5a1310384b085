"""Families of chapters 3 to 6: what the four methods answer."""

import numpy as np

from ikteach.motion.rules import whole
from ikteach.publish.pack.bank import Numeric, family, on_grid
from ikteach.solvers import dls, pseudoinverse, transpose
from ikteach.solvers.dls import filtered
from ikteach.solvers.sdls import bounds, hard


@family("03.alpha")
def _alpha(rng: np.random.Generator) -> Numeric:
    """Ask for the best α of the transpose."""
    a, b, c = (int(rng.integers(1, 5)) for _ in range(3))
    J, e = np.array([[a, 0], [b, c]], dtype=float), rng.integers(1, 4, 2).astype(float)
    slope = J.T @ e
    best = float(transpose(J, e) @ slope / (slope @ slope))
    return Numeric(
        f"The rows of J are ({a}, 0), ({b}, {c}), and e = ({e[0]:g}, {e[1]:g}). Which α makes "
        "‖e − α J Jᵀe‖ least?",
        best,
        "",
        "⟨e, JJᵀe⟩ / ⟨JJᵀe, JJᵀe⟩: the lowest point of a parabola.",
        {
            "This has the extra ½ that the thesis prints.": best / 2,
            "This is the α of u₁ alone, 1/σ₁².": float(1 / np.linalg.svdvals(J)[0] ** 2),
        },
    )


@family("03.left")
def _left(rng: np.random.Generator) -> Numeric:
    """Ask what of the error a gain leaves."""
    best, gain = on_grid(rng, 0.1, 0.6, 0.05), on_grid(rng, 0.2, 2.6, 0.2)
    J, e = np.array([[1.0], [np.sqrt(best / (1 - best))]]), np.array([1.0, 0.0])
    share = float(np.sum((e - J @ transpose(J, e, gain=gain)) ** 2))
    return Numeric(
        f"A step with the best α would leave {best:g} of ‖e‖², by the linear model. What share of "
        f"‖e‖² does {gain:g} times that α leave?",
        share,
        "",
        "A parabola in the gain: 1 at gain 0, the least at gain 1, and 1 again at gain 2.",
        {
            "It is no straight line: the way from 1 to the best is a parabola.": 1
            - gain * (1 - best)
        },
    )


@family("04.shortest")
def _shortest(rng: np.random.Generator) -> Numeric:
    """Ask for the shortest of all answers."""
    a, b = on_grid(rng, 0.2, 2, 0.1), on_grid(rng, 0.2, 2, 0.1)
    e = on_grid(rng, 0.1, 0.9, 0.1)
    dtheta = pseudoinverse(np.array([[a, b]]), np.array([e]))
    return Numeric(
        f"Two joints move a hand along one line: J = ({a:g}  {b:g}) m/rad, and e = {e:g} m. By how "
        "much does the pseudoinverse turn the first joint?",
        float(dtheta[0]),
        "rad",
        "J⁺ = Jᵀ / (a² + b²): of all answers the shortest is shared in proportion to a and b.",
        {
            "The first joint alone could do it; the shortest step uses both.": e / a,
            "This shares the way equally; the shortest step does not.": e / (2 * a),
        },
    )


@family("04.length")
def _length(rng: np.random.Generator) -> Numeric:
    """Ask how long a step of the pseudoinverse is."""
    strong, weak = on_grid(rng, 1, 2, 0.1), on_grid(rng, 0.03, 0.2, 0.01)
    across, along = on_grid(rng, 0.05, 0.2, 0.05), on_grid(rng, 0.02, 0.1, 0.02)
    dtheta = pseudoinverse(np.diag([strong, weak]), np.array([across, along]))
    return Numeric(
        f"J has the singular values {strong:g} and {weak:g} m/rad. The error has the part "
        f"{across:g} m along u₁ and {along:g} m along u₂. How long is the pseudoinverse's step?",
        float(np.linalg.norm(dtheta)),
        "rad",
        "Each part is divided by its own σ; nothing raises an error, and the weak one decides.",
        {
            "Each direction has a σ of its own.": np.hypot(across, along) / strong,
            "Lengths of parts at right angles add by Pythagoras.": across / strong + along / weak,
        },
    )


@family("04.cap")
def _cap(rng: np.random.Generator) -> Numeric:
    """Ask what one cap for the whole step leaves a foot."""
    arm, leg, most = on_grid(rng, 30, 90, 5), on_grid(rng, 2, 4.5, 0.5), 5
    chains = np.array([0, 1])
    capped = whole(np.array([arm, leg]), most, chains)
    return Numeric(
        f"In one step a shoulder would turn by {arm:g}° and a knee by {leg:g}°. The whole step is "
        f"capped so that no joint turns by more than {most}°. By how much does the knee turn?",
        float(capped[1]),
        "°",
        "All joints are shortened together, so the knee pays for the shoulder.",
        {"So it would be if each chain had a cap of its own.": leg, "This is the shoulder.": most},
    )


@family("05.answer")
def _answer(rng: np.random.Generator) -> Numeric:
    """Ask what DLS answers to one direction."""
    sigma, damping = on_grid(rng, 0.02, 0.4, 0.02), on_grid(rng, 0.05, 0.5, 0.05)
    return Numeric(
        f"Along one direction σ = {sigma:g} m/rad, and λ = {damping:g} m/rad. By how many radians "
        "does DLS answer one metre of error along it?",
        float(filtered(sigma, damping)),
        "rad/m",
        "σ / (σ² + λ²); for σ = 0 that is 0, whatever λ is.",
        {
            "This is the pseudoinverse: 1/σ.": 1 / sigma,
            "λ is not added to σ: it is λ² that is added to σ².": 1 / (sigma + damping),
        },
    )


@family("05.bound")
def _bound(rng: np.random.Generator) -> Numeric:
    """Ask for the longest step that damping allows."""
    damping, far = on_grid(rng, 0.05, 0.8, 0.05), on_grid(rng, 0.05, 0.6, 0.05)
    step = dls(np.array([[damping]]), np.array([far]), damping=damping)  # the worst J: σ = λ
    return Numeric(
        f"λ = {damping:g} m/rad and ‖e‖ = {far:g} m. How long can the step of DLS be at most, "
        "whatever J is?",
        float(abs(step[0])),
        "rad",
        "σ/(σ² + λ²) is largest at σ = λ: 1/2λ. So ‖Δθ‖ ≤ ‖e‖/2λ.",
        {
            "At σ = λ there is λ² twice in the denominator.": far / damping,
            "It is reached: a larger step than half of that is possible.": far / damping / 4,
        },
    )


@family("05.unit")
def _unit(rng: np.random.Generator) -> Numeric:
    """Ask for λ in other units."""
    lengths = [("centimetres", 100.0), ("millimetres", 1000.0), ("feet", 1 / 0.3048)]
    name, per_metre = lengths[int(rng.integers(3))]
    turns, per_radian = [("radians", 1.0), ("degrees", 180 / np.pi)][int(rng.integers(2))]
    damping = on_grid(rng, 0.05, 0.8, 0.05)
    there = per_metre / per_radian  # σ = 1 m/rad in the other unit
    answered = float(dls(np.eye(1), np.ones(1), damping=damping)[0]) / there
    same = float(np.sqrt(there / answered - there**2))  # of σ/(σ² + λ²) = answered
    return Numeric(
        f"λ = {damping:g} m/rad. Which number does the same where lengths are in {name} and angles "
        f"in {turns}?",
        same,
        "",
        "It stands beside σ, so it has the unit of σ: a length per angle.",
        {
            "λ has a unit, so its number changes.": damping,
            "Longer numbers of length make a larger λ, not a smaller one.": damping / there,
            "It is λ, not λ², that has the unit of σ.": damping * there**2,
        },
    )


@family("06.gamma")
def _gamma(rng: np.random.Generator) -> Numeric:
    """Ask for the bound of one direction."""
    one, two = on_grid(rng, 0.3, 1, 0.05), on_grid(rng, 0.3, 1, 0.05)
    c, s, most = 0.8, 0.6, 45
    across = (one**2 - two**2) * c * s / (c**2 - s**2)  # so that (c, s) is a singular direction
    if abs(across) >= one * two:  # there are no such columns
        return Numeric("", 0, "", "", {})
    J = np.array([[one, across / one], [0, np.sqrt(two**2 - (across / one) ** 2)], [0, 0]])
    U, sigma, Vt = np.linalg.svd(J, full_matrices=False)
    _, M, bound = bounds(J, U, sigma, Vt, np.radians(most))
    i = int(abs(abs(Vt) - [c, s]).sum(axis=1).argmin())
    if Vt[i, 0] * Vt[i, 1] < 0:
        return Numeric("", 0, "", "", {})
    return Numeric(
        f"One effector and two joints: the columns of J have the lengths {one:g} and {two:g} "
        f"m/rad. A direction has v = ({c:g}, {s:g}) and σ = {sigma[i]:.4f} m/rad. γ_max is "
        f"{most}°. By which angle does SDLS bound it?",
        float(np.degrees(bound[i])),
        "°",
        "N = 1, since u is a unit vector; M = (|v₁| ρ₁ + |v₂| ρ₂)/σ; γ = min(1, N/M) γ_max.",
        {
            "Much effort for little gain is bounded by less than γ_max.": most,
            "The bound gets smaller with the effort M, not larger.": most * float(M[i]),
        },
    )


@family("06.clamp")
def _clamp(rng: np.random.Generator) -> Numeric:
    """Ask for a step that is shortened as a whole."""
    peak, other, most = on_grid(rng, 50, 120, 5), on_grid(rng, 10, 40, 5), 45
    short = hard(np.array([-peak, other]), most)
    return Numeric(
        f"The step φ would turn two joints by −{peak:g}° and {other:g}°. It is clamped to "
        f"{most}°, so that its direction stays. By how much does the second joint turn?",
        float(short[1]),
        "°",
        "The whole φ is shortened by bound / largest entry.",
        {
            "Cutting entries by themselves would change the direction.": other,
            "This is the bound: the first joint turns so far, and the second less.": most,
        },
    )
