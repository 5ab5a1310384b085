"""The ground under a recording: how fast it goes by, how high it is, and who stands on it."""

from typing import NamedTuple

import numpy as np

from ikteach.arrays import Array, Mask

LOW_SHARE, ROUNDS = 0.4, 5  # of the frames that tell where the ground is; of the search for them
NEAR_GROUND = 0.03  # a sole that is lower may stand [m]
GOES = 0.3  # a body that goes faster goes somewhere [m/s]


class Ground(NamedTuple):
    """The ground of a recording, and a frame that goes along.

    way    (T, 3) of that frame [m]
    speed  of that frame along z, or of the standing soles back, if it walks in place [m/s]
    still  whether it stays in its place
    rise   (T,) of the ground over its own mean [m]; it is a line in time
    floor  its height, as the frame has it [m]
    down   (T, s) which soles stand
    """

    way: Array
    speed: float
    still: bool
    rise: Array
    floor: float
    down: Mask

    @classmethod
    def under(cls, times: Array, soles: Array, root: Array) -> "Ground":
        """Find the ground under soles (T, s, 3), and a root (T, 3) above it.

        It is where the lower foot is, a line in time. A sole stands while it goes back as the body
        has it (Zeni, Richards & Higginson 2008, Gait & Posture 27:710) and is low.
        """
        speed, start = np.polyfit(times, root[:, 2], 1)
        x, y, _ = root.mean(axis=0)
        way = np.stack([0 * times + x, 0 * times + y, speed * times + start], axis=-1)
        lowest = soles[..., 1].min(axis=1)
        line = np.zeros_like(lowest)
        for _ in range(ROUNDS):  # the frames that are lowest over the line, which they then make
            over = lowest - line
            near = over <= np.quantile(over, LOW_SHARE)
            line = np.polyval(np.polyfit(times[near], lowest[near], 1), times)
        goes = np.gradient(soles[..., 2] - way[:, None, 2], times, axis=0)
        down = (goes < 0) & (soles[..., 1] - line[:, None] < NEAR_GROUND)
        still = bool(abs(speed) < GOES)
        back = -float(np.median(goes[down])) if down.any() else 0.0
        floor = float(line.mean() - y)
        return cls(way, back if still else float(speed), still, line - line.mean(), floor, down)

    def strides(self, left: list[int]) -> slice | None:
        """Find whole strides: from foot down to foot down.

        left  the soles of that foot

        From there the motion can begin anew without a leap. None if it comes down less than twice.
        """
        down = np.asarray(self.down[:, left].any(axis=1))
        begins = np.flatnonzero(np.diff(down.astype(int)) > 0) + 1
        return slice(int(begins[0]), int(begins[-1])) if len(begins) > 1 else None
