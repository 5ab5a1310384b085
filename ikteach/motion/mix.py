"""Several methods as one solver: one for each effector, or one for each pose of a batch."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from ikteach.arrays import Array, frozen
from ikteach.body import Effectors
from ikteach.checks import shown
from ikteach.motion.checks import solver_of
from ikteach.motion.here import Here, situated, wants
from ikteach.names import unknown
from ikteach.solvers import Solver, ask, name_of


@dataclass(frozen=True, eq=False)
class Mix:
    """A solver put together from those of the effectors.

    Every joint moves as its effector's method would have it.

    Each distinct method m solves for the whole body, Δθᵐ = m(J, e). A joint that carries only one
    effector takes its entry from that effector's method; a joint that carries several, such as the
    spine, takes the mean over them: Δθ_j = Σ_m share_mj Δθᵐ_j. Of one method alone, a mix is that
    method. A promise that the methods make of JΔθ together, a mix does not make.

    methods  {effector: solver or its name}, one for every effector
    share    (methods, n)  of the effectors that joint j carries, the part that method m has
    """

    solvers: tuple[Solver, ...]
    share: Array
    methods: Mapping[str, Solver]
    __name__ = "mix"

    @classmethod
    def of(cls, effectors: Effectors, methods: Mapping[str, Solver | str]) -> "Mix":
        """Make the mix for these effectors.

        LookupError for an unknown name.
        """
        if not isinstance(methods, Mapping):
            raise TypeError(f"a mix is made of {{effector: method}}, not of {shown(methods)}")
        for name in methods:
            if name not in effectors.names:
                raise LookupError(unknown("effector", name, effectors.names))
        if missing := [name for name in effectors.names if name not in methods]:
            raise ValueError(f"a mix needs a method for every effector; {missing[0]!r} has none")
        chosen = [solver_of(methods[name]) for name in effectors.names]
        distinct = list({id(one): one for one in chosen}.values())
        has = np.array([[one is other for other in chosen] for one in distinct], dtype=float)
        carried = effectors.carried.astype(float)
        share = has @ carried / np.maximum(carried.sum(axis=0), 1)
        names = dict(zip(effectors.names, chosen, strict=True))
        return cls(tuple(distinct), frozen(share), names)

    @property
    def wants(self) -> tuple[str, ...]:
        """The fields of `Here` that its methods take."""
        return tuple({name for solver in self.solvers for name in wants(solver)})

    def situated(self, here: Here) -> "Mix":
        """Give each of its methods what it wants."""
        return replace(self, solvers=tuple(situated(solver, here) for solver in self.solvers))

    def __call__(self, J: Array, e: Array) -> Array:
        """Δθ (..., n) for J (..., 3k, n) and e (..., 3k); the errors are those of `ask`."""
        parts = zip(self.solvers, self.share, strict=True)
        return np.sum([share * ask(solver, J, e) for solver, share in parts], axis=0)

    def __repr__(self) -> str:
        each = ", ".join(f"{name}: {name_of(solver)}" for name, solver in self.methods.items())
        return f"Mix({each})"


class PerPose:
    """A solver that has a method for each pose.

    Pose i of J (p, m, n) and e (p, m) is solved by the i-th method. It serves for one `step`. Where
    that asks again because of limits, only the poses whose J is another than before are solved
    anew.
    """

    def __init__(self, solvers: Iterable[Solver | str]) -> None:
        self.solvers = [solver_of(solver) for solver in solvers]
        self._J: Array | None = None

    @property
    def wants(self) -> tuple[str, ...]:
        """The fields of `Here` that its methods take."""
        return tuple({name for solver in self.solvers for name in wants(solver)})

    def situated(self, here: Here) -> "PerPose":
        """Give each method what it wants at its pose."""
        return PerPose(situated(solver, here.at(i)) for i, solver in enumerate(self.solvers))

    def __call__(self, J: Array, e: Array) -> Array:
        """Δθ (p, n); the errors are those of `ask`, and name the method."""
        if self._J is None:
            self._dtheta, asked = np.empty((len(J), J.shape[-1])), range(len(J))
        else:
            asked = (J != self._J).any(axis=(-2, -1)).nonzero()[0]
        for i in asked:
            self._dtheta[i] = ask(self.solvers[i], J[i], e[i])
        self._J = J
        return self._dtheta.copy()
