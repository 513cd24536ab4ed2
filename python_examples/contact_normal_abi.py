"""The C ABI of contact-normal for ctypes: constants, structs and prototypes as in include/contact_normal.h, and the library. A part of
contact_normal.py.

The library is the one that the environment variable CONTACT_NORMAL_LIBRARY names, else the one built in this project
(target/release), else the system's. Its version and the sizes of its structs are compared with those here at import.
"""

import ctypes
import ctypes.util
import os
from ctypes import CFUNCTYPE, POINTER, c_char_p, c_double, c_int32, c_int64, c_void_p

# Statuses: 0: solved; > 0: stopped early, usable; < 0: refused.
OK, ITERATION_LIMIT, CANCELLED, STAGNATED = 0, 1, 2, 3
NULL_POINTER, INVALID_ARGUMENT, NOT_FINITE, STRUCT_SIZE, UNSUPPORTED = -1, -2, -3, -4, -5
INFEASIBLE, NOT_POSITIVE_DEFINITE, OUT_OF_MEMORY, INTERNAL = -6, -7, -8, -99

ABI_VERSION = 1

PRESCRIBED_APPROACH, PRESCRIBED_FORCE = 0, 1
METHOD_AUTO, METHOD_NORM, METHOD_MULTIGRID, METHOD_FULL_MULTIGRID, METHOD_PROJECTED_CG = 0, 1, 2, 3, 4
SMOOTHER_AUTO, SMOOTHER_GAUSS_SEIDEL, SMOOTHER_RED_BLACK, SMOOTHER_JACOBI, SMOOTHER_FFT = 0, 1, 2, 3, 4
ACTIVE_SET_FREE, ACTIVE_SET_FIXED = 0, 1
INITIAL_GUESS_NONE, INITIAL_GUESS_GIVEN, INITIAL_GUESS_PREVIOUS = 0, 1, 2
CRITERION_RESIDUAL, CRITERION_UPDATE = 0, 1
PRECISION_AUTO, PRECISION_DOUBLE, PRECISION_MIXED = 0, 1, 2
LOG_OFF, LOG_WARNING, LOG_INFO = 0, 1, 2
UNTRUSTED_FORCE, UNTRUSTED_MAX_PRESSURE, UNTRUSTED_PRESSURE = 1, 2, 4
LIMITED_BY_UNKNOWN, LIMITED_BY_GRID, LIMITED_BY_TOLERANCE = 0, 1, 2


class Influence(ctypes.Structure):
    """contact_normal_influence."""

    _fields_ = [
        ("struct_size", c_int64),
        ("cx", c_int32),
        ("cy", c_int32),
        ("coefficients", POINTER(c_double)),
        ("scale", c_double),
    ]


class Layer(ctypes.Structure):
    """contact_normal_layer."""

    _fields_ = [("struct_size", c_int64), ("compliance", c_double), ("compliances", POINTER(c_double))]


class PressureLimit(ctypes.Structure):
    """contact_normal_pressure_limit."""

    _fields_ = [("struct_size", c_int64), ("limit", c_double), ("limits", POINTER(c_double))]


class Period(ctypes.Structure):
    """contact_normal_period."""

    _fields_ = [("struct_size", c_int64), ("x", c_int32), ("y", c_int32)]


class Patches(ctypes.Structure):
    """contact_normal_patches."""

    _fields_ = [
        ("struct_size", c_int64),
        ("count", c_int32),
        ("reserved", c_int32),
        ("patch", POINTER(c_int32)),
        ("factors", POINTER(c_double)),
    ]


class RowTables(ctypes.Structure):
    """contact_normal_row_tables."""

    _fields_ = [
        ("struct_size", c_int64),
        ("cx", c_int32),
        ("rows", c_int32),
        ("coefficients", POINTER(c_double)),
        ("scale", c_double),
    ]


class Scene(ctypes.Structure):
    """contact_normal_scene."""

    _fields_ = [
        ("struct_size", c_int64),
        ("mx", c_int32),
        ("my", c_int32),
        ("dx", c_double),
        ("dy", c_double),
        ("undeformed_distance", POINTER(c_double)),
        ("shear_modulus", c_double * 2),
        ("poisson_ratio", c_double * 2),
        ("load", c_int32),
        ("reserved", c_int32),
        ("approach", c_double),
        ("force", c_double),
        ("influence", POINTER(Influence)),
        ("layer", POINTER(Layer)),
        ("pressure_limit", POINTER(PressureLimit)),
        ("period", POINTER(Period)),
        ("patches", POINTER(Patches)),
        ("row_tables", POINTER(RowTables)),
    ]


