"""From two profiles to a gap: where a wheel touches a rail, the pressures, and the creep forces. `python3 profiles_to_gap.py [folder [gap]]`: the
folder gets the pictures of docs/profiles_to_gap.md, and `gap` is a file for c_examples/gap.c and fortran_examples/gap.f90.

The profiles are those of data/profiles: lines and arcs that resemble a rail of 60 kg/m and a worn wheel, made by `made_rail()` and
`made_wheel()`. Lengths are in mm, forces in N, angles in rad."""

import os
import sys

import numpy as np

import contact_normal as cn
from contact_normal import profiles

PROFILES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "data", "profiles")
STEEL = {"shear_modulus": 82000.0, "poisson_ratio": 0.28}
LOAD, SPEED = 80e3, 30e3  # N; mm/s


def arcs(y, z, angle, parts, step=0.25):
    """The points of lines and arcs with common tangents, in the order of growing y, from (y, z) and a first angle on. `parts` are (length, None)
    for a line, and (radius, angle) for an arc that ends at this angle. The tangent of an angle is the slope dz/dy."""
    points = [(y, z)]
    for size, end in parts:
        length = size if end is None else size * abs(end - angle)
        s = np.linspace(0.0, length, max(4, int(length / step)) + 1)[1:]
        if end is None:
            new = np.stack([y + s * np.cos(angle), z + s * np.sin(angle)], axis=1)
        else:
            sign = np.sign(end - angle)
            turned = angle + sign * s / size
            new = np.stack([y + sign * size * (np.sin(turned) - np.sin(angle)), z - sign * size * (np.cos(turned) - np.cos(angle))], axis=1)
            angle = end
        points += new.tolist()
        y, z = points[-1]
    return np.array(points)


def made_rail():
    """A rail without inclination: a head with radii of 300, 80 and 13 mm between flanks of 1:20. One half is made, and mirrored."""
    half = arcs(0.0, 0.0, 0.0, [(300.0, np.arcsin(10.3 / 300.0)), (80.0, 0.23), (13.0, np.arctan(20.0)), (22.0, None)])
    return np.concatenate([half[:0:-1] * [-1.0, 1.0], half])


def made_wheel():
    """A wheel from the flange back on: a tip of radius 14 mm, a flank of 70 degrees, a throat of radius 16 mm, a hollow tread of radius 540 mm, and 1:50
    at the end."""
    parts = [(14.0, -np.deg2rad(70.0)), (8.0, None), (16.0, -0.10), (540.0, -0.02), (40.0, None)]
    points = arcs(-70.0, 0.0, 1.45, parts)
    # The profile is moved so that z = 0 at y = 0, where the wheel has its nominal radius.
    return points - [0.0, np.interp(0.0, *points.T)]


def write(path, points, kind):
    """Writes a file in the format of SIMPACK, with the entries that a reader needs."""
    lines = [f"header.begin\n  version = 1\n  type = {kind}   ! 0=rail profile, 1=wheel profile\nheader.end\nspline.begin",
             "  units.len.f = 1.0e+03\n  point.begin", *(f"    {y:.7f} {z:.7f}" for y, z in points), "  point.end\nspline.end\n"]
    with open(path, "w", encoding="ascii") as file:
        file.write("\n".join(lines))


def bodies():
    """Steps 1 and 2: the track and the wheelset. The profile of the rail is not inclined yet."""
    track = profiles.Track(profiles.read(os.path.join(PROFILES, "arcs.prr")), gauge=1435.0, inclination=1.0 / 40.0)
    wheelset = profiles.Wheelset(profiles.read(os.path.join(PROFILES, "arcs.prw")), radius=460.0, flange_back=1360.0)
    return track, wheelset


def rolling(track, wheelset, y, yaw=0.0):
    """Steps 3 to 5: position, contact points, pressures and creep forces of the right wheel."""
    position = profiles.settled(track, wheelset, y, yaw)
    left, point = (profiles.contact_points(track, wheelset, position, side)[0] for side in ("left", "right"))
    # A wheelset that rolls freely turns as a wheel with the mean of both rolling radii.
    rate = SPEED / (0.5 * (left.rolling_radius + point.rolling_radius))
    xi, eta, phi = point.creepages(SPEED, pitch_rate=rate)
    friction = {"coefficient": 0.3, "motion": "STEADY_ROLLING", "creepage": (xi, eta), "spin": phi}
    gap, result = point.press(LOAD, 0.4, 0.4, friction=friction, **STEEL)
    if result.status != cn.OK:
        sys.exit(f"y = {y}: stopped early: {result.message}")
    return point, gap, result, (xi, eta, phi)


def hundredths(value):
    """The value rounded to hundredths, where -0 becomes 0."""
    return round(value, 2) + 0.0


