"""Where one looks from: the named sides, free turning, perspective and parallel projection."""

from collections.abc import Callable
from math import atan2, cos, degrees, hypot, radians, sin, tan

import numpy as np
import pythreejs as three

from ikteach.arrays import Array, ArrayLike
from ikteach.view.stage.stage import FIELD, Stage, picture_axes


class Cameras:
    """A perspective and a parallel camera, one in use.

    They look at the same thing.

    aspect    width over height of the picture
    parallel  whether its first projection is parallel
    switched  is called after another camera came into use

    current   the camera in use
    """

    def __init__(
        self,
        stage: Stage,
        aspect: float,
        *,
        parallel: bool = False,
        switched: Callable[[], object] = lambda: None,
    ) -> None:
        self._stage, self._aspect, self._switched = stage, aspect, switched
        # Near, far, and how close one may come, all as shares of where the named cameras are.
        self._usual = float(np.linalg.norm(stage.eye(stage.side, aspect) - stage.extent.centre))
        self._far = 20 * self._usual
        self.perspective: three.PerspectiveCamera | None = None
        self.parallel: three.OrthographicCamera | None = None
        self._turning: dict[three.Camera, three.OrbitControls] = {}
        self.current = self._camera(parallel)
        self.look_from(stage.side)

    @property
    def turning(self) -> three.OrbitControls:
        """Give the controls of the camera in use."""
        return self._turning[self.current]

    @property
    def orthographic(self) -> bool:
        """Tell whether the projection is parallel; may be set."""
        return self.current is self.parallel

    @orthographic.setter
    def orthographic(self, on: bool) -> None:
        if on == self.orthographic:
            return
        before, target = self.current, self.turning.target
        self.current = self._camera(on)
        self.put(before.position, target)
        self._switched()

    def look_from(self, side: str) -> None:
        """Put the camera to one of the named sides.

        LookupError for an unknown one.
        """
        self.put(self._stage.eye(side, self._aspect), self._stage.extent.centre)

    def turn(self, azimuth: float, elevation: float, distance: float | None = None) -> None:
        """Look from azimuth and elevation [degrees].

        They are left of the front, and above the floor.
        """
        a, e = radians(azimuth), radians(min(max(elevation, -89.0), 89.0))
        r = self.distance if distance is None else distance
        target = np.asarray(self.turning.target)
        away = r * np.array([sin(a) * cos(e), sin(e), cos(a) * cos(e)])
        self.put(target + away, target)

    def _camera(self, parallel: bool) -> three.Camera:
        """Give the camera of a projection, made when it is first wanted."""
        if parallel:
            if self.parallel is None:
                self.parallel = three.OrthographicCamera(
                    *(-1, 1, 1, -1), near=-self._far, far=self._far
                )
                self._turning[self.parallel] = self._bound(self.parallel)
            return self.parallel
        if self.perspective is None:
            self.perspective = three.PerspectiveCamera(
                fov=FIELD, aspect=self._aspect, near=self._usual / 60, far=self._far
            )
            self._turning[self.perspective] = self._bound(self.perspective)
        return self.perspective

    def _bound(self, camera: three.Camera) -> three.OrbitControls:
        """Make controls that come no closer than can be drawn, and go no farther than is seen."""
        nearest, farthest = self._usual / 20, 10 * self._usual
        return three.OrbitControls(
            controlling=camera,
            minDistance=nearest,
            maxDistance=farthest,
            minZoom=1 / 10,  # the same of a parallel camera
            maxZoom=20.0,
        )

    @property
    def angles(self) -> tuple[float, float]:
        """Give azimuth and elevation of the camera [degrees]."""
        x, y, z = self._away
        return degrees(atan2(x, z)), degrees(atan2(y, hypot(x, z)))

    @property
    def distance(self) -> float:
        """The camera's distance from its target [m]."""
        return float(np.linalg.norm(self._away))

    @property
    def _away(self) -> Array:
        return np.subtract(self.current.position, self.turning.target)

    def put(self, position: ArrayLike, target: ArrayLike) -> None:
        """Place the camera, and have it look at the target.

        In the picture y is upwards.
        """
        eye, at = np.asarray(position, dtype=float), np.asarray(target, dtype=float)
        camera, turning = self.current, self.turning
        if tuple(turning.target) != tuple(at.tolist()):
            turning.target = at.tolist()
        with camera.hold_sync():
            camera.quaternion = looking(eye, at)
            camera.position = eye.tolist()
            if self.orthographic:
                half = float(np.linalg.norm(eye - at)) * tan(radians(FIELD / 2))
                camera.top, camera.bottom, camera.zoom = half, -half, 1.0
                camera.left, camera.right = -half * self._aspect, half * self._aspect


def looking(eye: Array, at: Array) -> tuple[float, float, float, float]:
    """Turn a camera at `eye` to look at `at` with y upwards: quaternion (x, y, z, w)."""
    return quaternion(picture_axes(eye - at))


def quaternion(R: Array) -> tuple[float, float, float, float]:
    """Make a quaternion (x, y, z, w) of a rotation matrix R (3, 3)."""
    # The eigenvector of 1 of this symmetric matrix; stable for every rotation.
    xx, xy, xz, yx, yy, yz, zx, zy, zz = R.ravel()
    K = np.array(
        [
            [xx - yy - zz, xy + yx, xz + zx, zy - yz],
            [xy + yx, yy - xx - zz, yz + zy, xz - zx],
            [xz + zx, yz + zy, zz - xx - yy, yx - xy],
            [zy - yz, xz - zx, yx - xy, xx + yy + zz],
        ]
    )
    x, y, z, w = np.linalg.eigh(K)[1][:, -1]
    return (float(x), float(y), float(z), float(w))
