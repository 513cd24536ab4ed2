"""contact-normal by ctypes: the elastic normal contact problem on numpy arrays.

    import contact_normal
    result = contact_normal.solve(h, dx, dy, force=82.0e3, shear_modulus=82000.0, poisson_ratio=0.28)
    result.pressure, result.contact, result.approach, result.report["residual"], result.ledger

This file, contact_normal_abi.py beside it, and nothing to install but numpy. The library is the one that the environment variable
CONTACT_NORMAL_LIBRARY names, else the one built in this project (target/release), else the system's; its version and
struct sizes are compared at import.

Arrays are (my, mx), C order: x fastest.
"""

import ctypes
from ctypes import POINTER, c_double, c_int32, c_void_p

import numpy as np

from contact_normal_abi import *  # constants and structs
from contact_normal_abi import _initialised, _library


class ContactNormalError(Exception):
    """A refusal: `status` (negative) and `message`, which names the argument, its value and the rule."""

    def __init__(self, status, message):
        text = _library.contact_normal_status_text(status).decode()
        super().__init__(f"{message or text} (status {status}: {text})")
        self.status, self.message = status, message


def _check(status):
    if status < 0:
        raise ContactNormalError(status, _library.contact_normal_last_error().decode())
    return status


def _pointer(array, kind=c_double):
    return array.ctypes.data_as(POINTER(kind))


def _array(name, values, dtype, shape=None):
    """Contiguous `values` of `dtype`, 2-D; copied only where they are not that already."""
    array = np.asarray(values)
    if array.dtype.kind not in "fiub":
        raise TypeError(f"{name} has dtype {array.dtype}; it must hold real numbers")
    if array.ndim != 2:
        raise ValueError(f"{name} has shape {array.shape}; it must be (my, mx)")
    if shape is not None and array.shape != shape:
        raise ValueError(f"{name} has shape {array.shape}; it must be {shape}")
    return np.ascontiguousarray(array, dtype=dtype)


def _pair(value):
    """One value for both bodies, or two."""
    return (c_double * 2)(*np.broadcast_to(np.asarray(value, dtype=float), (2,)))


def _options(names, progress=None):
    options = _initialised("options")
    known = {name for name, _ in Options._fields_} - {"struct_size", "reserved", "progress", "user"}
    for name, value in names.items():
        if name not in known:
            raise TypeError(f"no option {name}; there are: {', '.join(sorted(known))}")
        setattr(options, name, value)
    if progress is not None:
        options.progress = progress
    return options


class _Watched:
    """A Python callable as the progress callback; an exception in it cancels the solve and is raised after it."""

    def __init__(self, progress):
        self.progress, self.error = progress, None
        self.callback = ProgressCallback(self._call) if progress else None

    def _call(self, told, _user):
        try:
            return 1 if self.progress(told.contents) else 0
        except BaseException as error:  # noqa: B902 - it must not cross the C frames
            self.error = error
            return 1

    def check(self):
        if self.error is not None:
            raise self.error


class Result:
    """What a solve found: arrays (my, mx), the report's numbers, the ledger (one dict per grid, coarsest first).

    `contact` holds the elements at the pressure limit too; `at_limit` those alone.
    """

    def __init__(self, status, message, arrays, report, rows):
        self.status, self.message = status, message
        self.pressure, self.deformed_distance, self.displacement = arrays[:3]
        self.contact, self.at_limit = arrays[3] != 0, arrays[3] == 2
        hidden = ("struct_size", "ledger", "ledger_capacity")
        self.report = {name: getattr(report, name) for name, _ in Report._fields_ if name not in hidden}
        count = min(report.ledger_rows, len(rows))
        self.ledger = [{name: getattr(row, name) for name, _ in LedgerRow._fields_} for row in rows[:count]]

    @property
    def approach(self):
        """Approach of the bodies."""
        return self.report["approach"]

    @property
    def force(self):
        """Normal force."""
        return self.report["force"]


