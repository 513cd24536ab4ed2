"""The class `Profile`: points of the cross-section of a wheel or a rail."""

from __future__ import annotations

import dataclasses
import math
import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from .._arguments import number, real
from .._short import Short
from ._curve import Curve, growing
from ._digits import SAMPLES, left_open
from ._smoothing import smoothing_splines

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .._arguments import Doubles

# Faces that are steeper than this are cut off the curve, because z must be a function of y. Flanges are inclined by at most 75 degrees.
STEEPEST = np.deg2rad(85.0)

# A point that is farther than this from the median, in mm, is a fill value: no profile is so large.
_FAR = 500.0

# If the curvature changes by more than this from point to point, in 1/mm, the points have noise. Wheels and rails have curvatures of up to 0.1 per mm; noise of
# 1 um on points 0.1 mm apart changes the curvature by 0.3 per mm from point to point.
_ROUGH = 0.1

# The least and the largest height of a flange above the tread, in mm.
_FLANGE, _HIGHEST = 12.0, 45.0

# From one point to the next y must not decrease by more than this part of the width of the profile.
_BACKWARDS = 0.3

# A tread is lower (z is larger) on the side of the flange than on the field side, or both are equal within this length, in mm.
_LEVEL = 0.05

# Points that are closer than this, in mm, count as one: the direction from one to the other is round-off of a file with eight digits.
CLOSEST = 1e-3

# Beyond a steep face the next points lie above or below its end. If one of the next _BEHIND points lies mainly beside it, the profile continues there, and the
# points are out of order.
_BEHIND = 5

# A profile without an outlier is smooth: the cosine of each change of direction exceeds this.
_AHEAD = 0.9

# The distance of a spike from the line through its neighbours exceeds _SPIKE mm, and _TIMES the median of this distance for _AROUND points around it.
_SPIKE, _TIMES, _AROUND = 0.03, 10.0, 12


