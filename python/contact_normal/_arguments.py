"""Checks the arguments of Python callers, and converts them to numbers, arrays and structs of the C ABI."""

from __future__ import annotations

import ctypes
import difflib
import operator
import os
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

# The elastic constants: one value for both bodies, or one for each.
Both = Union[float, "npt.ArrayLike"]


class AccuracyOptions(TypedDict, total=False):
    """The options of `solve_to_accuracy` and `cost_of_accuracy`, whose `max_seconds` is an argument; see `SolveOptions`."""

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
    dump: str | os.PathLike[str] | None


class SolveOptions(AccuracyOptions, total=False):
    """The options of a solve: the members of `contact_normal_options` and `contact_normal_cycle`. A name stands for its constant: `method="NORM"`.

    Attributes
    ----------
    method : str or int
        "AUTO" (default), "NORM", "MULTIGRID", "FULL_MULTIGRID" or "PROJECTED_CG".
    smoother : str or int
        Smoother of the multigrid methods: "AUTO" (default), "GAUSS_SEIDEL", "RED_BLACK", "JACOBI" or "FFT".
    pre_sweeps, post_sweeps : int
        n1 and n2 of a multigrid cycle V(n1, n2): the sweeps of the smoother before and after the coarse-grid correction; default 1.
    relaxation : float
        Relaxation factor of the smoother, in (0, 2); default 0: a value that suits the smoother.
    coarsest : int
        The coarsest grid has at most this many elements in each direction, 1 to 16; default 4.
    active_set : str or int
        "FREE" (default): the contact area is found; "FIXED": the contact area is the argument `contact`.
    initial_guess : str or int
        "NONE" (default), "GIVEN" (set if there is a `pressure` or a `contact`) or "PREVIOUS" (for a `Solver`: its last result).
    criterion : str or int
        What the tolerance limits: "RESIDUAL" (default), or "UPDATE", the last change of the pressures.
    tolerance : float
        Tolerance of the criterion, between 0 and 1; default 1e-6.
    error_ratio : float
        If > 0, the solve may stop once the residual is below this part of the estimated discretisation error; default 0.
    max_cycles : int
        Largest number of cycles, or iterations, on the finest grid; default 1000. With adhesion the search for a state with a force < 0 may take more.
    max_seconds : float
        If > 0, the call ends after this time, with the best result so far; default 0: no limit.
    neglect_below : float
        For the function `solve` alone. Effects whose omission changes no quantity by more than this relative amount are left out, and `Result.neglected` names
        them. Default 0: none is left out.
    threads : int
        Number of threads; default 1; 0: all cores.
    precision : str or int
        Precision of the computation: "AUTO" (default), "DOUBLE", or "MIXED": single precision in inner iterations where that saves time, never in the result.
    dump : str or path, optional
        The file into which a call that fails writes its inputs, for `contact-normal-replay`: "failed-%p-%n.dump", where %p is the number of the process and %n
        that of the dump. docs/dump.md says when.
    """

    max_seconds: float
    neglect_below: float


def integer(name: str, value: Any, bits: int = 32) -> int:
    """`value` as an integer that a C integer of `bits` bits can hold."""
    try:
        if isinstance(value, bool):
            raise TypeError
        whole = operator.index(value)
    except TypeError:
        raise TypeError(f"{name} is {value!r}; it must be an integer") from None
    if not -(2 ** (bits - 1)) <= whole < 2 ** (bits - 1):
        raise ValueError(f"{name} is {whole}; it must fit into {bits} bits")
    return whole


def number(name: str, value: Any) -> float:
    """`value` as a double."""
    if type(value) is float:
        return value
    refused = (bool, np.bool_, str, bytes, complex, np.complexfloating, np.ma.MaskedArray)
    try:
        if isinstance(value, refused) or np.ndim(value) or isinstance(value, np.ndarray) and value.dtype.kind not in "fiu":
            raise TypeError
        return float(value)
    except OverflowError:
        raise ValueError(f"{name} is {value}; it must fit into a double") from None
    except (TypeError, ValueError):
        raise TypeError(f"{name} is {value!r}; it must be a real number") from None


def relative(name: str, value: Any) -> float:
    """`value` as a wanted relative error, which must be below 1."""
    error = number(name, value)
    if error >= 1.0:
        raise ValueError(f"{name} is {error:g}; it is a relative error, below 1: that of 1 % is 0.01")
    return error


def flag(name: str, value: Any) -> bool:
    """`value` as True or False. Words and arrays are refused."""
    if isinstance(value, (bool, np.bool_)) or isinstance(value, int) and value in (0, 1):
        return bool(value)
    raise TypeError(f"{name} is {value!r}; it must be True or False")