def _effect(scene, kept, name, number, array, value, shape):
    """Names an effect of one number, or of one per element: an array."""
    effect = _initialised(name)
    if np.ndim(value) == 0:
        setattr(effect, number, value)
    else:
        kept.append(_array(name, value, np.float64, shape))
        setattr(effect, array, _pointer(kept[-1]))
    setattr(scene, name, ctypes.pointer(effect))
    kept.append(effect)


def _scaled(values):
    """Coefficients and their scale, of `coefficients` or `(coefficients, scale)`."""
    return values if isinstance(values, tuple) else (values, 1.0)


def _influence(influence):
    """A table of own coefficients, and the array that must live as long as it is used."""
    table, scale = _scaled(influence)
    table = _array("influence", table, np.float64)
    if table.shape[0] % 2 or table.shape[1] % 2:
        raise ValueError(f"influence has shape {table.shape}; it must be (2 cy, 2 cx)")
    effect = _initialised("influence")
    effect.cy, effect.cx, effect.scale = table.shape[0] // 2, table.shape[1] // 2, scale
    effect.coefficients = _pointer(table)
    return effect, table


def _scene(h, dx, dy, approach, force, shear_modulus, poisson_ratio, influence=None, layer=None, pressure_limit=None,
           period=None, patches=None, row_tables=None):
    """A scene, and the arrays that must live as long as it is used."""
    if (approach is None) == (force is None):
        raise TypeError("give either approach or force")
    h = _array("h", h, np.float64)
    scene = _initialised("scene")
    scene.my, scene.mx = h.shape
    scene.dx, scene.dy = dx, dy
    scene.undeformed_distance = _pointer(h)
    scene.shear_modulus, scene.poisson_ratio = _pair(shear_modulus), _pair(poisson_ratio)
    if force is None:
        scene.load, scene.approach = PRESCRIBED_APPROACH, approach
    else:
        scene.load, scene.force = PRESCRIBED_FORCE, force
    kept = [h]
    if influence is not None:
        effect, table = _influence(influence)
        scene.influence = ctypes.pointer(effect)
        kept += [table, effect]
    if layer is not None:
        _effect(scene, kept, "layer", "compliance", "compliances", layer, h.shape)
    if pressure_limit is not None:
        _effect(scene, kept, "pressure_limit", "limit", "limits", pressure_limit, h.shape)
    if period is not None:
        if period not in ("x", "y", "xy"):
            raise ValueError(f"period is {period!r}; it must be 'x', 'y' or 'xy'")
        effect = _initialised("period")
        effect.x, effect.y = "x" in period, "y" in period
        scene.period = ctypes.pointer(effect)
        kept.append(effect)
    if patches is not None:
        patch, factors = _array("patches[0]", patches[0], np.int32, h.shape), _array("patches[1]", patches[1], np.float64)
        if factors.shape[0] != factors.shape[1]:
            raise ValueError(f"patches[1], the factors, has shape {factors.shape}; it must be square")
        effect = _initialised("patches")
        effect.count, effect.patch, effect.factors = len(factors), _pointer(patch, c_int32), _pointer(factors)
        scene.patches = ctypes.pointer(effect)
        kept += [patch, factors, effect]
    if row_tables is not None:
        tables, scale = _scaled(row_tables)
        tables = np.ascontiguousarray(tables, np.float64)
        if tables.ndim != 3 or tables.shape[0] != tables.shape[1] or tables.shape[2] % 2:
            raise ValueError(f"row_tables has shape {tables.shape}; it must be (my, my, 2 cx)")
        effect = _initialised("row_tables")
        effect.rows, effect.cx, effect.coefficients = tables.shape[0], tables.shape[2] // 2, _pointer(tables)
        effect.scale = scale
        scene.row_tables = ctypes.pointer(effect)
        kept += [tables, effect]
    return scene, kept


_LEDGER_ROOM = 32  # one row per grid, each with half the elements in a direction: mx and my are 32-bit


