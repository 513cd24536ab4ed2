"""Computes tables of creep forces: in this process, in several processes, or on a cluster. A call continues a table that was interrupted."""

from __future__ import annotations

import concurrent.futures
import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _creep_force_store as store
from . import _netcdf as netcdf
from ._arguments import integer, number, real
from ._bar import Bar
from ._calls import made
from ._creep_force_plane import AXES, Plan, plane, prepared
from ._creep_forces import CreepForceTable
from ._library import ContactNormalError

if TYPE_CHECKING:
    import numpy.typing as npt


def creep_force_table(
    path: str | os.PathLike[str] | None = None,
    *,
    xi: npt.ArrayLike,
    eta: npt.ArrayLike,
    phi: npt.ArrayLike,
    axis_ratio: npt.ArrayLike = 1.0,
    poisson_ratio: npt.ArrayLike = 0.28,
    surface: Mapping[str, Any] | None = None,
    elements: int = 35,
    tolerance: float = 1e-4,
    workers: int = 1,
    client: Any = None,
    progress: Callable[[int, int], Any] | bool | None = None,
) -> CreepForceTable:
    """Computes a table of creep forces in steady rolling: of Hertz ellipses, or of a surface.

    For ellipses with semi-axes a in the rolling direction and b across, and for bodies with equal elastic constants and shear modulus G, all values are
    dimensionless, with c = sqrt(a b)::

        xi  = (G c^2/(mu N)) times the longitudinal creepage        force_x = Fx/(mu N)
        eta = (G c^2/(mu N)) times the lateral creepage             force_y = Fy/(mu N)
        phi = (G c^3/(mu N)) times the spin                         moment  = Mz/(mu N c)

    Forces and moment then depend on xi, eta, phi, a/b and the Poisson ratio only. Kalker's linear theory is force_x = -C11 xi, force_y = -C22 eta - C23 phi,
    moment = C23 eta - C33 phi. For a surface creepages, spin, forces and moments have the units of the input.

    Symmetry gives the entries of other signs. For ellipses xi and phi must be >= 0: (-xi, eta, phi) has (-force_x, force_y, moment), and (xi, -eta, -phi) has
    (force_x, -force_y, -moment). For a surface of bodies with equal elastic constants phi >= 0 is enough: (-xi, -eta, -phi) has (-force_x, -force_y, -moment).

    `error` is the sum of three parts, relative to mu N:

    1. The estimated change of the entry from this grid to infinitely fine elements. It is extrapolated from a grid of elements twice as large, because forces
       converge with first order.
    2. 1/8 of the largest such change of the same ellipse. It covers errors of the next order where the first part happens to be near 0.
    3. The residual.

    Parameters
    ----------
    path : path, optional
        A NetCDF file for the table. Until the table is complete, its parts are in the folder `<path>.parts`, from which the same call continues. If the file
        exists, it is read. Needs xarray and netCDF4 (`pip install 'contact-normal[tables]'`). None: no file is written.
    xi, eta, phi : array_like
        The values along the axes of creepages and spin, increasing.
    axis_ratio, poisson_ratio : array_like
        The values of a/b and of the Poisson ratio, increasing; not for a surface.
    surface : mapping, optional
        "h" (my, mx), "dx", "dy", "force" or "approach", "shear_modulus", "poisson_ratio" as for `solve`, and "coefficient" of friction;
        also "rolling_direction", "spin_centre" and "spin_offset".
    elements : int
        Elements along each side of the rectangle around an ellipse.
    tolerance : float
        Tolerance of the residual of each entry.
    workers : int
        Number of processes. 1: only this one, 0: one for each core. With more than 1 the calling script needs `if __name__ == "__main__":`.
    client : distributed.Client, optional
        A Dask cluster that computes instead of processes on this machine.
    progress : callable or bool, optional
        A callable gets the number of finished entries and that of all entries. An exception in it ends the call, and finished parts remain. True draws a bar on
        stderr.

    Returns
    -------
    CreepForceTable

    Raises
    ------
    ValueError
        If an axis is not increasing or has the wrong sign, or `path` has another table.
    ContactNormalError
        If the library refuses a call.

    Examples
    --------
    >>> import numpy as np, contact_normal
    >>> table = contact_normal.creep_force_table(xi=np.linspace(0.0, 1.0, 5), eta=[0.0], phi=[0.0], elements=17)
    >>> force_x, _, _, error = table.forces([-0.6, 0.1], 0.0, 0.0)
    >>> bool(force_x[0] > 0.9 and force_x[1] < 0), error.shape
    (True, (2,))
    """
    plan = _plan(xi, eta, phi, axis_ratio, poisson_ratio, surface, elements, tolerance)
    journal = None
    if path is not None:
        netcdf.xarray()
        if Path(path).exists():
            table = CreepForceTable.read(path)
            if table._key != store.key(plan):
                raise ValueError(f"{path} has another table; choose another path, or remove it")
            return table
        journal = store.Journal(path, plan)
    try:
        planes = _planes(plan, journal, _workers(workers), client, progress)
    except ContactNormalError:
        if journal is not None:
            journal.leave()
        raise
    table = _assembled(plan, planes)
    if path is not None and journal is not None:
        table.write(path)
        journal.finish()
    return table


