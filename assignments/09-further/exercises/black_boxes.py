"""Two black boxes: the ladder that judges this course, climbed by the learner."""

import directrix as dx
import numpy as np
from scipy.spatial import cKDTree

from autograder.exercise import exercise


@exercise(points=6, title="Are two surfaces the same?", kind="label", allow=("scipy",))
def same_surface(f, g):
    """Return how two surfaces are related: 'same map', 'relabelled', 'same set', 'moved' or 'different'; the first that is true.

    'same map': f(u, w) = g(u, w) everywhere. 'relabelled': equal after u and w were exchanged, run backwards, or both, one of
    the eight symmetries of the square. 'same set': f and g have the same points, and f covers them as often as g does, only the
    parameters run in another way. 'moved': a rotation and a shift carry each point g(u, w) to f(u, w); no mirror, no change of
    size. 'different': nothing of this. All you can do is to evaluate. In the data, what should agree agrees to 1e-9 of the size, and
    what does not is off by more than a twentieth of it, in distance or in area.

    f, g : functions of two parameters in [0, 1]; f(u, w) takes numbers or arrays that broadcast against each other and gives
        points, an array of their common shape + (3,)

    Returns one of the five labels.
    """
    return _ladder(f, g)


GRID = np.linspace(0.0, 1.0, 81)
U, W = GRID[:, np.newaxis], GRID[np.newaxis, :]
SAME = 1e-7  # of the size: where what should agree agrees
NEAR = 0.02  # of the size: how far the next sample may be from a point of the same set
SYMMETRIES = [(u, w, swap) for swap in (False, True) for u in (1, -1) for w in (1, -1)]


def _ladder(f, g, *, area=True, both=True, symmetries=SYMMETRIES, motions="rigid"):
    """The ladder, from samples on one grid; with some of its rungs missing for the mistakes."""
    F, G = f(U, W), g(U, W)
    size = np.linalg.norm(np.ptp(G.reshape(-1, 3), axis=0))
    if _apart(F, G) <= SAME * size:
        return "same map"
    for u, w, swap in symmetries:
        other = G[::u, ::w]
        if _apart(F, np.swapaxes(other, 0, 1) if swap else other) <= SAME * size:
            return "relabelled"
    if _same_set(F, G, size, area, both):
        return "same set"
    return "moved" if _moved(F, G, motions) <= SAME * size else "different"


def _apart(F, G):
    return np.linalg.norm(F - G, axis=-1).max()


def _same_set(F, G, size, area, both):
    one, other = F.reshape(-1, 3), G.reshape(-1, 3)
    farthest = cKDTree(other).query(one)[0].max()
    if both:
        farthest = max(farthest, cKDTree(one).query(other)[0].max())
    return farthest <= NEAR * size and (not area or abs(_area(F) / _area(G) - 1) <= NEAR)


def _area(F):
    """Of two triangles in each cell of the grid."""
    a, b, c, d = F[:-1, :-1], F[1:, :-1], F[:-1, 1:], F[1:, 1:]
    return sum(np.linalg.norm(np.cross(p - q, r - q), axis=-1).sum() for p, q, r in ((b, a, c), (b, d, c))) / 2


def _moved(F, G, motions):
    """The largest distance that is left after the best motion of G onto F (Kabsch), "rigid" or one of the mistakes'."""
    x, y = F.reshape(-1, 3), G.reshape(-1, 3)
    x, y = x - x.mean(axis=0), y - y.mean(axis=0)
    if motions == "shift":
        return np.linalg.norm(x - y, axis=-1).max()
    left, _, right = np.linalg.svd(x.T @ y)
    turn = np.diag([1.0, 1.0, 1.0 if motions == "mirror" else np.linalg.det(left @ right)])
    if motions == "scaled":
        y = y * np.sqrt((x**2).sum() / (y**2).sum())
    return np.linalg.norm(x - y @ (left @ turn @ right).T, axis=-1).max()


def bent(rng):
    """A random bicubic Bezier net (4, 4, 3): 3 long, 4 wide, bent, and not symmetric in any way."""
    P = np.stack([*np.meshgrid(np.linspace(0, 3, 4), np.linspace(0, 4, 4), indexing="ij"), np.zeros((4, 4))], axis=-1)
    P[..., 2] = 0.4 * P[..., 0] * (3 - P[..., 0]) + 0.2 * P[..., 0] * P[..., 1]
    return P + rng.uniform(-0.3, 0.3, P.shape)


@same_surface.data
def exchanged(rng):
    P = bent(rng)
    return {"f": dx.BezierPatch(np.swapaxes(P, 0, 1)), "g": dx.BezierPatch(P)}