@dataclass(frozen=True, eq=False, repr=False)
class Profile(Short):
    """The points of the cross-section of a wheel or a rail on the right-hand side of a track.

    y grows outwards, from the middle of the track to the field side, and z grows downwards. The points are in the order of growing y along the tread or the
    head. So the flange of a wheel is at the smallest y and points to large z, and the top of a rail has the smallest z.

    Attributes
    ----------
    y, z : ndarray, (n,)
        The coordinates of the points, in mm.
    kind : {"wheel", "rail"}
        Whether the profile is that of a wheel or of a rail.
    name : str
        The name in messages and pictures.
    """

    y: Doubles
    z: Doubles
    kind: str
    name: str = ""
    # Possible errors of the points along the normal, if the profile was smoothed: the result of `left_open`.
    _open: Doubles | None = dataclasses.field(default=None, init=False)

    def __post_init__(self) -> None:
        y, z = real("y", self.y), real("z", self.z)
        if self.kind not in ("wheel", "rail"):
            raise ValueError(f'kind is {self.kind!r}; it must be "wheel" or "rail"')
        if y.ndim != 1 or y.shape != z.shape or len(y) < 4:
            raise ValueError(f"y and z have shapes {y.shape} and {z.shape}; they must be rows of at least 4 points")
        if not (np.isfinite(y).all() and np.isfinite(z).all()):
            raise ValueError(f"{self._title()} has points that are not finite")
        far = np.flatnonzero((np.abs(y - np.median(y)) > _FAR) | (np.abs(z - np.median(z)) > _FAR))
        if len(far):
            raise ValueError(f"{self._title()} has a point y = {y[far[0]]:g}, z = {z[far[0]]:g}, more than {_FAR:g} mm from the others: does it stand "
                             "for 'not measured'? Leave such points out; a profile is in mm (scale=)")
        object.__setattr__(self, "y", y)
        object.__setattr__(self, "z", z)
        self._check_orientation()

    def _title(self) -> str:
        return self.name or f"the {self.kind}"

    def has_flange(self) -> bool:
        """Whether the profile is that of a wheel with its flange, and not of a tread only."""
        return self.kind == "wheel" and bool(max(np.median(self.z) - self.z.min(), self.z.max() - np.median(self.z)) >= _FLANGE)

    def _check_orientation(self) -> None:
        """Raises an error if the profile is upside down, reversed or mirrored, because its contact would be wrong."""
        if self.y[0] > self.y[-1]:
            raise ValueError(f"{self._title()} begins at the larger y; its points must be in the order of growing y: y[::-1] and z[::-1]")
        k = int(np.argmin(np.diff(self.y)))
        if self.y[k] - self.y[k + 1] > _BACKWARDS * (self.y[-1] - self.y[0]):
            raise ValueError(f"{self._title()} goes back from y = {self.y[k]:.6g} to y = {self.y[k + 1]:.6g}: are these two profiles? Give one of "
                             "them; or sort the points")
        above, below = np.median(self.z) - self.z.min(), self.z.max() - np.median(self.z)
        if self.kind == "wheel":
            # The extremes of a tread without a flange may be those of a chamfer, so the means of both halves are compared: the radius grows towards the flange.
            if not self.has_flange():
                inner = self.y < 0.5 * (self.y[0] + self.y[-1])
                if inner.any() and not inner.all() and self.z[~inner].mean() > self.z[inner].mean() + _LEVEL:
                    raise ValueError(f"{self._title()} has no flange, and its tread is lower on the field side: upside_down=True if z grows upwards, "
                                     "mirror=True if y grows to the middle of the track")
                return
            if above > below:
                raise ValueError(f"{self._title()} has its flange at the smallest z; z must grow downwards: upside_down=True")
            if below > _HIGHEST:
                raise ValueError(f"{self._title()} has a flange that is {below:.3g} mm high: are these diameters? z is a radius, or a height, in mm")
            if self.y[np.argmax(self.z)] > 0.5 * (self.y[0] + self.y[-1]):
                raise ValueError(f"{self._title()} has its flange at large y; y must grow to the field side: mirror=True")
        elif above > below or np.argmin(self.z) in (0, len(self.z) - 1):
            raise ValueError(f"{self._title()} has its top at the largest z; z must grow downwards: upside_down=True")

    def moved(self, y: float = 0.0, z: float = 0.0) -> Profile:
        """Returns the profile moved by `y` and `z`, in mm."""
        return self._with(self.y + number("y", y), self.z + number("z", z), self._open)

    def rotated(self, angle: float) -> Profile:
        """Returns the profile rotated about the origin by an angle in rad.

        For an inclination of 1:40 a rail is rotated by 1/40: its top moves towards the middle of the track.
        """
        c, s = np.cos(number("angle", angle)), np.sin(angle)
        return self._with(c * self.y + s * self.z, c * self.z - s * self.y, self._open)

    def _with(self, y: Doubles, z: Doubles, is_open: Doubles | None) -> Profile:
        """This profile with other points. `is_open` has their possible errors along the normal."""
        made = dataclasses.replace(self, y=y, z=z)
        object.__setattr__(made, "_open", is_open)
        return made

    def smoothed(self, wave_length: float) -> Profile:
        """Returns the profile without waves that are shorter than a length, in mm. Use it for measured profiles, whose noise would change the contact.

        y and z, as functions of the length along the polygon, become smoothing splines (Reinsch 1967). A smoothing spline multiplies the height of a wave of
        length L by 1/(1 + (wave_length/L)^4). Steep faces, which `curve` cuts off, are not smoothed.
        """
        length = number("wave_length", wave_length)
        if not length > 0.0:
            raise ValueError(f"wave_length is {length}; it must be positive")
        if not length < 0.5 * float(np.ptp(self.y)):
            raise ValueError(f"wave_length is {length}; it must be less than half of the width of {self._title()}, {np.ptp(self.y):.4g} mm")
        chosen = self._usable()
        points = np.stack([self.y, self.z])
        measured = points[:, chosen]
        points[:, chosen] = smoothing_splines(measured, measured, length)
        is_open = np.zeros((1 + SAMPLES, len(self.y))) if self._open is None else self._open.copy()
        is_open[:, chosen] = left_open(is_open[:, chosen], measured, points[:, chosen], length)
        return self._with(points[0], points[1], is_open)

    def thinned(self, step: float) -> Profile:
        """Returns the profile with one point, the mean, for each `step` along it, in mm. Use it for scans whose noise exceeds the distance of their points.

        A step contains the points, in their order, that are within `step` of its first point. Choose a `step` of several times the noise, and of at most a
        tenth of the width of the contact. Both end points of the profile are kept.
        """
        length = number("step", step)
        if not length > 0.0:
            raise ValueError(f"step is {length}; it must be positive")
        points, begins = list(zip(self.y.tolist(), self.z.tolist())), [0, 1]
        for k, point in enumerate(points[1:-1], 1):
            if math.dist(point, points[begins[-1]]) > length:
                begins.append(k)
        # The last step is joined to the one before, so that its mean is not too close to the end point.
        begins = [*(begins[:-1] if len(begins) > 2 else begins), len(points) - 1]
        counts = np.diff([*begins, len(points)])
        y, z = (np.add.reduceat(values, begins) / counts for values in (self.y, self.z))
        if len(y) < 4:
            raise ValueError(f"step is {length}; it leaves {len(y)} points of {self._title()}, at least 4 are needed: a profile is in mm")
        is_open = None if self._open is None else np.add.reduceat(self._open, begins, axis=1) / counts
        return self._with(y, z, is_open)

    def _usable(self) -> Any:
        """The indices of the points that the curve uses: from the middle of the tread, or the top of the rail, to the first steep face on either side."""
        points, apart = list(zip(self.y.tolist(), self.z.tolist())), [0]
        for k, point in enumerate(points):
            if math.dist(point, points[apart[-1]]) >= CLOSEST:
                apart.append(k)
        y, z = self.y[apart], self.z[apart]
        middle = int(np.argmin(z))
        if self.kind == "wheel":
            middle = int(np.argmin(np.abs(y - 0.5 * (y[np.argmax(z)] + y[-1]))))
        # A face is steep where y + z/tan or y - z/tan does not grow.
        flat = 1.0 / np.tan(STEEPEST)
        first, last = 0, len(y) - 1
        for sign in (flat, -flat):
            one, other = growing(y + sign * z, middle)
            first, last = max(first, one), min(last, other)
        self._check_face(y, z, first, -1)
        self._check_face(y, z, last, 1)
        return np.array(apart[first : last + 1])

    def _check_face(self, y: Doubles, z: Doubles, end: int, way: int) -> None:
        """Raises an error if the curve ends at the point `end` because of an outlier, and not at a steep face.

        `way` is the direction along the points, 1 or -1, in which the profile goes on beyond the end.
        """
        beyond = end + way * np.arange(1, _BEHIND + 1)
        beyond = beyond[(beyond >= 0) & (beyond < len(y))]
        if (way * (y[beyond] - y[end]) > np.abs(z[beyond] - z[end])).any():
            self._refuse_point(y, z, beyond[0], end)
        # On a flange, which is steep itself, an outlier looks like a steep face. It is found if the profile without this point is smooth.
        for off, beside in ((end + way, end), (end, end + way)):
            k = off + way * np.array([-2, -1, *range(1, _BEHIND + 1)])
            if k.min() < 0 or k.max() >= len(y):
                continue
            steps = np.stack([way * np.diff(y[k]), np.diff(z[k])])
            lengths = np.hypot(*steps)
            steps /= lengths
            # `far` is the distance of the point from the line through its neighbours. The noise is the median distance of the next points from the direction of
            # the step before them.
            far = abs(steps[0, 1] * (z[off] - z[k[1]]) - way * steps[1, 1] * (y[off] - y[k[1]]))
            noise = np.median(np.abs(steps[0, 1:] * steps[1, :-1] - steps[1, 1:] * steps[0, :-1]) * lengths[1:])
            goes_on = (steps[0] > np.abs(steps[1]) / np.tan(STEEPEST)).all() and ((steps[:, 1:] * steps[:, :-1]).sum(axis=0) > _AHEAD).all()
            if goes_on and far > max(_SPIKE, _TIMES * noise):
                self._refuse_point(y, z, off, beside)

    def _refuse_point(self, y: Doubles, z: Doubles, k: int, beside: int) -> None:
        """Raises an error on the point `k`, which is out of order beside the point `beside`."""
        raise ValueError(f"{self._title()} has a point out of order, or far off, at y = {y[k]:.6g}, z = {z[k]:.6g}, beside "
                         f"y = {y[beside]:.6g}, z = {z[beside]:.6g}; from point to point y must grow but at steep faces, behind which the profile ends: "
                         "sort the points, or leave this one out; where points are closer to each other than their noise, thinned(step) takes the mean of "
                         "each step in mm")

    def spikes(self) -> Any:
        """Returns the indices of spikes: single points that stand out, such as dust or faults of the measurement.

        The distance of a spike from the line through its neighbours exceeds 0.03 mm, and ten times the median of this distance for the points around it. Both
        neighbours deviate to the other side.
        """
        return self._spikes(self._usable())

    def _spikes(self, chosen: Any) -> Any:
        """The indices of the spikes among the points `chosen`, which are indices, too."""
        y, z = self.y[chosen], self.z[chosen]
        if len(y) < _AROUND:
            return chosen[:0]
        weight = (y[1:-1] - y[:-2]) / (y[2:] - y[:-2])
        off = z[1:-1] - (1.0 - weight) * z[:-2] - weight * z[2:]
        found = []
        # Few points deviate so far. Medians are computed for these points only, because a search for the position of a wheelset makes the curves in each step.
        for k in np.flatnonzero(np.abs(off[1:-1]) > _SPIKE) + 1:
            around = np.abs(off[max(0, k - _AROUND // 2) : k + _AROUND // 2 + 1])
            stands_out = abs(off[k]) > _TIMES * float(np.median(around))
            if stands_out and max(off[k - 1] / off[k], off[k + 1] / off[k]) < -0.2:
                found.append(k + 1)
        return chosen[found]

    def curve(self) -> Curve:
        """Returns the smooth curve through the points, without steep faces: natural cubic splines over the length of the polygon.

        Warns of `spikes`, and of noise that bends the curve.
        """
        chosen = self._usable()
        if len(chosen) < 4:
            raise ValueError(f"{self._title()} has {len(chosen)} points between its steep faces; at least 4 are needed. A profile is in mm, its points "
                             "in the order in which one walks along it")
        for k in self._spikes(chosen):
            warnings.warn(f"{self._title()} has a spike at y = {self.y[k]:.6g}, z = {self.z[k]:.6g}: if it is dust or a fault, leave this point out",
                          stacklevel=3)
        if (rough := self._roughness(chosen)) > _ROUGH:
            warnings.warn(f"the curvature of {self._title()} changes by {rough:.2g} per mm from point to point: noise of the points, which becomes contact. "
                          "smoothed(wave_length) removes it", stacklevel=3)
        return Curve(self.y[chosen], self.z[chosen], None if self._open is None else self._open[:, chosen])

    def _roughness(self, chosen: Any) -> float:
        """The median change of the curvature from point to point, in 1/mm. It is a measure of noise: without noise the curvature changes slowly."""
        y, z = self.y[chosen], self.z[chosen]
        d = np.diff(y)
        if len(y) < _AROUND or not (d > 0.0).all():
            return 0.0
        curvature = 2.0 * np.diff(np.diff(z) / d) / (d[:-1] + d[1:])
        return float(np.median(np.abs(np.diff(curvature))))

    def plot(self, axes: Axes | None = None) -> Axes:
        """Draws the points with z downwards."""
        from .._plot_surfaces import plot_profile

        return plot_profile(self, axes)
