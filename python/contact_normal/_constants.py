"""The constants of include/contact_normal.h, without the prefix CONTACT_NORMAL_, and their names as options take them."""

from __future__ import annotations

# Statuses: 0: solved; > 0: stopped early, usable; < 0: refused.
OK, ITERATION_LIMIT, CANCELLED, STAGNATED = 0, 1, 2, 3
NULL_POINTER, INVALID_ARGUMENT, NOT_FINITE, STRUCT_SIZE, UNSUPPORTED = -1, -2, -3, -4, -5
INFEASIBLE, NOT_POSITIVE_DEFINITE, OUT_OF_MEMORY, INTERNAL = -6, -7, -8, -99

ABI_VERSION = 2

# Structs, for contact_normal_init.
KIND_SCENE, KIND_OPTIONS, KIND_FIELDS, KIND_REPORT, KIND_ACCURACY, KIND_INFLUENCE, KIND_ROW_TABLES, KIND_LAYER = range(1, 9)
KIND_PRESSURE_LIMIT, KIND_PERIOD, KIND_PATCHES, KIND_COATING, KIND_FRICTION, KIND_FRICTION_RESULTS = range(9, 15)
KIND_STRESS_OUTPUTS, KIND_STRESS_MAXIMUM, KIND_LEDGER_ROW, KIND_PRICE, KIND_HERTZ_SOLUTION, KIND_CYCLE = range(15, 21)

PRESCRIBED_APPROACH, PRESCRIBED_FORCE = 0, 1
METHOD_AUTO, METHOD_NORM, METHOD_MULTIGRID, METHOD_FULL_MULTIGRID, METHOD_PROJECTED_CG = 0, 1, 2, 3, 4
SMOOTHER_AUTO, SMOOTHER_GAUSS_SEIDEL, SMOOTHER_RED_BLACK, SMOOTHER_JACOBI, SMOOTHER_FFT = 0, 1, 2, 3, 4
ACTIVE_SET_FREE, ACTIVE_SET_FIXED = 0, 1
INITIAL_GUESS_NONE, INITIAL_GUESS_GIVEN, INITIAL_GUESS_PREVIOUS = 0, 1, 2
CRITERION_RESIDUAL, CRITERION_UPDATE = 0, 1
PRECISION_AUTO, PRECISION_DOUBLE, PRECISION_MIXED = 0, 1, 2
MOTION_SHIFT, MOTION_TRANSIENT_ROLLING, MOTION_STEADY_ROLLING = 0, 1, 2
PRESCRIBED_CREEPAGE, PRESCRIBED_TANGENTIAL_FORCE = 0, 1
STICK_SLIP_EXTERIOR, STICK_SLIP_STICK, STICK_SLIP_SLIP = 0, 1, 2
LOG_OFF, LOG_WARNING, LOG_INFO = 0, 1, 2
UNTRUSTED_FORCE, UNTRUSTED_MAX_PRESSURE, UNTRUSTED_PRESSURE = 1, 2, 4
QUANTITY_FORCE, QUANTITY_MAX_PRESSURE, QUANTITY_CONTACT_AREA = 0, 1, 2
OBSTACLE_NONE, OBSTACLE_SINGULAR, OBSTACLE_ROUND_OFF, OBSTACLE_ELEMENTS, OBSTACLE_MEMORY, OBSTACLE_TIME = 0, 1, 2, 3, 4, 5
LIMITED_BY_UNKNOWN, LIMITED_BY_GRID, LIMITED_BY_TOLERANCE = 0, 1, 2

# The options whose values have names: `method="AUTO"` is `method=METHOD_AUTO`.
NAMED_OPTIONS = ("method", "smoother", "active_set", "initial_guess", "criterion", "precision", "motion")


def value_of(option: str, name: str) -> int:
    """The value of the constant `name` (in any case) of a named option."""
    prefix = option.upper() + "_"
    names = {key[len(prefix) :]: value for key, value in globals().items() if key.startswith(prefix)}
    if option not in NAMED_OPTIONS or name.upper() not in names:
        there_are = f"one of {', '.join(names)}" if option in NAMED_OPTIONS else "a number"
        raise ValueError(f"{option} is {name!r}; it must be {there_are}")
    return int(names[name.upper()])
