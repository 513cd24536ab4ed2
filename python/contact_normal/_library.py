"""Finds and loads the shared library, and checks that its version suits this package."""

from __future__ import annotations

import ctypes
import ctypes.util
import os
import re
import sys
from ctypes import POINTER, c_char_p, c_double, c_int32, c_int64, c_void_p
from pathlib import Path
from typing import Any

from ._constants import ABI_VERSION, VERSION_MAJOR, VERSION_MINOR, VERSION_PATCH
from ._names import names, places
from ._structs import (
    KINDS,
    Accuracy,
    Coating,
    Cycle,
    EffectsRow,
    Fields,
    Flash,
    Friction,
    FrictionResults,
    Heat,
    HertzSolution,
    Influence,
    LogCallback,
    Options,
    Price,
    QuantityRow,
    Report,
    Scene,
    SolverInfo,
    StressOutputs,
    Visco,
    Wear,
    Worn,
)

# The version of this package.
PACKAGE = (VERSION_MAJOR, VERSION_MINOR, VERSION_PATCH)

# The result type and the argument types of every exported function.
PROTOTYPES: dict[str, tuple[Any, list[Any]]] = {
    "status_text": (c_char_p, [c_int32]),
    "last_error": (c_char_p, []),
    "version": (c_char_p, []),
    "abi_version": (c_int32, []),
    "has": (c_int32, [c_char_p]),
    "constant": (c_int32, [c_char_p, POINTER(c_int32)]),
    "set_option": (c_int32, [POINTER(Options), c_char_p, c_char_p]),
    "set_cycle_option": (c_int32, [POINTER(Cycle), c_char_p, c_char_p]),
    "release": (c_int32, []),
    "keep": (c_int32, [c_int64]),
    "kept": (c_int32, [POINTER(c_int64), POINTER(c_int32)]),
    "init": (None, [c_int32, c_void_p, c_int64]),
    "solve": (c_int32, [POINTER(Scene), POINTER(Options), POINTER(Fields), POINTER(Report)]),
    "pull_off": (c_int32, [POINTER(Scene), POINTER(Options), POINTER(Fields), POINTER(Report)]),
    "solve_tangential": (
        c_int32,
        [c_void_p, POINTER(Scene), POINTER(c_double), POINTER(Options), c_int32, POINTER(c_double), POINTER(FrictionResults), POINTER(Report)],
    ),
    "solver_new": (c_int32, [POINTER(Scene), POINTER(Options), POINTER(c_void_p)]),
    "solver_solve": (c_int32, [c_void_p, POINTER(Scene), POINTER(Options), POINTER(Fields), POINTER(Report)]),
    "solver_solve_batch": (
        c_int32,
        [c_void_p, c_int32] + [POINTER(kind) for kind in (Scene, Options, Fields, Report, c_int32)],
    ),
    "solver_set_influence": (c_int32, [c_void_p, POINTER(Influence), POINTER(Friction)]),
    "solver_fields": (c_int32, [c_void_p, POINTER(Fields)]),
    "solver_query": (c_int32, [c_void_p, POINTER(SolverInfo)]),
    "solver_product": (c_int32, [c_void_p, POINTER(c_double), POINTER(c_double)]),
    "solver_stiffness": (c_int32, [c_void_p, POINTER(c_double), POINTER(c_double)]),
    "solver_free": (c_int32, [c_void_p]),
    "solve_to_accuracy": (
        c_int32,
        [POINTER(Scene), POINTER(Options), POINTER(Accuracy), POINTER(c_void_p), POINTER(Report)],
    ),
    "cost_of_accuracy": (
        c_int32,
        [POINTER(Scene), POINTER(Options), POINTER(Accuracy), c_int32, c_int32, POINTER(c_double), POINTER(Price)],
    ),
    "quantities": (
        c_int32,
        [POINTER(Scene), POINTER(Options), c_int32, POINTER(c_int32), c_int32, POINTER(QuantityRow), POINTER(c_int32)],
    ),
    "effects_bill": (
        c_int32,
        [
            POINTER(Scene), POINTER(Options), c_double, c_int32, c_int32, POINTER(c_int32), c_int32, POINTER(EffectsRow),
            POINTER(c_int32),
        ],
    ),
    "hertz": (
        c_int32,
        [c_double, c_double, POINTER(c_double), POINTER(c_double), c_int32, c_double, POINTER(HertzSolution)],
    ),
    "flash_temperature": (c_int32, [POINTER(Heat), POINTER(c_double), POINTER(Flash)]),
    "frictional_wear": (c_int32, [POINTER(Wear), *[POINTER(c_double)] * 3, POINTER(Worn)]),
    "influence_half_space": (
        c_int32,
        [c_int32, c_int32, c_double, c_double, POINTER(c_double), POINTER(c_double), POINTER(c_double)],
    ),
    "influence_rolling": (
        c_int32,
        [c_int32, c_int32, c_double, c_double, POINTER(c_double), POINTER(c_double), POINTER(Visco), c_double, POINTER(c_double)],
    ),
    "influence_rolling_tangential": (
        c_int32,
        [c_int32, c_int32, c_double, c_double, POINTER(c_double), POINTER(c_double), POINTER(Visco), c_double, POINTER(c_double)],
    ),
    "coating_compliance": (c_int32, [POINTER(Coating), c_double, c_double, c_double, POINTER(c_double)]),
    "subsurface_stress": (
        c_int32,
        [POINTER(Scene), c_int32] + [POINTER(c_double)] * 4 + [c_int32, POINTER(Options), POINTER(StressOutputs)],
    ),
    "stress_at_points": (
        c_int32,
        [POINTER(Scene), c_int32] + [POINTER(c_double)] * 4 + [c_int32, POINTER(Options), POINTER(c_double)],
    ),
    "set_log": (c_int32, [LogCallback, c_int32, c_void_p]),
}