class Progress(ctypes.Structure):
    """contact_normal_progress."""

    _fields_ = [
        ("struct_size", c_int64),
        ("mx", c_int32),
        ("my", c_int32),
        ("cycles", c_int64),
        ("active_set_changes", c_int64),
        ("seconds", c_double),
        ("work_units", c_double),
        ("update", c_double),
        ("residual", c_double),
    ]


ProgressCallback = CFUNCTYPE(c_int32, POINTER(Progress), c_void_p)
LogCallback = CFUNCTYPE(None, c_int32, c_char_p, c_void_p)


class Options(ctypes.Structure):
    """contact_normal_options."""

    _fields_ = [
        ("struct_size", c_int64),
        ("method", c_int32),
        ("smoother", c_int32),
        ("pre_sweeps", c_int32),
        ("post_sweeps", c_int32),
        ("relaxation", c_double),
        ("coarsest", c_int32),
        ("active_set", c_int32),
        ("initial_guess", c_int32),
        ("criterion", c_int32),
        ("tolerance", c_double),
        ("error_ratio", c_double),
        ("max_cycles", c_int32),
        ("threads", c_int32),
        ("precision", c_int32),
        ("reserved", c_int32),
        ("progress", ProgressCallback),
        ("user", c_void_p),
    ]


class Fields(ctypes.Structure):
    """contact_normal_fields."""

    _fields_ = [
        ("struct_size", c_int64),
        ("pressure", POINTER(c_double)),
        ("deformed_distance", POINTER(c_double)),
        ("displacement", POINTER(c_double)),
        ("contact", POINTER(c_int32)),
    ]


class LedgerRow(ctypes.Structure):
    """contact_normal_ledger_row."""

    _fields_ = [
        ("mx", c_int32),
        ("my", c_int32),
        ("cycles", c_int64),
        ("seconds", c_double),
        ("work_units", c_double),
        ("residual", c_double),
        ("approach", c_double),
        ("force", c_double),
        ("max_pressure", c_double),
        ("contact_area", c_double),
        ("corrected_area", c_double),
        ("error_force", c_double),
        ("error_max_pressure", c_double),
        ("error_contact_area", c_double),
        ("error_corrected_area", c_double),
        ("error_pressure", c_double),
        ("contact_count", c_int64),
        ("untrusted", c_int32),
        ("reserved", c_int32),
    ]


class Report(ctypes.Structure):
    """contact_normal_report."""

    _fields_ = [
        ("struct_size", c_int64),
        ("cycles", c_int64),
        ("active_set_steps", c_int64),
        ("active_set_changes", c_int64),
        ("matrix_products", c_int64),
        ("work_units", c_double),
        ("update", c_double),
        ("residual", c_double),
        ("penetration", c_double),
        ("complementarity", c_double),
        ("min_pressure", c_double),
        ("approach", c_double),
        ("force", c_double),
        ("max_pressure", c_double),
        ("contact_area", c_double),
        ("contact_count", c_int64),
        ("error_force", c_double),
        ("error_max_pressure", c_double),
        ("error_contact_area", c_double),
        ("setup_seconds", c_double),
        ("solve_seconds", c_double),
        ("bytes", c_int64),
        ("ledger_rows", c_int64),
        ("ledger_capacity", c_int64),
        ("ledger", POINTER(LedgerRow)),
        ("corrected_area", c_double),
        ("error_corrected_area", c_double),
        ("error_pressure", c_double),
        ("untrusted", c_int32),
        ("limited_by", c_int32),
        ("halved_seconds", c_double),
        ("halved_error_force", c_double),
        ("edge_count", c_int64),
        ("tolerance", c_double),
    ]


SurfaceCallback = CFUNCTYPE(c_int32, c_int32, c_int32, c_double, c_double, POINTER(c_double), c_void_p)


class Accuracy(ctypes.Structure):
    """contact_normal_accuracy."""

    _fields_ = [
        ("struct_size", c_int64),
        ("target", c_double),
        ("max_seconds", c_double),
        ("max_bytes", c_int64),
        ("max_elements", c_int64),
        ("surface", SurfaceCallback),
        ("user", c_void_p),
        ("mx", c_int32),
        ("my", c_int32),
        ("dx", c_double),
        ("dy", c_double),
        ("reached", c_double),
        ("seconds", c_double),
    ]