def _plan(xi: Any, eta: Any, phi: Any, axis_ratio: Any, poisson_ratio: Any, surface: Any, elements: int, tolerance: float) -> Plan:
    """Checks the arguments of `creep_force_table`, and returns the plan of the table."""
    axes: dict[str, tuple[float, ...]] = {}
    if surface is not None:
        axis_ratio, poisson_ratio = 1.0, 0.0
    for name, values in zip(AXES, (axis_ratio, poisson_ratio, phi, eta, xi)):
        axis = np.atleast_1d(real(name, values))
        if axis.ndim != 1 or not axis.size or not np.isfinite(axis).all() or not (np.diff(axis) > 0).all():
            raise ValueError(f"{name} is {values!r}; it must be increasing and finite")
        if surface is None and name in ("xi", "phi") and axis[0] < 0:
            raise ValueError(f"{name} begins with {axis[0]}; it must not be negative: symmetry gives those of negative {name}")
        if name == "axis_ratio" and axis[0] <= 0:
            raise ValueError(f"axis_ratio begins with {axis[0]}; it must be positive")
        axes[name] = tuple(float(value) for value in axis)
    if integer("elements", elements) < 4:
        raise ValueError(f"elements is {elements}; it must be at least 4")
    parts = None if surface is None else prepared(surface, tolerance)
    return Plan(**axes, elements=0 if surface is not None else int(elements), tolerance=number("tolerance", tolerance), surface=parts)


def _workers(given: int) -> int:
    if (workers := integer("workers", given)) < 0:
        raise ValueError(f"workers is {workers}; it must be at least 1, or 0 for one of each core")
    return workers


def _planes(plan: Plan, journal: store.Journal | None, workers: int, client: Any, progress: Any) -> dict[int, Any]:
    """All planes by their index: those that the journal has, and the missing ones, which are computed."""
    done = journal.done() if journal else {}
    missing = [index for index in range(plan.planes) if index not in done]
    each = len(plan.eta) * len(plan.xi)
    bar = Bar() if progress is True else None
    try:
        for index, arrays in _computed(plan, missing, workers, client):
            if journal:
                journal.write(index, arrays)
            done[index] = arrays
            entries, total = each * len(done), each * plan.planes
            if bar:
                bar.draw(entries / total, f"{entries} of {total} entries")
            elif progress:
                progress(entries, total)
        if bar and not missing:
            bar.draw(1.0, f"{each * plan.planes} of {each * plan.planes} entries")
    finally:
        if bar:
            bar.close()
    return done


def _computed(plan: Plan, missing: list[int], workers: int, client: Any) -> Iterator[tuple[int, Any]]:
    """Computes the missing planes, and yields them with their index in the order in which they are finished."""
    if client is None and workers == 1:
        yield from ((index, plane(plan, index)) for index in missing)
        return
    # A flag in shared memory by which this process ends its workers. It has no lock, because a process that was killed might hold it.
    stop = multiprocessing.RawValue("b", 0) if client is None else None
    if client is not None:
        executor = client.get_executor()
    else:
        executor = concurrent.futures.ProcessPoolExecutor(workers or os.cpu_count(), initializer=_leave_with_parent, initargs=(stop,))
    jobs: dict[Any, int] = {}

    def submit() -> None:
        jobs.update((executor.submit(_at_work if client is None else plane, plan, index), index) for index in missing)

    try:
        # `made` lets another thread submit the jobs: a signal that interrupts an executor leaves it half started.
        made(submit)
        done = concurrent.futures.as_completed(jobs)
        while (job := made(partial(next, done, None))) is not None:
            yield jobs[job], job.result()
        stop = None
    finally:
        # If the loop was left early, the unfinished jobs are not needed any more.
        if stop is not None:
            stop.value = 1
        else:
            for job in list(jobs):
                job.cancel()
        made(partial(executor.shutdown, wait=client is None))


# A lock that a worker process holds except while it computes. If the parent sets `stop`, the worker ends only where this lock is free, and so not while it
# sends a result: the other side would wait for the rest.
_sending = threading.Lock()


def _at_work(plan: Plan, index: int) -> Any:
    """Computes `plane` in a worker process, which may be ended meanwhile."""
    _sending.release()
    try:
        return plane(plan, index)
    finally:
        _sending.acquire()


def _leave_with_parent(stop: Any) -> None:
    """Starts a thread that ends this worker process soon after its parent was killed or has set `stop`. Otherwise the worker would wait for work for ever.

    The worker ignores the interrupt signal of the terminal, because the parent gets it too, and stops its workers.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)

    def watch(started_by: int) -> None:
        while os.getppid() == started_by and not (stop.value and _sending.acquire(timeout=0.05)):
            time.sleep(0.05)
        os._exit(1)

    _sending.acquire()

    # With a fork server the parent of this process is the server, which ends with the process that started it.
    threading.Thread(target=watch, args=(os.getppid(),), daemon=True).start()


def _assembled(plan: Plan, planes: Mapping[int, Mapping[str, Any]]) -> CreepForceTable:
    """Joins the planes to a table, and computes its estimated errors."""
    values = {name: np.stack([planes[index][name] for index in range(plan.planes)]).reshape(plan.shape) for name in planes[0]}
    difference = values.pop("difference")
    largest = np.nanmax(np.where(np.isnan(difference), 0.0, difference), axis=(2, 3, 4), keepdims=True)
    values["error"] = difference + largest / 8.0 + values["residual"]
    axes = {name: np.asarray(getattr(plan, name)) for name in AXES}
    of_surface = plan.surface is not None
    mirrored = not of_surface or plan.phi[0] >= 0
    if plan.surface is not None and not _are_alike(plan.surface["fine"]):
        mirrored = False
    return CreepForceTable(axes, values, plan.elements, plan.tolerance, of_surface, mirrored, store.key(plan))


def _are_alike(grid: Mapping[str, Any]) -> bool:
    """Whether (1 - 2 nu)/G is the same for both bodies. Then pressures cause no relative tangential displacements."""
    shear, poisson = (np.broadcast_to(np.asarray(grid[name], dtype=float), (2,)) for name in ("shear_modulus", "poisson_ratio"))
    return bool((1.0 - 2.0 * poisson[0]) / shear[0] == (1.0 - 2.0 * poisson[1]) / shear[1])
