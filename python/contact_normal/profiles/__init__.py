"""Makes a gap from two profiles, those of a wheel and a rail.

Lengths are in mm, angles in rad, forces in N::

    from contact_normal import profiles
    track = profiles.Track(profiles.read("rail.prr"), gauge=1435.0)
    wheelset = profiles.Wheelset(profiles.read("wheel.prw"), radius=460.0, flange_back=1360.0)
    point = profiles.contact_points(track, wheelset, profiles.Position(y=4.0), side="left")[0]
    gap, result = point.press(10e3, 0.2, 0.2, shear_modulus=82000.0, poisson_ratio=0.28)
"""

from .._gap import Gap
from ._bodies import Position, Track, Wheelset
from ._contact import contact_points, settled
from ._patch import ContactPoint
from ._profile import Profile
from ._readers import read

__all__ = ["ContactPoint", "Gap", "Position", "Profile", "Track", "Wheelset", "contact_points", "read", "settled"]