class _Outputs:
    """The structs of one problem with new arrays; `pressure` and `contact` are the initial guess."""

    def __init__(self, shape, pressure, contact, options):
        self.arrays = [np.zeros(shape) for _ in range(3)] + [np.zeros(shape, dtype=np.int32)]
        if pressure is not None:
            self.arrays[0][:] = _array("pressure", pressure, np.float64, shape)
            if contact is None:
                self.arrays[3][:] = self.arrays[0] > 0
        if contact is not None:
            self.arrays[3][:] = _array("contact", contact, np.int32, shape)
        if pressure is not None and options.initial_guess == INITIAL_GUESS_NONE:
            options.initial_guess = INITIAL_GUESS_GIVEN
        self.fields, self.report = _initialised("fields"), _initialised("report")
        self.fields.pressure, self.fields.deformed_distance, self.fields.displacement = map(_pointer, self.arrays[:3])
        self.fields.contact = _pointer(self.arrays[3], c_int32)
        self.rows = (LedgerRow * _LEDGER_ROOM)()
        self.report.ledger, self.report.ledger_capacity = self.rows, _LEDGER_ROOM

    def result(self, status, message, report):
        return Result(status, message, self.arrays, report, self.rows)


def _run(call, shape, pressure, contact, options):
    """Calls `call(fields, report)` with new arrays."""
    outputs = _Outputs(shape, pressure, contact, options)
    status = _check(call(ctypes.byref(outputs.fields), ctypes.byref(outputs.report)))
    message = _library.contact_normal_last_error().decode() if status > 0 else ""
    return outputs.result(status, message, outputs.report)


def solve(
    h,
    dx,
    dy,
    *,
    approach=None,
    force=None,
    shear_modulus,
    poisson_ratio,
    influence=None,
    layer=None,
    pressure_limit=None,
    period=None,
    patches=None,
    row_tables=None,
    pressure=None,
    contact=None,
    progress=None,
    **options,
):
    """Solves one scene: undeformed distance `h` (my, mx), prescribed approach or prescribed force.

    shear_modulus, poisson_ratio: one value, or one per body; influence: own coefficients (2 cy, 2 cx), or a pair of them and
    their scale; layer: compliance, and pressure_limit: one value, or (my, mx); period: "x", "y" or "xy"; patches: the patch of
    each element (my, mx), from 0 on, and the factors (count, count); row_tables: own coefficients of each loaded row, row and
    offset (my, my, 2 cx), or a pair as for influence; pressure, contact: initial guess, or the contact area of
    active_set=ACTIVE_SET_FIXED; progress: called with a Progress after each cycle, a true result cancels; options: the members
    of contact_normal_options (method, tolerance, threads, ...).
    Raises ContactNormalError for a negative status; a positive one (stopped early) is the result's `status`.
    """
    scene, kept = _scene(h, dx, dy, approach, force, shear_modulus, poisson_ratio, influence, layer, pressure_limit, period,
                         patches, row_tables)
    watched = _Watched(progress)
    struct = _options(options, watched.callback)

    def call(fields, report):
        return _library.contact_normal_solve(ctypes.byref(scene), ctypes.byref(struct), fields, report)

    result = _run(call, kept[0].shape, pressure, contact, struct)
    watched.check()
    return result


class _Surface:
    """A Python callable h(x, y) as the surface callback; an exception in it cancels and is raised after the call."""

    def __init__(self, surface, corner):
        self.surface, self.corner, self.error = surface, corner, None
        self.callback = SurfaceCallback(self._call)

    def _call(self, mx, my, dx, dy, h, _user):
        try:
            x = self.corner[0] + (np.arange(mx) + 0.5) * dx
            y = self.corner[1] + (np.arange(my) + 0.5) * dy
            np.ctypeslib.as_array(h, (my, mx))[:] = self.surface(x[None, :], y[:, None])
            return 0
        except BaseException as error:  # noqa: B902 - it must not cross the C frames
            self.error = error
            return 1