def candidates() -> list[str]:
    """The paths at which the library is looked for, the best one first. `load` takes the first.

    If the environment variable CONTACT_NORMAL_LIBRARY is set, its value is the only path. Otherwise these are, as far as they exist: the library inside this
    package (a wheel); the one that cargo builds in this clone; those in `lib` (Windows: `bin`) of this Python's prefix and of the package's own prefix. If none
    of them exists, the name that the system finds is returned.
    """
    named = os.environ.get("CONTACT_NORMAL_LIBRARY")
    if named:
        return [named]
    here = Path(__file__).resolve().parent
    prefixes = [Path(sys.prefix), *list(here.parents)[2:5]]
    found = [str(path) for path in places(here, prefixes, sys.platform) if path.exists()]
    # `find_library` is the last resort because it calls programs of the system, as gcc.
    return found or [ctypes.util.find_library("contact_normal") or names(sys.platform).installed]


def load() -> ctypes.CDLL:
    """Loads the library, and sets the types of its functions.

    Raises
    ------
    ImportError
        If there is no library, or if its version does not suit this package.
    """
    path = candidates()[0]
    try:
        library = ctypes.CDLL(path)
    except OSError as error:
        raise ImportError(f"{path}: {error}; name the library in CONTACT_NORMAL_LIBRARY") from error
    if not hasattr(library, "contact_normal_abi_version"):
        raise ImportError(f"{path} has no contact_normal_abi_version: it is another library; name the right one in CONTACT_NORMAL_LIBRARY")
    library.contact_normal_abi_version.restype = c_int32
    version = library.contact_normal_abi_version()
    if version < ABI_VERSION:
        raise ImportError(f"{path} has ABI version {version}; this package needs {ABI_VERSION} or newer")
    # The same ABI version is not enough: within one version of the ABI a newer package may have larger structs.
    library.contact_normal_version.restype = c_char_p
    text = library.contact_normal_version().decode()
    if tuple(int(part) for part in re.findall(r"\d+", text)[:3]) < PACKAGE:
        raise ImportError(f"{path} is version {text} of the library; this package needs {'.'.join(map(str, PACKAGE))} or newer")
    for name, (result, arguments) in PROTOTYPES.items():
        try:
            function = getattr(library, "contact_normal_" + name)
        except AttributeError:
            raise ImportError(f"{path}, version {text}, has no contact_normal_{name}: it is no library of this version") from None
        function.restype, function.argtypes = result, arguments
    return library


library = load()

VERSION: str = library.contact_normal_version().decode()


_INITIALISED: dict[str, Any] = {}


def initialised(name: str) -> Any:
    """A new struct of the kind `name` of `KINDS`, with the library's defaults."""
    number, kind = KINDS[name]
    if name not in _INITIALISED:
        struct = kind()
        library.contact_normal_init(number, ctypes.byref(struct), ctypes.sizeof(kind))
        # The struct is stored only when it is complete, because another thread may read it at any time.
        _INITIALISED[name] = struct
    return kind.from_buffer_copy(_INITIALISED[name])


# How a message of the library writes an element: (ix, iy).
_ELEMENT = re.compile(r"element \((\d+), (\d+)\)")


class ContactNormalError(Exception):
    """A call that the library refused.

    Attributes
    ----------
    status : int
        The negative status: `INVALID_ARGUMENT`, `INFEASIBLE`, ...
    message : str
        The argument, its value and the rule it breaks.
    """

    def __init__(self, status: int, message: str) -> None:
        text = library.contact_normal_status_text(status).decode()
        super().__init__(f"{message or text} (status {status}: {text})")
        self.status, self.message = status, message

    def __reduce__(self) -> tuple[Any, ...]:
        # By default an exception is unpickled from its text alone, but this class has two arguments.
        return type(self), (self.status, self.message), self.__dict__


def last_error() -> str:
    """The message of the last call on this thread that returned another status than OK, or a warning."""
    # The library writes an element as (ix, iy), but arrays of Python have the indices [iy, ix]. The replacement is a function, because a replacement text with
    # groups would import a module, which fails at the end of the interpreter.
    return _ELEMENT.sub(lambda found: f"element [{found[2]}, {found[1]}]", library.contact_normal_last_error().decode())


def check(status: int, message: str | None = None) -> int:
    """Returns a status that is not negative. For a negative one it raises ContactNormalError with `message`, by default that of the last call."""
    if status < 0:
        raise ContactNormalError(status, last_error() if message is None else message)
    return status
