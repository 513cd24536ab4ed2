"""contact-normal: solves elastic contact problems on numpy arrays.

    import contact_normal
    result = contact_normal.solve(h, dx, dy, force=82.0e3, shear_modulus=82000.0, poisson_ratio=0.28)
    result.pressure, result.contact, result.approach, result.max_pressure, result.ledger
    result.plot()

Arrays are (my, mx) in C order: x runs along a row. Constants have the names of include/contact_normal.h without the prefix CONTACT_NORMAL_.
"""

from ._arguments import SolveOptions
from ._bill import Bill, BillRow, what_matters
from ._callbacks import Progress, set_log
from ._constants import *  # noqa: F403
from ._creep_force_table import creep_force_table
from ._creep_forces import CreepForceTable
from ._friction_batch import FrictionBatch, friction_batch
from ._heat import FlashTemperature, flash_temperature
from ._ledger import Ledger
from ._library import VERSION, ContactNormalError
from ._plot_lines import plot_contact_area
from ._prices import Price, Prices, cost_of_accuracy
from ._quantities import Quantities, Quantity, quantities
from ._pull_off import pull_off
from ._result import Result, TangentialResult
from ._solve import AccurateResult, solve, solve_to_accuracy, to_accuracy
from ._solver import Solver
from ._special import HertzSolution, coating_compliance, hertz, influence_half_space, influence_rolling, influence_rolling_tangential
from ._stress import SubsurfaceStress
from ._subsurface import stress_at_points, subsurface_stress
from ._tangential import solve_tangential
from ._wear import FrictionalWear, frictional_wear

__version__ = VERSION

__all__ = [
    "AccurateResult",
    "Bill",
    "BillRow",
    "ContactNormalError",
    "CreepForceTable",
    "FlashTemperature",
    "FrictionBatch",
    "FrictionalWear",
    "HertzSolution",
    "Ledger",
    "Price",
    "Prices",
    "Progress",
    "Quantities",
    "Quantity",
    "Result",
    "SolveOptions",
    "Solver",
    "SubsurfaceStress",
    "TangentialResult",
    "VERSION",
    "coating_compliance",
    "cost_of_accuracy",
    "creep_force_table",
    "flash_temperature",
    "friction_batch",
    "frictional_wear",
    "hertz",
    "influence_half_space",
    "influence_rolling",
    "influence_rolling_tangential",
    "plot_contact_area",
    "pull_off",
    "quantities",
    "set_log",
    "solve",
    "solve_tangential",
    "solve_to_accuracy",
    "stress_at_points",
    "subsurface_stress",
    "to_accuracy",
    "what_matters",
]
