"""Chapter 10. Reaching as tables: each way in one session, to many cursors, tick by tick."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from ikteach.arrays import ArrayLike
from ikteach.checks import count, numbers
from ikteach.motion.reach.packages import Body, backs_reach
from ikteach.motion.reach.reaching import Reaching, trial
from ikteach.motion.reach.ways import WAYS, Way, Ways, advance


def standings(session: Reaching) -> pd.DataFrame:
    """Compare how the ways stand with the cursor now.

    distance [cm]      from the hand to the cursor
    largest step [°]   of a joint in one tick, since the cursor moved
    det                of the 3 × 3 J of CS 490 [m³/rad³]; for the general methods √det JJᵀ
    smallest σ         of the J in use [m/rad]
    ticks              after which the hand arrived and stayed; none if it has not
    how it stands      in words
    """
    rows = {
        name: {
            "distance [cm]": 100 * float(one.tick.distance),
            "largest step [°]": np.degrees(one.largest),
            "det": float(one.tick.det),
            "smallest σ": float(one.tick.sigma),
            "ticks": one.arrived,
            "how it stands": one.words,
        }
        for name, one in session.standing.items()
    }
    table = pd.DataFrame.from_dict(rows, orient="index").rename_axis("method")
    return table.astype({"ticks": "Int64"})


def reaches(cursors: ArrayLike, ways: Mapping[str, Way] = WAYS, **options: Any) -> pd.DataFrame:
    """Reach from rest to cursors (b, 3), a row per way.

    arrived        share that came within a centimetre and stayed
    median, p95    ticks that those took
    largest [°]    the largest step of a joint in one tick, of all runs
    silent         share that no package answers
    oscillates     share whose poses repeat themselves for ever
    unsettled      share that still moves at the end and does not repeat itself
    options        go to `motion.reach.trial`
    """
    body, rows = Body(), {}
    for name, way in Ways.of(ways).items():
        run = trial(body, cursors, way, **options)
        ticks = run.ticks[run.arrived]
        rows[name] = {
            "arrived": run.arrived.mean(),
            "median": np.median(ticks) if len(ticks) else np.nan,
            "p95": np.percentile(ticks, 95) if len(ticks) else np.nan,
            "largest [°]": np.degrees(run.largest.max()),
            "silent": run.silent.mean(),
            "oscillates": (run.period > 0).mean(),
            "unsettled": (~run.settled & (run.period == 0)).mean(),
        }
    return pd.DataFrame.from_dict(rows, orient="index").rename_axis("method")


def follow(cursors: ArrayLike, way: Way, ticks: int | None = None, **options: Any) -> pd.DataFrame:
    """Follow cursors from rest, a row per tick.

    cursors            (T, 3), or (3,) to be followed for `ticks` ticks

    distance [cm]      from the hand to the cursor
    elbow, back [°]    how far they are bent
    det, smallest σ    of J in use, as in `standings`
    largest step [°]   of a joint, the neck's left out
    options            go to `motion.ways.advance`
    """
    body, places = Body(), numbers("the cursors", cursors)
    if ticks is not None:
        if places.shape != (3,):
            raise ValueError(f"for some ticks a cursor is x, y and z, not of shape {places.shape}")
        places = np.broadcast_to(places, (count("ticks", ticks), 3))
    if places.ndim != 2 or places.shape[1] != 3 or not len(places):
        raise ValueError(
            f"cursors have the shape (T, 3), or say how many ticks; not {places.shape}"
        )
    theta, rows = body.tree.rest, []
    for cursor, backs in zip(places, backs_reach(body, places), strict=True):
        tick = advance(body, theta, cursor, way, backs=backs, **options)
        turned = np.delete(abs(tick.theta - theta), body.neck)
        theta = tick.theta
        rows.append(
            {
                "distance [cm]": 100 * float(tick.distance),
                "elbow [°]": np.degrees(theta[body.arm("r" if cursor[0] < 0 else "l")[2]]),
                "back [°]": np.degrees(theta[body.back]),
                "det": float(tick.det),
                "smallest σ": float(tick.sigma),
                "largest step [°]": np.degrees(turned.max()),
            }
        )
    return pd.DataFrame(rows, index=pd.RangeIndex(1, len(rows) + 1, name="tick"))