def solve_to_accuracy(
    h,
    dx,
    dy,
    *,
    target=1e-3,
    max_seconds=0.0,
    max_bytes=0,
    max_elements=0,
    shape=None,
    corner=None,
    approach=None,
    force=None,
    shear_modulus,
    poisson_ratio,
    progress=None,
    **options,
):
    """Solves on finer and finer grids until the estimated relative error of the force (of the approach, if the force is given)
    is at most `target`, or a limit is in the way (0: no limit).

    h: an array (my, mx), which is refined by cubics; or a callable h(x, y) of the coordinates of element centres, (1, mx) and
    (my, 1), with the `shape` (my, mx) of the first grid; `corner` (x, y) is that of the rectangle, by default centred on (0, 0).
    Returns a Result with the arrays of the grid that was used and further `dx`, `dy`, `reached` (the estimated relative error,
    None: not known) and `seconds`; its `status` is OK where the target is met, else `message` says the best reached.
    """
    surface = None
    if callable(h):
        if shape is None:
            raise TypeError("shape (my, mx) of the first grid is needed where h is a callable")
        my, mx = shape
        surface = _Surface(h, (-0.5 * mx * dx, -0.5 * my * dy) if corner is None else corner)
        h = np.zeros((my, mx))  # not read
    scene, _kept = _scene(h, dx, dy, approach, force, shear_modulus, poisson_ratio, None)
    watched = _Watched(progress)
    struct = _options(options, watched.callback)
    accuracy, report, handle = _initialised("accuracy"), _initialised("report"), c_void_p()
    accuracy.target, accuracy.max_seconds = target, max_seconds
    accuracy.max_bytes, accuracy.max_elements = max_bytes, max_elements
    if surface:
        accuracy.surface = surface.callback
    rows = (LedgerRow * _LEDGER_ROOM)()
    report.ledger, report.ledger_capacity = rows, _LEDGER_ROOM
    try:
        status = _check(
            _library.contact_normal_solve_to_accuracy(
                ctypes.byref(scene), ctypes.byref(struct), ctypes.byref(accuracy), ctypes.byref(handle), ctypes.byref(report)
            )
        )
        message = _library.contact_normal_last_error().decode() if status > 0 else ""
        watched.check()
        if surface and surface.error is not None:
            raise surface.error
        outputs = _Outputs((accuracy.my, accuracy.mx), None, None, struct)
        if handle:
            _check(_library.contact_normal_solver_fields(handle, ctypes.byref(outputs.fields)))
    finally:
        _library.contact_normal_solver_free(handle)
    result = Result(status, message, outputs.arrays, report, rows)
    result.dx, result.dy, result.seconds = accuracy.dx, accuracy.dy, accuracy.seconds
    result.reached = accuracy.reached if accuracy.reached >= 0 else None
    return result


