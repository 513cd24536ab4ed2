"""Makes a gap from measured heights, step by step, in numpy.

These are all steps, for an array of heights in m::

    from contact_normal import surface
    measured = surface.heights(values, size=(1.2e-3, 0.9e-3), units=("m", "N"))
    faults = surface.faults(measured)
    print(faults)
    gap = surface.gap(surface.level(faults.removed))
    result = gap.solve(mean_pressure=50e6, e_star=surface.e_star(210e9, 0.3))
"""

from .._gap import Gap
from ._faults import Faults, faults
from ._heights import Heights, heights
from ._level import Form, border_jumps, form, level
from ._pair import Balanced, balance, e_star, gap
from ._readers import from_topography, from_xarray, read

__all__ = [
    "Balanced",
    "Faults",
    "Form",
    "Gap",
    "Heights",
    "balance",
    "border_jumps",
    "e_star",
    "faults",
    "form",
    "from_topography",
    "from_xarray",
    "gap",
    "heights",
    "level",
    "read",
]
