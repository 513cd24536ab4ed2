"""Compares solves with friction with aspher: a shift from rest, at an equal residual that this bench checks.

`build/peers/bin/python benches/peers/friction.py [--largest 256 | --report]` after `make bench-peers`, or with the packages of
`requirements.txt`. --largest: up to that size (512); --report: only writes again what build/friction_peers.json holds. Prints the table, writes it
into docs/performance_peers.md; `make pictures` draws it.

Both programs have two bodies with equal elastic constants, the same h, the same load and one thread. Each is called with tighter and tighter
tolerances; aspher has one tolerance for each of the two problems, and is called with its preconditioner and without. The fastest calls that reach
an accuracy are repeated, those of both programs in turns. `tangential.py` has the check.
"""

import gc
import importlib.metadata
import json
import os
import sys
import time
from statistics import median

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[name] = "1"
os.environ["OMP_WAIT_POLICY"] = "passive"
HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.normpath(os.path.join(HERE, "..", ".."))
os.environ.setdefault("CONTACT_NORMAL_LIBRARY", os.path.join(ROOT, "target", "release", "libcontact_normal.so"))
sys.path[:0] = [HERE, os.path.join(ROOT, "python")]

import aspher  # noqa: E402
import numpy as np  # noqa: E402

import contact_normal  # noqa: E402
from problems import rough, sphere  # noqa: E402
from tangential import Shift  # noqa: E402

MU = 0.3
TOLERANCES = [10 ** (-0.5 * k) for k in range(4, 20)]
ACCURACIES = [1e-3, 1e-4, 1e-6]
REPEATS, LONG, REPEATS_OF_LONG, LONGEST = 5, 8.0, 2, 30.0
STALLED = 3  # a search ends after this number of tighter tolerances without a smaller error
# Each scene: the surface, the Poisson ratio, what is given, the tangential force as a part of mu N.
SCENES = [
    ("ball", 0.0, "motion", 0.5),
    ("ball", 0.0, "motion", 0.9),
    ("ball", 0.0, "force", 0.5),
    ("ball", 0.0, "force", 0.9),
    ("ball", 0.3, "motion", 0.5),
    ("rough", 0.0, "motion", 0.5),
    ("rough", 0.0, "motion", 0.9),
    ("rough", 0.3, "motion", 0.5),
]
RESULTS = os.path.join(ROOT, "build", "friction_peers.json")
PAGE = os.path.join(ROOT, "docs", "performance_peers.md")
HEADING = "## Friction\n"


def ours(shift, tolerance, _):
    """Calls contact-normal. Returns the seconds of the normal problem alone and of both problems, the pressures, the tractions, and no shift."""
    problem = shift.normal
    scene = dict(force=problem.force, shear_modulus=shift.shear_modulus, poisson_ratio=shift.poisson_ratio, tolerance=tolerance, threads=1)
    given = dict(force=(shift.force, 0.0)) if shift.shift is None else dict(creepage=(-shift.shift[0], -shift.shift[1]))
    seconds = []
    for friction in (None, dict(coefficient=MU, **given)):
        began = time.process_time()
        result = contact_normal.solve(problem.h, problem.dx, problem.dy, friction=friction, **scene)
        seconds.append(time.process_time() - began)
    return *seconds, result.pressure, np.stack(result.traction), None


def peer(shift, tol_normal, tol_tangential, preconditioned):
    """Calls aspher. Returns the seconds of its set-up and normal step, those with its tangential step, the pressures, the tractions and the shift."""
    problem = shift.normal
    began = time.process_time()
    solver = aspher.FrictionSolver(grid_size=problem.h.shape[0], domain_size=problem.sides[0], E_star=problem.modulus, nu=shift.poisson_ratio,
                                   model=aspher.CoulombFriction(MU), precond=preconditioned)
    solver.set_gap(np.ascontiguousarray(problem.h).ravel())
    solver.step(p_bar=problem.mean_pressure, tol_normal=tol_normal)
    normal = time.process_time() - began
    area = problem.sides[0] * problem.sides[1]
    given = dict(q_bar=(shift.force / area, 0.0)) if shift.shift is None else dict(delta_t=shift.shift)
    result = solver.step(tol_tangential=tol_tangential, **given)
    whole = time.process_time() - began
    p = np.array(solver.pressure).reshape(problem.h.shape)
    return normal, whole, p, np.stack([result.qx, result.qy]), result.delta_t


OURS = "contact-normal"
# The calls: {program: {setting: call}}.
PROGRAMS = {OURS: {"": ours}, "aspher": {"preconditioned": lambda *given: peer(*given, True), "plain": lambda *given: peer(*given, False)}}


