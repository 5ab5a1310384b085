"""Several sessions on one clock: figures side by side, each with a motion of its own."""

from collections.abc import Mapping

from ikteach.motion.live.session import Session


class Abreast:
    """Sessions that tick together.

    sessions  {name: Session}, one or more, all with the same `dt`
    dt        clock time of one tick [s]
    ticks     how many have passed since the last reset

    ValueError if there are none, or their clocks differ.
    """

    def __init__(self, sessions: Mapping[str, Session]) -> None:
        self.sessions = dict(sessions)
        clocks = {session.dt for session in self.sessions.values()}
        if len(clocks) != 1:
            raise ValueError(f"sessions abreast have one clock, not {len(clocks)}")
        (self.dt,) = clocks
        self.ticks = 0

    def tick(self) -> None:
        """Let one tick of the clock pass in each."""
        for session in self.sessions.values():
            session.tick()
        self.ticks += 1

    def reset(self) -> None:
        """Send all back to their starts."""
        for session in self.sessions.values():
            session.reset()
        self.ticks = 0