class HertzSolution(ctypes.Structure):
    """contact_normal_hertz_solution: the exact solution."""

    _fields_ = [
        ("semi_axis_x", c_double),
        ("semi_axis_y", c_double),
        ("max_pressure", c_double),
        ("approach", c_double),
        ("force", c_double),
        ("area", c_double),
    ]


# Result and arguments of every export.
_PROTOTYPES = {
    "status_text": (c_char_p, [c_int32]),
    "last_error": (c_char_p, []),
    "version": (c_char_p, []),
    "abi_version": (c_int32, []),
    "scene_init": (None, [POINTER(Scene)]),
    "influence_init": (None, [POINTER(Influence)]),
    "layer_init": (None, [POINTER(Layer)]),
    "pressure_limit_init": (None, [POINTER(PressureLimit)]),
    "period_init": (None, [POINTER(Period)]),
    "patches_init": (None, [POINTER(Patches)]),
    "row_tables_init": (None, [POINTER(RowTables)]),
    "options_init": (None, [POINTER(Options)]),
    "fields_init": (None, [POINTER(Fields)]),
    "report_init": (None, [POINTER(Report)]),
    "solve": (c_int32, [POINTER(Scene), POINTER(Options), POINTER(Fields), POINTER(Report)]),
    "solver_new": (c_int32, [POINTER(Scene), POINTER(Options), POINTER(c_void_p)]),
    "solver_solve": (c_int32, [c_void_p, POINTER(Scene), POINTER(Options), POINTER(Fields), POINTER(Report)]),
    "solver_solve_batch": (
        c_int32,
        [c_void_p, c_int32] + [POINTER(kind) for kind in (Scene, Options, Fields, Report, c_int32)],
    ),
    "solver_set_influence": (c_int32, [c_void_p, POINTER(Influence)]),
    "solver_fields": (c_int32, [c_void_p, POINTER(Fields)]),
    "solver_free": (None, [c_void_p]),
    "accuracy_init": (None, [POINTER(Accuracy)]),
    "solve_to_accuracy": (
        c_int32,
        [POINTER(Scene), POINTER(Options), POINTER(Accuracy), POINTER(c_void_p), POINTER(Report)],
    ),
    "hertz": (
        c_int32,
        [c_double, c_double, POINTER(c_double), POINTER(c_double), c_int32, c_double, POINTER(HertzSolution)],
    ),
    "influence_half_space": (
        c_int32,
        [c_int32, c_int32, c_double, c_double, POINTER(c_double), POINTER(c_double), POINTER(c_double)],
    ),
    "set_log": (c_int32, [LogCallback, c_int32, c_void_p]),
}

# The structs that begin with their size, by the name of their _init.
_SIZED = {
    "scene": Scene, "influence": Influence, "layer": Layer, "pressure_limit": PressureLimit, "period": Period,
    "patches": Patches, "row_tables": RowTables, "options": Options, "fields": Fields, "report": Report,
    "accuracy": Accuracy,
}


def _find():
    named = os.environ.get("CONTACT_NORMAL_LIBRARY")
    if named:
        return named
    here = os.path.dirname(os.path.abspath(__file__))
    built = os.path.join(here, "..", "target", "release", "libcontact_normal.so")
    if os.path.exists(built):
        return built
    return ctypes.util.find_library("contact_normal") or "libcontact_normal.so.0"


def _load():
    path = _find()
    try:
        library = ctypes.CDLL(path)
    except OSError as error:
        raise ImportError(f"{path}: {error}; name the library in CONTACT_NORMAL_LIBRARY") from error
    for name, (result, arguments) in _PROTOTYPES.items():
        function = getattr(library, "contact_normal_" + name)
        function.restype, function.argtypes = result, arguments
    version = library.contact_normal_abi_version()
    if version < ABI_VERSION:
        raise ImportError(f"{path} has ABI version {version}; this module needs {ABI_VERSION} or newer")
    for name, kind in _SIZED.items():
        # Larger than we think: room for a struct that has grown, so that finding out does no harm.
        room = ctypes.create_string_buffer(4096)
        struct = ctypes.cast(room, POINTER(kind))
        getattr(library, f"contact_normal_{name}_init")(struct)
        size = struct.contents.struct_size
        if size != ctypes.sizeof(kind):
            raise ImportError(f"{path}: contact_normal_{name} has {size} bytes, here {ctypes.sizeof(kind)}")
    return library


_library = _load()

VERSION = _library.contact_normal_version().decode()


def _initialised(name):
    struct = _SIZED[name]()
    getattr(_library, f"contact_normal_{name}_init")(ctypes.byref(struct))
    return struct
