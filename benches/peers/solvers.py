"""The calls of each solver in its best settings. `call(problem, tolerance)` returns the pressures (my, mx), or None if the solver cannot solve the
problem. The time of the whole call counts, set-up included."""

import contextlib
import io
import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "python"))

HALF_DECADES = [10 ** (-0.5 * k) for k in range(4, 20)]
DECADES = [10.0**-k for k in range(2, 10)]


def ours(problem, tolerance, threads=1):
    """Solves by contact-normal, method AUTO."""
    import contact_normal

    return contact_normal.solve(
        problem.h,
        problem.dx,
        problem.dy,
        force=problem.force,
        shear_modulus=[0.5 * problem.modulus, np.inf],
        poisson_ratio=0.0,
        tolerance=tolerance,
        threads=threads,
    ).pressure


def aspher(problem, tolerance, **settings):
    """Solves by aspher, which takes square grids of square elements only, N = 64 * 2^k."""
    import aspher as peer

    if not problem.square:
        return None
    result = peer.solve_nested(
        grid_size=problem.h.shape[0],
        gap=np.ascontiguousarray(problem.h).ravel(),
        p_nominal=problem.mean_pressure,
        domain_size=problem.sides[0],
        E_star=problem.modulus,
        backend="fft",
        tol=tolerance,
        **settings,
    )
    return np.array(result.pressure).reshape(problem.h.shape)


def tamaas(problem, tolerance):
    """Solves by tamaas' method of Polonsky and Keer. Its operator dcfft is that of a half-space without periods."""
    import tamaas as peer

    peer.set_log_level(peer.LogLevel.error)
    model = peer.ModelFactory.createModel(peer.model_type.basic_2d, list(problem.sides), list(problem.h.shape))
    model.E, model.nu = problem.modulus, 0.0
    peer.ModelFactory.registerNonPeriodic(model, "dcfft")
    solver = peer.PolonskyKeerRey(model, np.ascontiguousarray(-problem.h), tolerance)
    solver.setIntegralOperator("dcfft")
    solver.max_iter = 20000
    solver.solve(problem.mean_pressure)
    return np.array(model.traction).reshape(problem.h.shape)


def _contact_mechanics(problem):
    from ContactMechanics import FreeFFTElasticHalfSpace
    from ContactMechanics.Systems import NonSmoothContactSystem
    from SurfaceTopography import Topography

    # The first index of ContactMechanics is x, so h is transposed.
    h = np.ascontiguousarray(-problem.h.T)
    sides = problem.sides[::-1]
    return NonSmoothContactSystem(
        FreeFFTElasticHalfSpace(h.shape, problem.modulus, sides), Topography(h, physical_sizes=sides, periodic=False)
    )


def _length(problem):
    """The length by which tolerances are multiplied, because those of ContactMechanics are absolute: a typical penetration or height."""
    return 0.01 if problem.modulus == 1.0 else 0.1


def contact_mechanics(problem, tolerance):
    """Solves by ContactMechanics' method of Polonsky and Keer."""
    system = _contact_mechanics(problem)
    result = system.minimize_proxy(
        maxiter=20000,
        external_force=problem.force,
        pentol=tolerance * _length(problem),
        forcetol=tolerance * problem.force / (0.1 * problem.h.size),
        thermotol=tolerance,
    )
    return np.array(result.jac).T / (problem.dx * problem.dy)


def contact_mechanics_dual(problem, tolerance):
    """Solves by ContactMechanics' conjugate gradients of Bugnicourt et al., with the pressures as unknowns."""
    from NuMPI.Optimization import CCGWithoutRestart

    system = _contact_mechanics(problem)
    mean = problem.force / problem.h.size
    with contextlib.redirect_stdout(io.StringIO()):  # ContactMechanics prints advice here.
        result = CCGWithoutRestart.constrained_conjugate_gradients(
            system.dual_objective(0.0, gradient=True),
            system.dual_hessian_product,
            x0=np.full(problem.h.T.shape, mean),
            gtol=tolerance * _length(problem),
            mean_val=mean,
            maxiter=3000,
        )
    return np.array(result.x).reshape(problem.h.T.shape).T / (problem.dx * problem.dy)


# For each solver its calls by the name of their setting, and the tolerances from loose to tight.
SOLVERS = {
    "contact-normal": ({"AUTO": ours}, HALF_DECADES),
    "aspher": (
        {
            "fft": lambda problem, tolerance: aspher(problem, tolerance, precond_engine="fft"),
            "fft, float then double": lambda problem, tolerance: aspher(
                problem, tolerance, precond_engine="fft", precision="float_then_double"
            ),
            "auto": lambda problem, tolerance: aspher(problem, tolerance, precond_engine="auto"),
        },
        HALF_DECADES,
    ),
    "tamaas": ({"Polonsky-Keer": tamaas}, DECADES),
    "ContactMechanics": ({"Polonsky-Keer": contact_mechanics, "dual": contact_mechanics_dual}, DECADES),
}