def scene(surface, poisson_ratio, given, part, size):
    """The scene with a force of this part of mu N. If the motion is given, its shift is found first by a solve with this force."""
    normal = {"ball": sphere, "rough": rough}[surface](size)
    shift = Shift(normal, poisson_ratio, MU, force=part * MU * normal.force)
    if given == "motion":
        result = contact_normal.solve(normal.h, normal.dx, normal.dy, force=normal.force, shear_modulus=shift.shear_modulus, poisson_ratio=shift.poisson_ratio,
                                      tolerance=1e-7, friction=dict(coefficient=MU, force=(shift.force, 0.0)))
        shift.shift = tuple(-c for c in result.report["creepage"])
    return shift


def search(name, setting, shift, accuracy, start):
    """Solves with tighter and tighter tolerances until both errors reach the accuracy. Returns the points: tolerances, their indices, seconds, errors.

    `start` has the indices of the first tolerances of the normal and of the tangential problem.
    """
    points, places = [], list(start)
    while max(places) < len(TOLERANCES):
        gc.collect()
        tolerances = [TOLERANCES[place] for place in places]
        try:
            normal, whole, p, q, moved = PROGRAMS[name][setting](shift, *tolerances)
        except (RuntimeError, ValueError, TypeError) as error:
            print(f"  {name} at {tolerances}: {type(error).__name__} {error}", flush=True)
            places = [place + 1 for place in places]
            continue
        errors = [shift.normal.error(p), shift.error(p, q, moved)]
        print(f"  {name:14} {setting:14} {tolerances[0]:.1e} {tolerances[1]:.1e} {normal:8.4f} {whole:8.4f} s, errors {errors[0]:.1e} {errors[1]:.1e}", flush=True)
        points.append(dict(tolerances=tolerances, places=list(places), normal=normal, whole=whole, error=max(errors), errors=errors))
        wrong = [not error <= accuracy for error in errors]
        tangential = [point["errors"][1] for point in points]
        stalled = len(points) > STALLED and min(tangential[-STALLED:]) > 0.9 * tangential[-STALLED - 1] and not wrong[0]
        if not any(wrong) or stalled or whole > LONGEST:
            break
        # contact-normal has one tolerance for both problems.
        places = [place + (any(wrong) if name == OURS else one) for place, one in zip(places, wrong)]
    return points


def measure(surface, poisson_ratio, given, part, size):
    """Measures one scene: searches the loosest tolerances for each accuracy, then repeats these calls in turns."""
    print(f"{surface} {size}, nu {poisson_ratio}, {given}, {part:.0%}", flush=True)
    shift = scene(surface, poisson_ratio, given, part, size)
    least, chosen, runs = {}, {}, {}
    for name, setting in ((name, setting) for name, settings in PROGRAMS.items() for setting in settings):
        start = (0, 0)
        for accuracy in ACCURACIES:
            points = search(name, setting, shift, accuracy, start)
            least[name] = min([(point["error"], point["whole"]) for point in points] + [least.get(name, (float("inf"), 0.0))])
            if not points or not points[-1]["error"] <= accuracy:
                break
            start, tolerances, whole = points[-1]["places"], tuple(points[-1]["tolerances"]), points[-1]["whole"]
            if (name, accuracy) not in chosen or whole < chosen[name, accuracy][0]:
                chosen[name, accuracy] = whole, setting, tolerances
    for (name, _), (whole, *way) in chosen.items():
        runs[name, *way] = whole, []
    for turn in range(REPEATS):
        for (name, setting, tolerances), (first, times) in runs.items():
            if turn < (REPEATS if first <= LONG else REPEATS_OF_LONG):
                gc.collect()
                times.append(PROGRAMS[name][setting](shift, *tolerances)[:2])
    results = {}
    for (name, accuracy), (_, setting, tolerances) in chosen.items():
        times = runs[name, setting, tolerances][1]
        normal, whole = (median(column) for column in zip(*times))
        tangential = median(both - alone for alone, both in times)
        results[f"{name} {accuracy:.0e}"] = dict(setting=setting, tolerances=tolerances, normal=normal, tangential=tangential, whole=whole)
    return dict(surface=surface, poisson_ratio=poisson_ratio, given=given, part=part, size=size, least=least, results=results)


def shown(seconds):
    """A time in milliseconds with three figures, as text."""
    return f"{seconds * 1e3:.3g}" if seconds < 1 else f"{seconds * 1e3:.0f}"