def two(name: str, value: Any) -> tuple[float, float]:
    """`value` as a pair of numbers."""
    x, y = both(name, value, "two numbers")
    return number(f"{name}[0]", x), number(f"{name}[1]", y)


def both(name: str, values: Any, rule: str = "a pair") -> tuple[Any, Any]:
    """The two members of a pair, which is refused unless it is `rule`."""
    try:
        count = 0 if isinstance(values, (str, bytes, Mapping)) else len(values)
    except TypeError:
        count = 0
    if not count:
        raise TypeError(f"{name} is {values!r}; it must be {rule}")
    if count != 2:
        raise ValueError(f"{name} has {count} parts; it must be {rule}")
    return values[0], values[1]


_PAIR = c_double * 2


def pointer(array: npt.NDArray[Any], kind: Any = c_double) -> Any:
    """A C pointer to the first element of a contiguous array."""
    if array.size and array.flags.writeable:
        return POINTER(kind)(kind.from_buffer(array))
    return array.ctypes.data_as(POINTER(kind))


_DOUBLE = np.dtype(np.float64)


def _has_mask(values: Any) -> bool:
    """Whether a value is a masked array, or a list with a masked array in it."""
    if isinstance(values, (list, tuple)):
        return any(_has_mask(one) for one in values)
    return isinstance(values, np.ma.MaskedArray)


def _plain(name: str, values: Any, kinds: str, rule: str) -> npt.NDArray[Any]:
    """`values` as an array whose dtype is of one of numpy's `kinds`. Masked arrays are refused; `rule` describes the kinds in messages."""
    try:
        array: npt.NDArray[Any] = np.asanyarray(0.0 if (has_mask := _has_mask(values)) else values)
    except ValueError:
        raise ValueError(f"{name} has parts of different shapes; it must be an array") from None
    if has_mask or isinstance(array, np.ma.MaskedArray):
        raise TypeError(f"{name} is a masked array; fill it: .filled(...)")
    if array.dtype.kind == "O" and not array.ndim:
        instead = getattr(values, "_INSTEAD", "")
        raise TypeError(f"{name} is a {type(values).__name__}; it must be an array{f': {instead}' if instead else ''}")
    if array.dtype.kind not in kinds:
        raise TypeError(f"{name} has dtype {array.dtype}; it must hold {rule}")
    return np.asarray(array)


def real(name: str, values: Any) -> Doubles:
    """`values` as an array of doubles, of any shape. Values that a double cannot hold are refused."""
    if type(values) is np.ndarray and values.dtype is _DOUBLE:
        return values
    array = _plain(name, values, "fiu", "real numbers")
    if array.dtype == np.float64:
        return array
    with np.errstate(over="ignore"):
        doubled: Doubles = array.astype(np.float64)
    if array.dtype.kind in "iu" and array.dtype.itemsize == 8 and array.size:
        largest = max(abs(int(array.min())), abs(int(array.max())))
        if largest > 2**53:
            raise ValueError(f"{name} holds {largest}; it must be at most 2^53, for a double to hold it")
    elif array.dtype.itemsize > 8 and not np.array_equal(np.isinf(doubled), np.isinf(array)):
        raise ValueError(f"{name} holds a number that does not fit into a double")
    return doubled


def without_mask(name: str, values: Any) -> Any:
    """`values` with +infinity in the place of masked elements."""
    if isinstance(values, (list, tuple)):
        return [without_mask(name, one) for one in values]
    if not isinstance(values, np.ma.MaskedArray):
        return values
    filled = np.array(real(name, values.filled(0)))
    filled[np.ma.getmaskarray(values)] = np.inf
    return filled


def refuse_x_first(name: str, values: Any) -> None:
    """Refuses an array of xarray whose first dimension is x, because arrays of this package are (my, mx)."""
    dimensions = getattr(values, "dims", None)
    if not isinstance(dimensions, tuple) or len(dimensions) != 2:
        return
    first, last = (str(dimension).lower() for dimension in dimensions)
    if first.startswith("x") and not last.startswith("x"):
        raise ValueError(f"{name} has the dimensions {dimensions}; x must be the last one: transpose it")


def distances(name: str, values: Any) -> Doubles:
    """`values` as undeformed distances. Masked elements have no surface, so that their distance is +infinity."""
    if type(values) is np.ndarray:
        return real(name, values)
    refuse_x_first(name, values)
    array: Any = np.asanyarray(values) if not isinstance(values, (list, tuple)) else values
    return real(name, without_mask(name, array if isinstance(array, np.ma.MaskedArray) else values))


