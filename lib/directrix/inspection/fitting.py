"""Fitting an ideal form to measured points: least squares, minimum zone, and where to start.

Both fits take steps in the form's own frame (`forms.Form`). Least squares is Gauss-Newton with Marquardt's damping on
orthogonal distances. The minimum zone min (max d - min d) is a sequence of linear programs, each the same problem with d
replaced by its tangent within a trust region; it ends in a local minimum, from the least-squares form the nearest one. A plane
sets out from other directions too, where the points are thick enough for a narrower zone there.
Source: G. T. Anthony et al., Reference software for finding Chebyshev best-fit geometric elements, Precision Engineering 19,
1996; A. B. Forbes, Least-squares best-fit geometric elements, NPL report DITC 140/89 (1989).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import islice

import numpy as np

from directrix.checks import Array, Indices
from directrix.errors import DegenerateError
from directrix.inspection.forms import Form, IdealCone, IdealCylinder, IdealPlane, IdealSphere, IdealTorus, across

DIRECTIONS = 240  # axis directions tried over the half sphere, about 9 degrees apart
SAMPLE = 240  # points used to rank them
REFINED = 10  # best starts that are refined
NEAR = 0.1  # rad: no direction is farther from all that are tried
FLAT = 1e6  # a radius this many times the size of the points means that they do not bend


def least_squares(form: Form, points: Array, *, rounds: int = 200) -> Form:
    """The form nearest to ``form`` that minimises the sum of squared orthogonal distances."""
    d, J = form.residuals(points)
    best, damping = d @ d, 1e-3
    size = np.ptp(points, axis=0).max()
    for _ in range(rounds):
        scale = np.linalg.norm(J, axis=0)
        scale[scale == 0] = 1.0
        step = _damped(J / scale, -d, damping) / scale
        trial = form.stepped(step)
        new_d, new_J = trial.residuals(points)
        value = new_d @ new_d
        if value <= best and np.isfinite(value):
            moved = np.abs(J @ step).max()
            form, d, J = trial, new_d, new_J
            done = moved <= 1e-15 * size or (moved <= 1e-11 * size and best - value <= 1e-14 * best)
            best, damping = value, damping / 8
            if done:
                break
        else:
            damping *= 4
            if damping > 1e12:
                break
    return form


def _damped(J: Array, target: Array, damping: float) -> Array:
    """The step x that minimises |J x - target|² + damping |x|²."""
    rows = np.concatenate([J, np.sqrt(damping) * np.eye(J.shape[1])])
    return np.asarray(np.linalg.lstsq(rows, np.concatenate([target, np.zeros(J.shape[1])]), rcond=None)[0])


def minimum_zone(form: Form, points: Array, *, rounds: int = 100) -> Form:
    """The form nearest to ``form`` whose zone max d - min d is least, set in the middle of the zone."""
    size = float(np.ptp(points, axis=0).max())
    d, J = form.residuals(points)
    width, reach = float(np.ptp(d)), 0.1
    for _ in range(rounds):
        step, predicted = _zone_step(d, J[:, :-1], reach, size)
        if width - predicted <= 1e-13 * size or reach < 1e-15:
            break
        trial = form.stepped(np.append(step, 0.0))
        new_d, new_J = trial.residuals(points)
        gain = (width - float(np.ptp(new_d))) / (width - predicted)
        if gain > 0:
            form, d, J, width = trial, new_d, new_J, float(np.ptp(new_d))
        reach *= 2.0 if gain > 0.75 else 1.0 if gain > 0.25 else 0.25
    middle = np.zeros(form.steps)
    middle[-1] = (d.max() + d.min()) / 2
    return form.stepped(middle)


def narrowest_plane(plane: IdealPlane, points: Array) -> Form:
    """The plane of least zone, from the least-squares plane and from every tried direction that may lead to a narrower one.

    Over points of extent e a turn by NEAR changes a width by at most e NEAR: for a plate no start but the first is left.
    """
    axes = half_sphere()
    widths = np.ptp(points @ axes.T, axis=0)
    enough = float(np.ptp(plane.distance(points))) + NEAR * float(np.linalg.norm(np.ptp(points, axis=0)))
    starts = [plane.normal]
    for i in np.argsort(widths):
        if widths[i] <= enough and np.abs(starts @ axes[i]).max() < np.cos(2 * NEAR) and len(starts) <= REFINED:
            starts.append(axes[i])
    zones = [minimum_zone(IdealPlane(plane.point, normal), points) for normal in starts]
    return min(zones, key=lambda zone: float(np.ptp(zone.distance(points))))


def _zone_step(d: Array, J: Array, reach: float, size: float) -> tuple[Array, float]:
    """The step that minimises max(d + J step) - min(d + J step) within the trust region, and that value.

    A linear program in the step and both limits of the zone. Only a few points touch the zone, so it is solved for the
    extreme ones and points that stick out are added until none does.
    """
    from scipy.optimize import linprog

    scale = np.abs(J).max(axis=0)
    scale[scale == 0] = 1.0
    slopes, limit = J / scale, reach * size
    active = np.unique(np.concatenate([np.argsort(d)[:40], np.argsort(d)[-40:]]))
    while True:
        A, one, nil = slopes[active], np.ones((len(active), 1)), np.zeros((len(active), 1))
        rows = np.block([[A, -one, nil], [-A, nil, one]])
        unit = max(float(np.ptp(d)), 1e-300)
        solved = linprog(
            [*np.zeros(J.shape[1]), 1, -1],
            A_ub=rows,
            b_ub=np.concatenate([-d[active], d[active]]) / unit,
            bounds=[(-limit / unit, limit / unit)] * J.shape[1] + [(None, None)] * 2,
            method="highs",
        )
        if solved.x is None:
            return np.zeros(J.shape[1]), float(np.ptp(d))
        step = solved.x[:-2]
        after = d / unit + slopes @ step
        outside = np.nonzero((after > solved.x[-2] + 1e-9) | (after < solved.x[-1] - 1e-9))[0]
        missing = np.setdiff1d(outside, active)
        if not len(missing):
            return step / scale * unit, float(np.ptp(after)) * unit
        worst = missing[np.argsort(-np.abs(after[missing] - after.mean()))[:200]]
        active = np.union1d(active, worst)


def fit_plane(points: Array) -> Form:
    """The orthogonal least-squares plane: through the centroid, normal to the least singular vector."""
    mean = points.mean(axis=0)
    return IdealPlane(mean, np.linalg.svd(points - mean, full_matrices=False)[2][2])


def algebraic_sphere(points: Array) -> IdealSphere:
    """The sphere of the linear fit |x|² = 2 c·x + k, exact for exact points and a start for others."""
    mean = points.mean(axis=0)
    v = points - mean
    size = np.abs(v).max()
    rows = np.column_stack([2 * v / size, np.ones(len(v))])
    solution, _, rank, _ = np.linalg.lstsq(rows, (v * v).sum(axis=1) / size**2, rcond=1e-12)
    if rank < 4:
        raise DegenerateError("the points lie in one plane: no one sphere fits them best. Measure points off it.")
    center = solution[:3] * size
    return IdealSphere(mean + center, np.sqrt(solution[3] * size**2 + center @ center))


def fit_sphere(points: Array) -> Form:
    """The orthogonal least-squares sphere, from the linear fit."""
    curved(points, "sphere")
    return checked_bend(least_squares(algebraic_sphere(points), points), points, "sphere")


def fit_cylinder(points: Array) -> Form:
    """The orthogonal least-squares cylinder, from the best of many axis directions."""
    return best_of(cylinder_starts(points), points, "cylinder")


def fit_cone(points: Array) -> Form:
    """The orthogonal least-squares cone, from the best of many axis directions."""
    return best_of(cone_starts(points), points, "cone")


def fit_torus(points: Array) -> Form:
    """The orthogonal least-squares torus, from the best of many axis directions."""
    return best_of(torus_starts(points), points, "torus")


def curved(points: Array, name: str) -> None:
    """Refuse points on a line or in a plane: no form that bends fits them best."""
    spread = np.linalg.svd(points, compute_uv=False)
    if spread[2] <= 1e-9 * spread[0]:
        where = "on a line" if spread[1] <= 1e-9 * spread[0] else "in one plane"
        raise DegenerateError(f"the points lie {where}: no one {name} fits them best. Measure points off it, or use flatness.")


def best_of(starts: Iterable[Form], points: Array, name: str) -> Form:
    """Refine each start on a sample and the best on all points."""
    curved(points, name)
    sample = thinned(points)
    tried = [least_squares(start, sample, rounds=40) for start in islice(starts, REFINED)]
    tried = [form for form in tried if np.isfinite(form.residuals(sample)[0]).all()]
    if not tried:
        raise DegenerateError(f"no {name} could be fitted to these points: no start led anywhere.")
    best = min(tried, key=lambda form: float(np.square(form.residuals(sample)[0]).sum()))
    return checked_bend(least_squares(best, points), points, name)


def checked_bend(form: Form, points: Array, name: str) -> Form:
    """Refuse a form whose radius is out of all proportion: the points are flat."""
    size = float(np.ptp(points, axis=0).max())
    radius = max(abs(getattr(form, key, 0.0)) for key in ("radius", "R", "r"))
    if not radius <= FLAT * size:
        raise DegenerateError(
            f"the points do not bend: the best {name} has radius {radius:.3g} for points of size {size:.3g}. Use flatness."
        )
    return form


def thinned(points: Array) -> Array:
    """At most about 240 of the points, evenly taken."""
    return points[:: max(1, len(points) // SAMPLE)]


def half_sphere(count: int = DIRECTIONS) -> Array:
    """Unit vectors spread evenly over the half sphere z >= 0 (a Fibonacci lattice), shape (count, 3)."""
    z = (np.arange(count) + 0.5) / count
    angle = np.arange(count) * np.pi * (3 - np.sqrt(5))
    side = np.sqrt(1 - z * z)
    return np.stack([side * np.cos(angle), side * np.sin(angle), z], axis=1)


def _projections(points: Array) -> tuple[Array, Array, Array, Array, float]:
    """Axes (k, 3), frames (k, 2, 3), coordinates across (k, n, 2) and along (k, n) of points scaled to size 1."""
    size = float(np.abs(points).max())
    axes = half_sphere()
    frames = np.stack([across(axis) for axis in axes])
    scaled = points / size
    return axes, frames, np.einsum("kij,nj->kni", frames, scaled), axes @ scaled.T, size


def _ranked(rows: Array, target: Array, rho: Array) -> tuple[Array, Indices]:
    """Solve the linear fits rows (k, n, p) x = target (k, n); solutions and order by rms error as a distance."""
    solution = np.einsum("kpn,kn->kp", np.linalg.pinv(rows, rcond=1e-9), target)
    error = np.einsum("knp,kp->kn", rows, solution) - target
    score = np.sqrt((error**2).mean(axis=1)) / np.maximum(np.sqrt((rho**2).mean(axis=1)), 1e-9)
    return solution, np.argsort(score)


def arch(points: Array) -> tuple[Array, Array, float]:
    """A point of the axis, the axis and the radius of the cylinder that osculates nearly flat points.

    Heights over their plane are fitted by a quadratic; the axis is its direction of least curvature, the radius the inverse of
    the greatest, at most a thousand times the size of the points.
    """
    frame = np.linalg.svd(points, full_matrices=False)[2]
    x, y, z = (points @ frame.T).T
    size = float(np.abs(points).max())
    rows = np.column_stack([x * x, x * y, y * y, x, y, np.ones_like(x)]) / size
    a, b, c = np.linalg.lstsq(rows, z / size, rcond=1e-12)[0][:3]
    bends, directions = np.linalg.eigh([[2 * a, b], [b, 2 * c]])
    most = int(np.argmax(np.abs(bends)))
    bend = np.sign(bends[most] or 1.0) * max(abs(bends[most]), 1e-3 / size)
    return frame[2] / bend, directions[:, 1 - most] @ frame[:2], abs(1 / bend)


def cylinder_starts(points: Array) -> Iterable[Form]:
    """For each direction the circle |q|² = 2 c·q + k of the points seen along it; best first."""
    points = thinned(points)
    yield IdealCylinder(*arch(points))
    axes, frames, q, _, size = _projections(points)
    rows = np.concatenate([2 * q, np.ones((*q.shape[:2], 1))], axis=2)
    solution, order = _ranked(rows, (q * q).sum(axis=2), _spread(q))
    for i in order:
        c, k = solution[i, :2], solution[i, 2]
        yield IdealCylinder(size * c @ frames[i], axes[i], size * np.sqrt(max(k + c @ c, 1e-12)))


def cone_starts(points: Array) -> Iterable[Form]:
    """For each direction the cone |q|² = 2 c·q + k + a h + s² h²; best first."""
    points = thinned(points)
    yield IdealCone(*arch(points), 0.0)
    axes, frames, q, h, size = _projections(points)
    rows = np.concatenate([2 * q, np.ones((*q.shape[:2], 1)), h[..., None], h[..., None] ** 2], axis=2)
    solution, order = _ranked(rows, (q * q).sum(axis=2), _spread(q))
    for i in order:
        c, (k, a, _) = solution[i, :2], solution[i, 2:]
        radius = np.sqrt(max(k + c @ c, 1e-6))
        yield IdealCone(size * c @ frames[i], axes[i], size * radius, np.arctan(a / (2 * radius)))


def torus_starts(points: Array) -> Iterable[Form]:
    """For each direction the torus ρ² + h² = 2 R ρ + 2 h0 h + k about the circle centre of the points seen along it."""
    points = thinned(points)
    axes, frames, q, h, size = _projections(points)
    rows = np.concatenate([2 * q, np.ones((*q.shape[:2], 1))], axis=2)
    circles, _ = _ranked(rows, (q * q).sum(axis=2), _spread(q))
    centers = np.concatenate([circles[:, :2], q.mean(axis=1)])
    axes, frames, q, h = (np.concatenate([part, part]) for part in (axes, frames, q, h))
    rho = np.linalg.norm(q - centers[:, None], axis=2)
    rows = np.stack([2 * rho, 2 * h, np.ones_like(h)], axis=2)
    solution, order = _ranked(rows, rho**2 + h**2, np.ones_like(rho))
    for i in order:
        R, h0, k = solution[i]
        r = np.sqrt(max(k + R * R + h0 * h0, 1e-6))
        center = size * (centers[i] @ frames[i] + h0 * axes[i])
        if R > 0 and np.abs(solution[i]).max() < 1e3:
            yield IdealTorus(center, axes[i], size * R, size * r)


def _spread(q: Array) -> Array:
    return np.asarray(np.linalg.norm(q - q.mean(axis=1, keepdims=True), axis=2))


Fitter = Callable[[Array], Form]
