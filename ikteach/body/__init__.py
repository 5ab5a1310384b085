"""The figure, kept as a table: its joints, its effectors, where they are, how they move."""

from ikteach.body import figures
from ikteach.body.forward import Frames, forward, locate
from ikteach.body.jacobian import jacobian
from ikteach.body.tree import Effectors, Joint, Tree

__all__ = ["Effectors", "Frames", "Joint", "Tree", "figures", "forward", "jacobian", "locate"]
