"""Chapter 8. Sentences of Y. Y. She's thesis, each as a comparison that can be computed.

A sentence is data: of whom it is said, against whom, by which measures of which table. `verdicts`
holds all of them against the numbers, by the rules of `verdicts.py`; nothing here knows the answer.
Words in quotation marks are the thesis's, the others tell what it says.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

import pandas as pd

from ikteach.solvers import SOLVERS
from ikteach.study.evidence import Evidence
from ikteach.study.verdicts import MARGIN, Finding, against, against_bound, weigh

FAR = ("mean", "p95")
CALM = ("acceleration", "reversals")
MEASURES = {  # in words
    "mean": "mean distance",
    "p95": "its 95 %",
    "reach": "distance of those that can reach",
    "out_of_reach": "of those that cannot",
    "acceleration": "jitter in rad/s²",
    "reversals": "reversals",
    "miss": "how near any pose comes",
    "leap": "leap in a frame",
    "met": "share of frames with d ≤ 0",
    "step": "time of a step",
    "solve": "time of the solver alone",
    "steps": "steps to arrive",
    "seconds": "time to arrive",
    "operations": "operations of a step",
    "turn": "largest turn in a step",
    "slip": "slide of a foot in a stance",
    "clearance": "lift of a foot",
    "weakest": "σ_min / σ_max",
    "formula": "its gap to the pseudoinverse",
    "unitary": "‖UᵀU − I‖",
    "axes": "axes that move",
    "half": "what it leaves of e, against all of α",
    "at_targets": "change of J, as share of it",
    "drawn": "from the drawn foot to the logged one",
}
SIGNS = {"less": "<", "more": ">", "at most": "≤"}
THESIS = MappingProxyType({"motion": ("walking", "running")})


@dataclass(frozen=True)
class Claim:
    """A sentence that can be computed.

    section   where it stands
    says      a few of its words
    table     the field of `Evidence` that it is held against
    measures  the columns
    who       of whom it is said: values of the column `factor`; empty if of all rows
    whom      against whom; empty if against `bound`
    where     {column: values} of the rows that it speaks of
    relation  "less", "more" or "at most"
    margin    the share by which numbers must differ
    bound     a number, its factor for reading, and the unit in which it is read
    """

    section: str
    says: str
    table: str
    measures: tuple[str, ...]
    who: tuple[object, ...] = ()
    whom: tuple[object, ...] = ()
    factor: str = "method"
    where: Mapping[str, Iterable[object]] = field(default_factory=dict)
    relation: str = "less"
    margin: float = MARGIN
    bound: tuple[float, float, str] = (0.0, 1.0, "")

    def rows(self, table: pd.DataFrame) -> pd.DataFrame:
        """Take the rows that the sentence speaks of."""
        for column, values in self.where.items():
            table = table[table[column].isin(list(values))]
        return table

    def verdict(self, table: pd.DataFrame) -> Finding:
        """Hold the sentence against a table."""
        rows = self.rows(table)
        if self.whom:
            cells = against(rows, self.who, self.whom, self.measures, self.factor)
        else:
            cells = against_bound(rows, self.measures[0], self.bound[0])
        return weigh(cells, self.relation, self.margin)

    @property
    def measured(self) -> str:
        """The comparison in words."""
        what = ", ".join(MEASURES[name] for name in self.measures)
        sign, by = SIGNS[self.relation], f"{self.margin:.0%}"
        if not self.whom:
            size, factor, unit = self.bound
            return f"{what} {sign} {size * factor:.4g} {unit}".strip() + f", by {by}"
        return f"{what}: {_or(self.who)} {sign} {_or(self.whom)}, by {by}"

    def number(self, verdict: Finding) -> str:
        """Write the middle of the cells, and their spread.

        Eight tenths of the cells are in the spread.
        """
        _, by, unit = self.bound
        size = 1.0 if self.whom else self.bound[0]
        low, middle, high = (f"{ratio * size * by:.3g}" for ratio in verdict.ratios)
        spread = f" ({low} to {high})" if (low, high) != (middle, middle) else ""
        return f"{'× ' if self.whom else ''}{middle}{spread} {unit}".strip()


def _or(names: tuple[object, ...]) -> str:
    return " or ".join(map(str, names)) if len(names) < 3 else ", ".join(map(str, names))


ONE, PINV, DLS, SDLS = (("transpose",), ("pseudoinverse",), ("dls",), ("sdls",))
OTHERS = {name: tuple(other for other in SOLVERS if other != name) for name in SOLVERS}
FEET, HANDS = ("foot.l", "foot.r"), ("hand.l", "hand.r")
CM, MM = (0.01, 100, "cm"), (0.001, 1000, "mm")
QUICK = 0.25  # the margin of times, which a machine that does other things blurs
HAND = (0.1, 100, "cm")  # about as wide as a hand
SWING = (3.0, 1.0, "per s")  # a joint that swings once in a cycle of running has 2.9

CLAIMS = (
    Claim(
        "5.3",
        "increments “small enough” to look smooth",
        "leaps",
        ("leap",),
        where=THESIS,
        bound=HAND,
    ),
    Claim(
        "5.3",
        "walking: both leg targets reachable",
        "reach",
        ("miss",),
        where={"motion": ["walking"], "effector": FEET},
        bound=MM,
    ),
    Claim(
        "5.3",
        "walking: the hands' targets never",
        "reach",
        ("miss",),
        where={"motion": ["walking"], "effector": HANDS},
        relation="more",
        bound=MM,
    ),
    Claim(
        "5.3",
        "running: four targets unreachable",
        "reach",
        ("miss",),
        where={"motion": ["running"]},
        relation="more",
        bound=MM,
    ),
    Claim(
        "5.3",
        "the transpose “is fast”",
        "times",
        ("solve",),
        ONE,
        OTHERS["transpose"],
        margin=QUICK,
    ),
    Claim(
        "5.3",
        "the same, until the target",
        "arrivals",
        ("seconds",),
        ONE,
        OTHERS["transpose"],
        margin=2 * QUICK,
    ),
    Claim(
        "4.4.5, 5.3, 7.1",
        "the transpose performed “poorly”, worst",
        "runs",
        FAR,
        OTHERS["transpose"],
        ONE,
        where=THESIS,
    ),
    Claim(
        "5.3, 7.1",
        "the transpose “looks jerky and oscillates”",
        "runs",
        CALM,
        OTHERS["transpose"],
        ONE,
        where=THESIS,
    ),
    Claim(
        "5.3",
        "the same, with “very small” increments",
        "small",
        FAR,
        OTHERS["transpose"],
        ONE,
    ),
    Claim(
        "4.4.1, 5.3, 7.1",
        "the transpose is good with one target",
        "single",
        ("mean",),
        ONE,
        OTHERS["transpose"],
        relation="at most",
    ),
    Claim(
        "5.3, 7.1",
        "pseudoinverse: “little bit better” in smoothness",
        "runs",
        CALM,
        PINV,
        ONE,
        where=THESIS,
    ),
    Claim("7.1", "pseudoinverse: “slightly better results”", "runs", FAR, PINV, ONE, where=THESIS),
    Claim(
        "5.3",
        "pseudoinverse: walking better than running",
        "runs",
        ("mean", *CALM),
        ("walking",),
        ("running",),
        "motion",
        where={"method": PINV},
    ),
    Claim(
        "5.3",
        "pseudoinverse: “properly” if all is reachable",
        "runs",
        ("mean", *CALM),
        PINV,
        OTHERS["pseudoinverse"],
        where={"motion": ["in reach"]},
        relation="at most",
    ),
    Claim(
        "5.3",
        "unreachable targets made it oscillate",
        "runs",
        CALM,
        ("in reach",),
        ("walking",),
        "motion",
        where={"method": PINV},
    ),
    Claim(
        "5.3",
        "pseudoinverse: “still poor”",
        "runs",
        ("mean", *CALM),
        DLS + SDLS,
        PINV,
        where=THESIS,
    ),
    Claim(
        "5.3",
        "DLS “substantially better” than both",
        "runs",
        ("mean", *CALM),
        DLS,
        ONE + PINV,
        where=THESIS,
        margin=0.25,
    ),
    Claim(
        "5.3",
        "DLS “natural and smooth”",
        "runs",
        ("reversals",),
        where={**THESIS, "method": DLS},
        bound=SWING,
    ),
    Claim("5.3", "DLS behind SDLS where targets are reachable", "runs", ("reach",), SDLS, DLS),
    Claim(
        "5.3, 7.1",
        "SDLS “best performance of all four”",
        "runs",
        ("mean", *CALM),
        SDLS,
        OTHERS["sdls"],
        where=THESIS,
    ),
    Claim(
        "5.3",
        "SDLS best, reachable or not",
        "runs",
        ("reach", "out_of_reach"),
        SDLS,
        OTHERS["sdls"],
    ),
    Claim(
        "5.3",
        "SDLS “slower than the other algorithms”",
        "times",
        ("solve",),
        OTHERS["sdls"],
        SDLS,
        margin=QUICK,
    ),
    Claim(
        "5.3",
        "SDLS slower, until the target",
        "arrivals",
        ("seconds",),
        OTHERS["sdls"],
        SDLS,
        margin=QUICK,
    ),
    Claim(
        "5.3",
        "SDLS “requires the most calculation”",
        "operations",
        ("operations",),
        OTHERS["sdls"],
        SDLS,
    ),
    Claim(
        "4.4.5",
        "the transpose uses “fewer computations”",
        "operations",
        ("operations",),
        ONE,
        OTHERS["transpose"],
    ),
    Claim(
        "7.1",
        "DLS, SDLS have “greater complexity” than the others",
        "operations",
        ("operations",),
        ONE + PINV,
        DLS + SDLS,
    ),
    Claim(
        "7.1",
        "the transpose needs “the least iteration”",
        "arrivals",
        ("steps",),
        ONE,
        OTHERS["transpose"],
    ),
    Claim(
        "7.1",
        "transpose and pseudoinverse: problems near singular",
        "near",
        ("turn",),
        where={"method": ONE + PINV},
        relation="more",
        bound=(45.0, 1.0, "°"),
    ),
    Claim(
        "7.1",
        "DLS, SDLS “not slower” than the other two",
        "arrivals",
        ("seconds",),
        DLS + SDLS,
        ONE + PINV,
        relation="at most",
        margin=QUICK,
    ),
    Claim(
        "7.1",
        "the same, one step",
        "times",
        ("solve",),
        DLS + SDLS,
        ONE + PINV,
        relation="at most",
        margin=QUICK,
    ),
    Claim(
        "7.1",
        "DLS, SDLS “much better animation”",
        "runs",
        ("mean", *CALM),
        DLS + SDLS,
        ONE + PINV,
        where=THESIS,
        margin=0.25,
    ),
    Claim(
        "4.4.1",
        "the transpose “much faster” than an inverse",
        "times",
        ("solve",),
        ONE,
        PINV,
        margin=QUICK,
    ),
    Claim(
        "4.4.2",
        "pseudoinverse: “instability near singularities”",
        "near",
        ("turn",),
        where={"method": PINV},
        relation="more",
        bound=(45.0, 1.0, "°"),
    ),
    Claim(
        "4.4.2",
        "a cap lessens what singular poses do to it",
        "runs",
        CALM,
        ("own",),
        ("equal",),
        "caps",
        where={**THESIS, "method": PINV},
    ),
    Claim(
        "4.4.2",
        "capped, it is “unable to effectively track”",
        "runs",
        ("reach",),
        ("equal",),
        ("own",),
        "caps",
        where={"method": PINV},
    ),
    Claim(
        "4.4.3",
        "DLS “avoids many” of its problems near singular",
        "near",
        ("turn",),
        DLS,
        PINV,
        margin=0.25,
    ),
    Claim(
        "4.4.3",
        "λ “must be chosen very carefully”",
        "runs",
        CALM,
        (0.4, 0.8),
        (0.05, 0.1),
        "damping",
        where={**THESIS, "method": DLS},
        margin=0.25,
    ),
    Claim(
        "4.4.5",
        "SDLS: “reduced oscillate”, against the pseudoinverse",
        "runs",
        CALM,
        SDLS,
        PINV,
        where=THESIS,
    ),
    Claim("4.4.5", "the same, a step near a singular pose", "near", ("turn",), SDLS, PINV),
    Claim("7.2", "“real time” is possible", "times", ("step",), bound=(1 / 30, 1000, "ms")),
    Claim(
        "7.2",
        "human motion without capture: feet that stand",
        "feet",
        ("slip",),
        bound=(0.02, 100, "cm"),
    ),
    Claim("7.2", "the same: feet that lift", "feet", ("clearance",), relation="more", bound=CM),
)
SLIPS = (
    Claim("5.3", "“d ≤ 0” is reachable", "feet", ("met",), relation="more", bound=(0.5, 100, "%")),
    Claim(
        "4.3.2",
        "a row of zeroes: “almost singular”, not wholly",
        "algebra",
        ("weakest",),
        where={"pose": ["straight"]},
        relation="more",
        bound=(1e-12, 1, ""),
    ),
    Claim(
        "4.4.2",
        "“defined for all matrices”: Jᵀ(JJᵀ)⁻¹",
        "algebra",
        ("formula",),
        where={"pose": ["straight", "bent"]},
        bound=(1e-6, 1, ""),
    ),
    Claim(
        "4.4.4",
        "all of D's diagonal “non-zero”",
        "algebra",
        ("weakest",),
        where={"pose": ["straight", "bent"]},
        relation="more",
        bound=(1e-12, 1, ""),
    ),
    Claim(
        "4.4.4",
        "an m × n matrix U that is orthogonal",
        "algebra",
        ("unitary",),
        bound=(1e-9, 1, ""),
    ),
    Claim(
        "4.3",
        "“closed-form” solutions: one step arrives",
        "arrivals",
        ("steps",),
        bound=(1.5, 1, "steps"),
    ),
    Claim(
        "5.2, 5.3",
        "targets move in X, Y and Z",
        "algebra",
        ("axes",),
        relation="more",
        bound=(2.0, 1, "axes"),
    ),
    Claim(
        "4.4.1",
        "its α leaves least of e (our reading: Δt = JJᵀe)",
        "algebra",
        ("half",),
        relation="at most",
        bound=(1.0, 1, ""),
    ),
    Claim(
        "3.2",
        "J formed at the targets is the same (our reading)",
        "algebra",
        ("at_targets",),
        bound=(0.01, 100, "%"),
    ),
    Claim(
        "5.1.1",
        "joints “rotate more easily” (our reading: as drawn)",
        "algebra",
        ("drawn",),
        bound=(0.01, 100, "cm"),
    ),
)


def verdicts(evidence: Evidence, claims: Iterable[Claim] = CLAIMS) -> pd.DataFrame:
    """Hold sentences against the numbers, a row each.

    measured by   the comparison, and the margin within which numbers count as equal
    verdict       of all conditions, and in which share of how many cells it holds
    number        what who has as multiple of what whom has, or the measure itself: of the middle
                  cell, and from … to … of eight tenths of the cells
    turned by     in which share of the cells it holds at each value of the factors that turn it
    own settings  the verdict with the thesis's own settings, where runs decide
    """
    rows = []
    for claim in claims:
        found = claim.verdict(getattr(evidence, claim.table))
        own = claim.table == "runs" and claim.factor != "caps"
        rows.append(
            {
                "section": claim.section,
                "says": claim.says,
                "measured by": claim.measured,
                "verdict": found.word,
                "in": f"{found.share:.0%} of {found.cells}",
                "number": claim.number(found),
                "turned by": found.where,
                "own settings": claim.verdict(evidence.own).word if own else "",
            }
        )
    return pd.DataFrame(rows).set_index(["section", "says"])