class Solver:
    """A handle for many solves on one grid and one pair of bodies; `with` frees it.

    with Solver(my, mx, dx, dy, shear_modulus=..., poisson_ratio=..., threads=2) as solver:
        first = solver.solve(h, force=1e4)
        next = solver.solve(h2, force=1e4, initial_guess=INITIAL_GUESS_PREVIOUS)
    """

    def __init__(self, my, mx, dx, dy, *, shear_modulus, poisson_ratio, influence=None, layer=None, period=None,
                 patches=None, row_tables=None, **options):
        self._handle = c_void_p()
        self._grid = (dx, dy, shear_modulus, poisson_ratio)
        self._effects = {"layer": layer, "period": period, "patches": patches}
        self._shape, self._set_up = (my, mx), options
        # The set-up reads neither the undeformed distance nor the load, but checks them.
        scene, _kept = _scene(np.zeros((my, mx)), dx, dy, None, 0.0, shear_modulus, poisson_ratio, influence, row_tables=row_tables,
                               **self._effects)
        struct = _options(options)
        _check(_library.contact_normal_solver_new(ctypes.byref(scene), ctypes.byref(struct), ctypes.byref(self._handle)))

    def solve(self, h, *, approach=None, force=None, pressure_limit=None, pressure=None, contact=None, progress=None,
              **options):
        """Solves for `h` and the load, with the options and effects of the set-up and further ones."""
        if not self._handle:
            raise ValueError("this solver is closed")
        dx, dy, shear_modulus, poisson_ratio = self._grid
        scene, kept = _scene(_array("h", h, np.float64, self._shape), dx, dy, approach, force, shear_modulus,
                             poisson_ratio, pressure_limit=pressure_limit, **self._effects)
        watched = _Watched(progress)
        struct = _options({**self._set_up, **options}, watched.callback)

        def call(fields, report):
            return _library.contact_normal_solver_solve(
                self._handle, ctypes.byref(scene), ctypes.byref(struct), fields, report
            )

        result = _run(call, kept[0].shape, pressure, contact, struct)
        watched.check()
        return result

    def solve_batch(self, h, *, approach=None, force=None, pressure_limit=None, pressure=None, contact=None, **options):
        """Solves one problem for each of `h` (count, my, mx), as many at a time as `threads` says, each on one thread.

        approach, force: one value for all, or one for each; pressure, contact: (count, my, mx). Returns a list of Results.
        A problem that is refused does not keep the others from being solved: its `status` is negative, its arrays mean
        nothing.
        """
        if not self._handle:
            raise ValueError("this solver is closed")
        count, struct = len(h), _options({**self._set_up, **options})
        each = [values if values is None else np.broadcast_to(values, count) for values in (approach, force)]
        scenes, outputs, kept = [], [], []
        for i in range(count):
            load = [values if values is None else values[i] for values in each]
            scene, arrays = _scene(_array("h", h[i], np.float64, self._shape), *self._grid[:2], *load, *self._grid[2:],
                                   pressure_limit=pressure_limit, **self._effects)
            scenes.append(scene)
            kept.append(arrays)
            guess = [values if values is None else values[i] for values in (pressure, contact)]
            outputs.append(_Outputs(self._shape, *guess, struct))
        reports = (Report * count)(*(each.report for each in outputs))
        untouched = -(2**31)
        statuses = (c_int32 * count)(*[untouched] * count)
        status = _library.contact_normal_solver_solve_batch(
            self._handle, count, (Scene * count)(*scenes), ctypes.byref(struct),
            (Fields * count)(*(each.fields for each in outputs)), reports, statuses,
        )
        if untouched in statuses:
            _check(status)
        text = [_library.contact_normal_status_text(status).decode() if status else "" for status in statuses]
        return [outputs[i].result(statuses[i], text[i], reports[i]) for i in range(count)]

    def set_influence(self, influence):
        """Later solves use these coefficients, (2 cy, 2 cx) or a pair of them and their scale, in place of the set-up's."""
        if not self._handle:
            raise ValueError("this solver is closed")
        effect, _kept = _influence(influence)
        _check(_library.contact_normal_solver_set_influence(self._handle, ctypes.byref(effect)))

    def close(self):
        """Frees the handle; a second call does nothing."""
        handle, self._handle = self._handle, c_void_p()
        _library.contact_normal_solver_free(handle)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


def hertz(curvature_x, curvature_y, *, approach=None, force=None, shear_modulus, poisson_ratio):
    """The exact solution for h = curvature_x x^2 + curvature_y y^2."""
    if (approach is None) == (force is None):
        raise TypeError("give either approach or force")
    load, amount = (PRESCRIBED_APPROACH, approach) if force is None else (PRESCRIBED_FORCE, force)
    solution = HertzSolution()
    _check(
        _library.contact_normal_hertz(
            curvature_x, curvature_y, _pair(shear_modulus), _pair(poisson_ratio), load, amount, ctypes.byref(solution)
        )
    )
    return solution


def influence_half_space(cx, cy, dx, dy, *, shear_modulus, poisson_ratio):
    """The coefficients of the half-space over offsets -cx..cx-1 by -cy..cy-1, as an array (2 cy, 2 cx)."""
    # Sizes that are no sizes are left to the library, whose message says so.
    table = np.zeros((2 * max(cy, 0), 2 * max(cx, 0)))
    _check(
        _library.contact_normal_influence_half_space(
            cx, cy, dx, dy, _pair(shear_modulus), _pair(poisson_ratio), _pointer(table)
        )
    )
    return table


def set_log(callback, level=LOG_INFO):
    """Sends log messages to `callback(level, message)`; None: none."""
    global _log_callback  # the library keeps the pointer: the object must live

    new = LogCallback(lambda level, message, _user: callback(level, message.decode())) if callback else LogCallback()
    _check(_library.contact_normal_set_log(new, level, None))
    _log_callback = new


_log_callback = None