def table(track, wheelset):
    print("shift    contact point y, z  angle  radius  largest pressure    xi [1e-4]   eta [1e-4]  phi [1/m]      forces on the wheel")
    for y, yaw in ((0.0, 0.0), (2.0, 0.0), (4.0, 0.0), (4.0, 0.002)):
        point, _, result, (xi, eta, phi) = rolling(track, wheelset, y, yaw)
        forward, right, down = point.force_on_wheel(result)
        print(f"{y:3.0f} mm {point.place[1]:10.2f} {point.place[2]:7.3f} {point.angle:7.4f} {point.rolling_radius:7.2f} {result.max_pressure:12.0f} N/mm2"
              f" {hundredths(1e4 * xi):12.2f} {hundredths(1e4 * eta):12.2f} {1e3 * phi:10.3f}  {forward:8.0f} {right:7.0f} {down:7.0f} N" + (f"  (yaw {yaw})" if yaw else ""))


def draw(folder):
    """Draws the pictures of docs/profiles_to_gap.md."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    track, wheelset = bodies()
    pictures = {}

    pictures["place"], axes = pyplot.subplots(1, 2, figsize=(8.4, 3.0), layout="constrained", sharey=True)
    for one, y in zip(axes, (0.0, 7.5)):
        position = profiles.settled(track, wheelset, y)
        track.placed().plot(one)
        wheelset.wheel.moved(wheelset.origin + y, position.z).plot(one)
        for point in profiles.contact_points(track, wheelset, position, within=0.2):
            one.plot(*point.place[1:], "o", color="crimson", markersize=6)
        one.set(title=f"shifted by {y:g} mm", xlabel="y, to the right [mm]", ylabel="", xlim=(675.0, 815.0), ylim=(45.0, -15.0))
    axes[0].set_ylabel("z, downwards [mm]")
    axes[0].text(730.0, 30.0, "rail", ha="left")
    axes[0].text(690.0, 2.0, "wheel", ha="left")

    pictures["shift"], axes = pyplot.subplots(1, 2, figsize=(8.4, 3.2), layout="constrained")
    shifts = np.arange(-7.5, 7.6, 0.5)
    points = [profiles.contact_points(track, wheelset, profiles.settled(track, wheelset, y))[0] for y in shifts]
    axes[0].plot(shifts, [point.place[1] - 750.0 for point in points], ".-")
    axes[0].set(xlabel="shift of the wheelset y [mm]", ylabel="contact point, y - 750 [mm]")
    axes[1].plot(shifts, [point.rolling_radius for point in points], ".-")
    axes[1].set(xlabel="shift of the wheelset y [mm]", ylabel="rolling radius [mm]")

    _, gap, result, _ = rolling(track, wheelset, 4.0)
    along = {"xlabel": "x, along the rail [mm]", "ylabel": "y, along its surface [mm]"}
    pictures["gap"], axes = pyplot.subplots(figsize=(7.2, 4.4), layout="constrained")
    gap.plot(axes)
    axes.plot(0.0, 0.0, "+", color="crimson", markersize=12, markeredgewidth=2)
    axes.set(**along, title="undeformed distance; cross: the contact point")

    pictures["forces"], axes = pyplot.subplots(1, 2, figsize=(8.4, 3.2), layout="constrained")
    result.plot(axes[0])
    result.plot_traction(axes[1])
    fx, fy = result.tangential_force
    axes[0].set(**along, title=f"pressures: {LOAD / 1e3:g} kN")
    axes[1].set(**along, title=f"tractions: ({fx / 1e3:.1f}, {fy / 1e3:.1f}) kN\nstick blue, slip orange")

    for name, figure in pictures.items():
        figure.savefig(f"{folder}/profiles_to_gap_{name}", dpi=150)


def main(folder=None, gap_file=None):
    track, wheelset = bodies()
    position = profiles.settled(track, wheelset, 4.0)
    print(f"both wheels touch at y = 4 mm: axle {1e3 * position.z:.1f} um lower, roll {position.roll:.2e}")
    flange = profiles.contact_points(track, wheelset, profiles.settled(track, wheelset, 7.5), within=0.2)
    print("at y = 7.5 mm within 0.2 mm: " + ", ".join(f"{abs(one.clearance):.3f} mm at an angle of {np.rad2deg(one.angle):.1f} degrees" for one in flange))
    table(track, wheelset)
    if folder:
        draw(folder)
    if gap_file:
        rolling(track, wheelset, 4.0)[1].write(gap_file, "wheel and rail of data/profiles, shifted by 4 mm; lengths in mm")


if __name__ == "__main__":
    main(*sys.argv[1:])