def section(measured):
    """The section on friction of docs/performance_peers.md."""
    lines = ["| scene, nu | given | accuracy | contact-normal, ms: normal, tangential, both | aspher, ms (its setting, tolerances) | "
             "times slower: tangential | both |", "|---|---|---|---:|---:|---:|---:|"]
    ratios = {}
    for one in measured:
        other_gone = False  # Whether aspher did not reach the accuracy before: tighter ones are then left out.
        for accuracy in ACCURACIES:
            mine, other = (one["results"].get(f"{name} {accuracy:.0e}") for name in PROGRAMS)
            start = f"| {one['surface']} {one['size']}, {one['poisson_ratio']} | {one['part']:.0%}, {one['given']} | {accuracy:.0e} |"
            times = [", ".join(shown(it[part]) for part in ("normal", "tangential", "whole")) if it else "not reached" for it in (mine, other)]
            if other is None:
                error, seconds = one["least"]["aspher"]
                times[1] += f" (least error {error:.0e}, after {shown(seconds)})"
            else:
                times[1] += " ({}, {:.0e}, {:.0e})".format(other["setting"], *other["tolerances"])
            each = ["", ""]
            if mine and other:
                ratio = [other[part] / mine[part] for part in ("tangential", "whole")]
                each = [f"{value:.1f}" for value in ratio]
                ratios.setdefault(accuracy, []).append(ratio)
            gone, other_gone = other_gone, other is None
            if gone and other_gone:
                continue
            lines.append(f"{start} {times[0]} | {times[1]} | {each[0]} | {each[1]} |")
    version, both_times = importlib.metadata.version("aspher"), []
    for accuracy, both in ratios.items():
        (least, most), (least_both, most_both) = ((min(column), max(column)) for column in zip(*both))
        both_times.append(f"at {accuracy:.0e} {least:.1f} to {most:.1f} times as long for the tangential problem and {least_both:.1f} to {most_both:.1f} "
                          f"times for both, in the {len(both)} of {len(measured)} scenes where it reaches this accuracy")
    return (
        f"{HEADING}\nWritten by `build/peers/bin/python benches/peers/friction.py`. Two like bodies are pressed together and shifted from rest, to 50 % and 90 % of mu N, "
        f"by a motion or by a force. aspher {version} takes {'; '.join(both_times)}.\n\nThe accuracy is the larger one of two values: the error of the pressures as above, and "
        "the residual of the tangential problem, which is relative to the shift or the displacements ([Friction](friction.md)). "
        "A product of the bench's own checks both. Each program has its loosest tolerances that reach the accuracy; aspher has one tolerance for each problem, and the "
        "faster one of its two settings. With nu = 0.3 aspher reaches none of the accuracies, because its iteration stalls: on the ball of 64 x 64 elements its tractions "
        "are equal for tolerances of 1e-3 to 1e-8, and its own check (`tol_kkt`) accepts them. The operators agree: with another sign of Axy, or without Axy, these "
        "tractions leave residuals 13 to 27 times as large.\n\n"
        "The table is for mu = 0.3 and one thread. It has milliseconds of the processor, medians of repeats in turns, for whole cold calls with set-up. "
        "For aspher the set-up is a part of its normal problem. For contact-normal the tangential time is the difference of a call with friction and a call without."
        " Rows of nu = 0 come from a version with a start of its own for nu = 0; without it the tangential problem takes 2.1 to 2.4 times as many instructions there (ball 256).\n\n"
        + "\n".join(lines) + "\n\n![Friction: time over the size, a shift of half of mu N](pictures/performance_friction.svg)\n"
    )


def report():
    """Writes the section into the page, and prints it."""
    with open(RESULTS, encoding="utf-8") as file:
        measured = json.load(file)
    text = section(measured)
    with open(PAGE, encoding="utf-8") as file:
        before = file.read().split(HEADING)[0]
    with open(PAGE, "w", encoding="utf-8") as file:
        file.write(before.rstrip("\n") + "\n\n" + text)
    print(text)


def main():
    arguments = sys.argv[1:]
    if "--report" not in arguments:
        os.makedirs(os.path.dirname(RESULTS), exist_ok=True)
        measured = []
        largest = int(arguments[arguments.index("--largest") + 1]) if "--largest" in arguments else 512
        for size in (size for size in (64, 128, 256, 512) if size <= largest):
            for surface, poisson_ratio, given, part in SCENES:
                if surface == "ball" or size >= 128:
                    measured.append(measure(surface, poisson_ratio, given, part, size))
                    with open(RESULTS, "w", encoding="utf-8") as file:
                        json.dump(measured, file)
    report()


if __name__ == "__main__":
    main()