def doubles(name: str, values: Any, shape: tuple[int, ...] | None = None, dimensions: str = "(my, mx)") -> Doubles:
    """`values` as contiguous doubles of `shape`, or of any shape with as many dimensions as `dimensions` lists; copied only if necessary."""
    refuse_x_first(name, values)
    return shaped(name, real(name, values), shape, dimensions)


def shaped(name: str, array: Doubles, shape: tuple[int, ...] | None = None, dimensions: str = "(my, mx)") -> Doubles:
    """`array` in contiguous memory. It is refused if it has another shape, or another number of dimensions than `dimensions` lists."""
    if array.ndim != dimensions.count(",") + 1:
        raise ValueError(f"{name} has shape {array.shape}; it must be {dimensions}")
    if shape is not None and array.shape != shape:
        raise ValueError(f"{name} has shape {array.shape}; it must be {shape}")
    return np.require(array, requirements=("C_CONTIGUOUS", "ALIGNED"))


def integers(name: str, values: Any, shape: tuple[int, ...]) -> Integers:
    """`values`, booleans or integers that fit into 32 bits, as contiguous 32-bit integers of `shape`."""
    refuse_x_first(name, values)
    array = _plain(name, values, "iub", "integers or booleans")
    if array.shape != shape:
        raise ValueError(f"{name} has shape {array.shape}; it must be {shape}")
    if array.size:
        for extreme in (array.min(), array.max()):
            integer(f"an element of {name}", int(extreme))
    return np.require(array, np.int32, ("C_CONTIGUOUS", "ALIGNED"))


def constant(name: str, option: str, value: Any) -> int:
    """The number of a constant of an option, from its name or its number."""
    return _constants.value_of(option, value) if isinstance(value, str) else integer(name, value)


def pair(name: str, value: Any) -> Any:
    """`value`, one number for both bodies or one for each, as a C array of two doubles."""
    if isinstance(value, float):
        return _PAIR(value, value)
    if type(value) is int:
        # numpy has no integers beyond 64 bits.
        value = number(name, value)
    if isinstance(value, tuple) and len(value) == 2 and all(isinstance(one, float) for one in value):
        return _PAIR(*value)
    values = _plain(name, value, "fiu", "one real number or two").astype(np.float64)
    if values.shape not in ((), (1,), (2,)):
        raise ValueError(f"{name} has shape {values.shape}; it must be one value for both bodies, or two")
    return _PAIR(*np.broadcast_to(values, (2,)))


_OPTIONS = {field[0]: field[1] for kind in (Options, Cycle) for field in kind._fields_ if field[0] in SolveOptions.__annotations__}
# Options that are members of `contact_normal_cycle`: they describe the cycle of the multigrid methods.
_CYCLE = frozenset(names(Cycle))


# The arguments of `solve` that are no options: messages on a misspelt name suggest one of them.
_SCENE = (
    "approach", "force", "mean_pressure", "shear_modulus", "poisson_ratio", "young_modulus", "e_star", "influence", "layer", "pressure_limit", "period",
    "patches", "row_tables", "coating", "friction", "adhesion", "visco", "pressure", "contact", "units", "progress",
)


def _nearest(name: str) -> str:
    """A text that suggests the argument or option that is probably meant; "" if no name is similar."""
    near = difflib.get_close_matches(name, [*_SCENE, *_OPTIONS], 1)
    return f" (is {near[0]} meant?)" if near and near[0] != name else ""


def options(given: Mapping[str, Any]) -> Any:
    """A `contact_normal_options` with the library's defaults and the given options."""
    struct = initialised("options")
    for name, value in given.items():
        if name not in _OPTIONS:
            raise TypeError(f"no argument and no option {name}{_nearest(name)}; options are: {', '.join(sorted(_OPTIONS))}")
        if name == "dump":
            # The attribute `path` of the Python object keeps alive the text to which the struct points.
            struct.path = None if value is None else os.fsencode(value)
            struct.dump = ctypes.cast(ctypes.c_char_p(struct.path), ctypes.c_void_p)
            continue
        if isinstance(value, str):
            value = _constants.value_of(name, value)
        if name in _CYCLE and not struct.cycle:
            struct.cycle = ctypes.pointer(initialised("cycle"))
        member = integer(name, value) if _OPTIONS[name] is c_int32 else number(name, value)
        setattr(struct.cycle.contents if name in _CYCLE else struct, name, member)
    return struct
