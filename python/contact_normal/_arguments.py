"""What callers pass, checked and turned into what the C ABI takes."""

from __future__ import annotations

import ctypes
import operator
from collections.abc import Mapping
from ctypes import POINTER, c_double, c_int32
from typing import TYPE_CHECKING, Any, TypedDict, Union

import numpy as np
import numpy.typing as npt

from . import _constants
from ._library import initialised
from ._structs import Cycle, Options, names

if TYPE_CHECKING:
    Integers = npt.NDArray[np.int32]
    Doubles = npt.NDArray[np.float64]

# The elastic constants: of both bodies, or of each.
Both = Union[float, "npt.ArrayLike"]


class AccuracyOptions(TypedDict, total=False):
    """The options of calls that have a limit of time of their own; see `SolveOptions`."""

    method: str | int
    smoother: str | int
    pre_sweeps: int
    post_sweeps: int
    relaxation: float
    coarsest: int
    active_set: str | int
    initial_guess: str | int
    criterion: str | int
    tolerance: float
    error_ratio: float
    max_cycles: int
    threads: int
    precision: str | int


class SolveOptions(AccuracyOptions, total=False):
    """The options of a solve: the members of `contact_normal_options` and `contact_normal_cycle`. A name stands for its constant: `method="NORM"`.

    Attributes
    ----------
    method : str or int
        "AUTO" (default), "NORM", "MULTIGRID", "FULL_MULTIGRID" or "PROJECTED_CG".
    smoother : str or int
        Of the multigrid methods: "AUTO" (default), "GAUSS_SEIDEL", "RED_BLACK", "JACOBI" or "FFT".
    pre_sweeps, post_sweeps : int
        n1 and n2 of a cycle V(n1, n2); default 1.
    relaxation : float
        In (0, 2); default 0: what suits the smoother.
    coarsest : int
        The coarsest grid has at most this many elements in each direction, 1 to 16; default 4.
    active_set : str or int
        "FREE" (default) or "FIXED": the contact area stays as `contact` gives it.
    initial_guess : str or int
        "NONE" (default), "GIVEN" (as soon as there is a `pressure`) or "PREVIOUS" (of a `Solver`).
    criterion : str or int
        "RESIDUAL" (default) or "UPDATE".
    tolerance : float
        Of the criterion, between 0 and 1; default 1e-6.
    error_ratio : float
        If > 0, the solve may stop once the residual is below this part of the estimated discretisation error; default 0.
    max_cycles : int
        Cycles, or iterations, on the finest grid at most; default 1000.
    max_seconds : float
        If > 0, the call ends after so many seconds, with the best so far; default 0: no limit.
    threads : int
        Default 1; 0: all cores.
    precision : str or int
        "AUTO" (default), "DOUBLE" or "MIXED".
    """

    max_seconds: float


def integer(name: str, value: Any, bits: int = 32) -> int:
    """`value` as an integer that a C integer of `bits` bits can hold."""
    try:
        whole = operator.index(value)
    except TypeError:
        raise TypeError(f"{name} is {value!r}; it must be an integer") from None
    if not -(2 ** (bits - 1)) <= whole < 2 ** (bits - 1):
        raise ValueError(f"{name} is {whole}; it must fit into {bits} bits")
    return whole


_PAIR = c_double * 2


def pointer(array: npt.NDArray[Any], kind: Any = c_double) -> Any:
    """The address of a contiguous array."""
    if array.size and array.flags.writeable:
        return POINTER(kind)(kind.from_buffer(array))
    return array.ctypes.data_as(POINTER(kind))


def _plain(name: str, values: Any, kinds: str, rule: str) -> npt.NDArray[Any]:
    """`values` as an array of one of the `kinds` of numpy, without a mask."""
    if isinstance(values, np.ma.MaskedArray):
        raise TypeError(f"{name} is a masked array; fill it: .filled(...), with inf where h has no surface")
    array = np.asarray(values)
    if array.dtype.kind not in kinds:
        raise TypeError(f"{name} has dtype {array.dtype}; it must hold {rule}")
    return array


def doubles(name: str, values: Any, shape: tuple[int, ...] | None = None, dimensions: str = "(my, mx)") -> Doubles:
    """Contiguous doubles of `shape`, or with as many dimensions as `dimensions` names; copied only where they are not that."""
    array = _plain(name, values, "fiub", "real numbers")
    if array.ndim != dimensions.count(",") + 1:
        raise ValueError(f"{name} has shape {array.shape}; it must be {dimensions}")
    if shape is not None and array.shape != shape:
        raise ValueError(f"{name} has shape {array.shape}; it must be {shape}")
    return np.ascontiguousarray(array, dtype=np.float64)


def integers(name: str, values: Any, shape: tuple[int, ...]) -> Integers:
    """Contiguous 32-bit integers of `shape`, from booleans or integers that fit."""
    array = _plain(name, values, "iub", "integers or booleans")
    if array.shape != shape:
        raise ValueError(f"{name} has shape {array.shape}; it must be {shape}")
    if array.size:
        for extreme in (array.min(), array.max()):
            integer(f"an element of {name}", int(extreme))
    return np.ascontiguousarray(array, dtype=np.int32)


def pair(name: str, value: Any) -> Any:
    """One value for both bodies, or two."""
    if isinstance(value, float):
        return _PAIR(value, value)
    if isinstance(value, tuple) and len(value) == 2 and all(isinstance(one, float) for one in value):
        return _PAIR(*value)
    values = _plain(name, value, "fiu", "one real number or two").astype(np.float64)
    if values.shape not in ((), (1,), (2,)):
        raise ValueError(f"{name} has shape {values.shape}; it must be one value for both bodies, or two")
    return _PAIR(*np.broadcast_to(values, (2,)))


_OPTIONS = {field[0]: field[1] for kind in (Options, Cycle) for field in kind._fields_ if field[0] in SolveOptions.__annotations__}
# Those of the cycle of the paper's methods.
_CYCLE = frozenset(names(Cycle))


def options(given: Mapping[str, Any]) -> Any:
    """The struct of options with those that are given."""
    struct = initialised("options")
    for name, value in given.items():
        if name not in _OPTIONS:
            raise TypeError(f"no option {name}; there are: {', '.join(sorted(_OPTIONS))}")
        if isinstance(value, str):
            value = _constants.value_of(name, value)
        if name in _CYCLE and not struct.cycle:
            struct.cycle = ctypes.pointer(initialised("cycle"))
        setattr(struct.cycle.contents if name in _CYCLE else struct, name, integer(name, value) if _OPTIONS[name] is c_int32 else value)
    return struct
