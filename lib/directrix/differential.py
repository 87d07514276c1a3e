"""Differential geometry as plain functions over arrays of derivatives, and derivatives of functions known by values only.

Names follow do Carmo, Differential Geometry of Curves and Surfaces, chapters 2 and 3: first form E, F, G; second form L, M, N
(he writes e, f, g), with respect to the unit normal n = S_u x S_w / |S_u x S_w|. A normal curvature is positive where the
surface bends towards n, and k1 >= k2: a sphere parametrised with its normal inward has k1 = k2 = 1/r.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from directrix.checks import Array, Mask

PARALLEL = 1e-10  # |S_u x S_w| <= 1e-10 |S_u| |S_w|: the tangents do not span a plane
ROUNDING = 64 * np.finfo(np.float64).eps  # a tangent this small beside the other one and the point is only rounding


class FirstForm(NamedTuple):
    """Coefficients of the first fundamental form, each of the shape of the parameters."""

    E: Array
    F: Array
    G: Array


class SecondForm(NamedTuple):
    """Coefficients of the second fundamental form, each of the shape of the parameters."""

    L: Array
    M: Array
    N: Array


class Curvature(NamedTuple):
    """Gaussian and mean curvature and the principal curvatures k1 >= k2, each of the shape of the parameters."""

    gaussian: Array
    mean: Array
    k1: Array
    k2: Array


def dot(a: Array, b: Array) -> Array:
    """Scalar products along the last axis."""
    return np.asarray(a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1] + a[..., 2] * b[..., 2])


def norm(a: Array) -> Array:
    """Lengths along the last axis."""
    return np.asarray(np.sqrt(dot(a, a)))


def cross(a: Array, b: Array) -> Array:
    """Vector products along the last axis, componentwise and kept as planes (several times faster than np.cross)."""
    a, b = np.broadcast_arrays(a, b)
    result = np.empty((3, *a.shape[:-1]))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        np.multiply(a[..., j], b[..., k], out=result[i, ...])
        result[i, ...] -= a[..., k] * b[..., j]
    return np.moveaxis(result, 0, -1)


def unit_normal(point: Array, tangent_u: Array, tangent_w: Array) -> tuple[Array, Mask]:
    """S_u x S_w made unit, and where it exists; (0, 0, 0) elsewhere.

    It does not exist where |S_u x S_w| <= 1e-10 |S_u| |S_w|, or where one tangent vanishes to rounding.

    Returns
    -------
    (normal, regular) : arrays of shape (..., 3) and (...) of bool
    """
    normal = cross(tangent_u, tangent_w)
    area = dot(normal, normal)  # squares, to save roots
    if area.size and _plainly_regular(area, point, tangent_u, tangent_w):
        regular = np.ones(area.shape, dtype=bool)
        scale = 1.0 / np.sqrt(area)
    else:
        uu, ww = dot(tangent_u, tangent_u), dot(tangent_w, tangent_w)
        tiny = ROUNDING**2 * (uu + ww + dot(point, point))
        regular = (area > PARALLEL**2 * uu * ww) & (uu > tiny) & (ww > tiny)
        scale = np.divide(1.0, np.sqrt(area), out=np.zeros_like(area), where=regular)
    normal *= scale[..., None]
    normal += 0.0  # no -0.0
    return normal, regular


def _plainly_regular(area: Array, *vectors: Array) -> bool:
    """Whether the extremes alone show every point to be regular, which spares the test of each; squares as in unit_normal.

    |S_u x S_w| <= |S_u| |S_w| bounds the shorter tangent from below by the longest other one.
    """
    largest = (max(float(v.max()), -float(v.min())) for v in vectors)
    point, most_u, most_w = (3 * size * size for size in largest)
    tiny = ROUNDING**2 * (most_u + most_w + point)
    return bool(area.min() > max(PARALLEL**2 * most_u * most_w, tiny * most_u, tiny * most_w))


def first_form(tangent_u: Array, tangent_w: Array) -> FirstForm:
    """E = S_u . S_u, F = S_u . S_w, G = S_w . S_w (do Carmo, section 2-5)."""
    return FirstForm(dot(tangent_u, tangent_u), dot(tangent_u, tangent_w), dot(tangent_w, tangent_w))


def second_form(normal: Array, uu: Array, uw: Array, ww: Array) -> SecondForm:
    """L = S_uu . n, M = S_uw . n, N = S_ww . n (do Carmo, section 3-3, who writes e, f, g)."""
    return SecondForm(dot(uu, normal), dot(uw, normal), dot(ww, normal))


def shape_operator(tangent_u: Array, tangent_w: Array, form: SecondForm) -> tuple[Array, Array, Array, Array, Array]:
    """The second form in an orthonormal tangent frame: entries a, b, c of [[a, b], [b, c]], and the frame e1, e2.

    e1 is along S_u, e2 is what S_w adds to it. In such a frame the principal curvatures are plain eigenvalues, without the
    cancellation of H +- sqrt(H^2 - K). Only for points whose tangents span a plane.
    """
    long_u = norm(tangent_u)
    e1 = tangent_u / long_u[..., None]
    along = dot(tangent_w, e1)
    rest = tangent_w - along[..., None] * e1
    height = norm(rest)
    a = form.L / long_u**2
    b = (form.M / long_u - along * a) / height
    c = (form.N - 2 * along * form.M / long_u + along**2 * a) / height**2
    return a, b, c, e1, rest / height[..., None]


def curvature(tangent_u: Array, tangent_w: Array, form: SecondForm) -> Curvature:
    """Gaussian, mean and principal curvatures: eigenvalues of the shape operator (do Carmo, sections 3-2 and 3-3).

    K = (LN - M^2) / (EG - F^2), H = (EN - 2FM + GL) / 2(EG - F^2), k = H +- sqrt(H^2 - K).
    """
    a, b, c, *_ = shape_operator(tangent_u, tangent_w, form)
    mean, half = (a + c) / 2, np.hypot((a - c) / 2, b)
    return Curvature(a * c - b * b, mean, mean + half, mean - half)


def principal_directions(tangent_u: Array, tangent_w: Array, form: SecondForm) -> tuple[Array, Array]:
    """Unit vectors in space along which the normal curvature is k1 and k2, with d1 x d2 = n.

    At an umbilic, where every direction is principal, d1 is the direction of S_u.
    """
    a, b, c, e1, e2 = shape_operator(tangent_u, tangent_w, form)
    angle = 0.5 * np.arctan2(2 * b, a - c)
    cos, sin = np.cos(angle)[..., None], np.sin(angle)[..., None]
    return cos * e1 + sin * e2, cos * e2 - sin * e1


COMPASS = [(float(a), float(b)) for a in (-1, 0, 1) for b in (-1, 0, 1) if a or b]
AGREED = 1e-5  # unit vectors this close are the same limit: extrapolated ones are good to 1e-7
Jet = Callable[[Array, Array, list[tuple[int, int]]], tuple[Array, ...]]


def limit_normals(jet: Jet, u: Array, w: Array) -> Array:
    """The limits of the unit normal at parameters (k,), (k,) where S_u x S_w = 0, or (0, 0, 0) where there is none.

    Near such a point S_u x S_w = t (a N_u + b N_w) + O(t^2) in the direction (a, b) of the parameter square, with
    N_u = S_uu x S_w + S_u x S_uw and N_w = S_uw x S_w + S_u x S_ww. The limit exists when all directions that lead into the
    square give the same unit vector. Where N_u and N_w vanish too, the normal is extrapolated along each direction
    (Richardson, to about 1e-7) and the same is asked.

    Returns
    -------
    (k, 3) array
    """
    su, sw, suu, suw, sww = jet(u, w, [(1, 0), (0, 1), (2, 0), (1, 1), (0, 2)])
    n_u, n_w = cross(suu, sw) + cross(su, suw), cross(suw, sw) + cross(su, sww)
    small = 1e-9 * (norm(su) + norm(sw)) * (norm(suu) + norm(suw) + norm(sww))
    ahead = np.stack([a * n_u + b * n_w for a, b in COMPASS])
    leads = np.stack([_inside(u, a) & _inside(w, b) for a, b in COMPASS]) & (norm(ahead) > small)
    ahead /= np.where(leads, norm(ahead), 1.0)[..., None]
    count = leads.sum(axis=0)
    middle = (ahead * leads[..., None]).sum(axis=0) / np.maximum(count, 1)[:, None]
    agreed = (count > 0) & ((norm(ahead - middle) <= AGREED) | ~leads).all(axis=0)
    result = np.where(agreed[:, None], middle / np.where(agreed, norm(middle), 1.0)[:, None], 0.0)
    for i in np.flatnonzero(count == 0):
        result[i] = _extrapolated_limit(jet, float(u[i]), float(w[i]))
    return result + 0.0


def _inside(t: Array, step: float) -> Mask:
    """Where a small step leads to a parameter that is still in [0, 1]."""
    return np.asarray((t + step / 64 >= 0) & (t + step / 64 <= 1))


def _extrapolated_limit(jet: Jet, u: float, w: float) -> Array:
    found = [normal for direction in inward(u, w) if (normal := _extrapolated_normal(jet, u, w, direction)) is not None]
    if not found:
        return np.zeros(3)
    middle = np.mean(found, axis=0)
    if max(norm(normal - middle) for normal in found) > AGREED:
        return np.zeros(3)
    return np.asarray(middle / norm(middle))


def inward(u: float, w: float) -> list[tuple[float, float]]:
    """The compass directions that lead from (u, w) into the parameter square."""
    return [(a, b) for a, b in COMPASS if _inside(np.array(u), a) and _inside(np.array(w), b)]


def _extrapolated_normal(jet: Jet, u: float, w: float, direction: tuple[float, float]) -> Array | None:
    steps = np.array([1.0, 0.5, 0.25, 0.125]) / 64
    normal, regular = unit_normal(*jet(u + direction[0] * steps, w + direction[1] * steps, [(0, 0), (1, 0), (0, 1)]))
    if not regular.all():
        return None
    limit = richardson(normal)
    return np.asarray(limit / norm(limit)) if norm(limit) > 0.5 else None


def richardson(values: Array) -> Array:
    """The limit of values at t, t/2, t/4, ... along axis 0, taken to be a power series in t."""
    power = 2.0
    while len(values) > 1:
        values = (power * values[1:] - values[:-1]) / (power - 1)
        power *= 2
    return np.asarray(values[0])


def limit_curvature(jet: Jet, u: float, w: float) -> tuple[float, float]:
    """The limits of k1 and k2 at a parameter where S_u x S_w = 0, to about 1e-6 relative; (nan, nan) if there are none."""
    orders = [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)]
    steps = np.array([1.0, 0.5, 0.25, 0.125]) / 64
    found = []
    for a, b in inward(u, w):
        point, su, sw, *seconds = jet(u + a * steps, w + b * steps, orders)
        normal, regular = unit_normal(point, su, sw)
        if regular.all():
            bent = curvature(su, sw, second_form(normal, *seconds))
            values = np.stack([bent.k1, bent.k2], axis=-1)
            found += [richardson(values), richardson(values[:-1])]  # two estimates: a curvature that grows has no limit
    spread = np.ptp(found, axis=0).max() if found else np.inf
    if spread > 1e-3 * (1 + np.abs(found).max(initial=0.0)):
        return np.nan, np.nan
    k1, k2 = np.mean(found, axis=0)
    return float(k1), float(k2)


DEGREE = 16  # of the local interpolant
WIDTHS = (1 / 4, 1 / 16, 1 / 64, 1 / 256, 1 / 1024)  # half widths of its window, from smooth to wild functions


def numeric_derivative(f: Callable[[Array], Any], t: Array, order: int) -> Array:
    """The derivative of a function known by its values on [0, 1], of a low order.

    Around each t lies a window [c - d, c + d] inside [0, 1], one-sided at the ends. On it f is interpolated in 17 Chebyshev
    points and the interpolant is differentiated; of five widths d the one is taken for which truncation (the last
    coefficients) and rounding together are least (Boyd, Chebyshev and Fourier Spectral Methods, 2nd ed., chapter 2).
    For a smooth f of size 1 the error is about 1e-12 (order 1), 1e-9 (order 2), 1e-7 (order 3) and 1e-5 (order 4), near the
    ends ten times more; at a kink of f it is a mean of both sides.

    Parameters
    ----------
    f : maps (k,) parameters to (k, ...) values
    t : (n,) parameters in [0, 1]

    Returns
    -------
    (n, ...) values of the derivative
    """
    best, least = None, np.full(len(t), np.inf)
    for width in WIDTHS:
        value, doubt = _windowed(f, t, order, width)
        if best is None:
            best = value
        better = doubt < least
        best[better], least[better] = value[better], doubt[better]
    assert best is not None
    return best


def _windowed(f: Callable[[Array], Any], t: Array, order: int, width: float) -> tuple[Array, Array]:
    nodes, to_series, to_derivative = _chebyshev_tables(order)
    centre = np.clip(t, width, 1 - width)
    where = np.clip(centre[:, None] + width * nodes, 0.0, 1.0)
    sampled = np.asarray(f(where.ravel()), dtype=np.float64)
    values = sampled.reshape(len(t), len(nodes), -1)
    series = to_series @ values
    here = np.clip((t - centre) / width, -1.0, 1.0)
    row = chebyshev.chebvander(here, DEGREE) @ to_derivative / width**order
    result = np.einsum("nj,njc->nc", row, series)
    strength = np.abs(row).max(axis=1)
    truncation = np.abs(series[:, -3:]).max(axis=(1, 2))
    rounding = np.finfo(np.float64).eps * np.abs(values).max(axis=(1, 2))
    return result.reshape(len(t), *sampled.shape[1:]), strength * (truncation + rounding)


@cache
def _chebyshev_tables(order: int) -> tuple[Array, Array, Array]:
    """Nodes; values at them -> coefficients; coefficients -> coefficients of the derivative (padded with zeros)."""
    j = np.arange(DEGREE + 1)
    angles = np.pi * (j + 0.5) / (DEGREE + 1)
    nodes = np.cos(angles)
    to_series = 2.0 / (DEGREE + 1) * np.cos(np.outer(j, angles))  # from the angles: arccos of a node near 1 loses digits
    to_series[0] /= 2
    to_derivative = np.zeros((DEGREE + 1, DEGREE + 1))
    to_derivative[: DEGREE + 1 - order] = chebyshev.chebder(np.eye(DEGREE + 1), order)
    return nodes, to_series, to_derivative
