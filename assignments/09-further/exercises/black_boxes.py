"""Two black boxes: the ladder that judges this course, climbed by the learner.

The two surfaces are handed over as functions of u and w, not as tables of points: where to take samples, and how many, is half of
the task. They cross into the sandbox as coefficients (``autograder.curvedata.SurfaceData``), so that a box can be asked and not
opened. All are smooth, since such a fit has one piece. The samples here are coarse and the tolerance of "the same points" is wide;
the data leave a wide gap between what agrees and what does not.
"""

from functools import lru_cache

import directrix as dx
import numpy as np

from autograder.exercise import exercise


@exercise(points=6, title="Are two surfaces the same?", kind="label", allow=("scipy",))
def same_surface(f, g):
    """Return how two surfaces are related: 'same map', 'relabelled', 'same set', 'moved' or 'different'; the first that is true.

    'same map': f(u, w) = g(u, w) everywhere. 'relabelled': equal after u and w were exchanged, run backwards, or both, one of
    the eight symmetries of the square. 'same set': f and g have the same points, and f covers them as often as g does, only the
    parameters run in another way. 'moved': a rotation and a shift carry each point g(u, w) to f(u, w); no mirror, no change of
    size. 'different': nothing of this. All you can do is to evaluate. In the data, what should agree agrees to 1e-9 of the size, and
    what does not is off by more than a tenth, in distance or in area.

    f, g : functions of two parameters in [0, 1]; f(u, w) takes numbers or arrays that broadcast against each other and gives
        points, an array of their common shape + (3,)

    Returns one of the five labels.
    """
    return _ladder(f, g)


GRID = np.linspace(0.0, 1.0, 41)
U, W = GRID[:, np.newaxis], GRID[np.newaxis, :]
SAME = 1e-7  # of the size: where what should agree agrees
NEAR = 0.06  # of the size, or of the area: more than half the way between two samples, less than what is off
SYMMETRIES = [(u, w, swap) for swap in (False, True) for u in (1, -1) for w in (1, -1)]


def _ladder(f, g, *, sets=True, area=True, both=True, symmetries=SYMMETRIES, motion="rigid"):
    """The ladder, from samples on one grid; with some of its rungs missing for the mistakes."""
    apart, there, back, covered, moved = _measured(f, g)
    if apart[SYMMETRIES[0]] <= SAME:
        return "same map"
    if min(apart[symmetry] for symmetry in symmetries) <= SAME:
        return "relabelled"
    if sets and max(there, back if both else 0.0, covered if area else 0.0) <= NEAR:
        return "same set"
    return "moved" if moved[motion] <= SAME else "different"


@lru_cache(maxsize=1024)  # the reference and all mistakes are asked about the same two surfaces
def _measured(f, g):
    """All that the rungs ask for, in sizes of g: distances for each relabelling; from f to g and from g to f as sets; by how much
    the areas differ, in areas of g; what is left after each kind of motion."""
    from scipy.spatial import cKDTree  # takes longer to load than the exercises of all assignments together

    F, G = f(U, W), g(U, W)
    size = np.linalg.norm(np.ptp(G.reshape(-1, 3), axis=0))
    apart = {}
    for u, w, swap in SYMMETRIES:
        other = G[::u, ::w]
        apart[u, w, swap] = np.linalg.norm(F - (np.swapaxes(other, 0, 1) if swap else other), axis=-1).max() / size
    one, other = F.reshape(-1, 3), G.reshape(-1, 3)
    there, back = (cKDTree(b).query(a)[0].max() / size for a, b in ((one, other), (other, one)))
    left = {motion: _left(one, other, motion) / size for motion in ("rigid", "mirror", "scaled", "shift")}
    return apart, there, back, abs(_area(F) / _area(G) - 1), left


def _area(F):
    """Of two triangles in each cell of the grid."""
    a, b, c, d = F[:-1, :-1], F[1:, :-1], F[:-1, 1:], F[1:, 1:]
    return sum(np.linalg.norm(np.cross(p - q, r - q), axis=-1).sum() for p, q, r in ((b, a, c), (b, d, c))) / 2


def _left(x, y, motion):
    """The largest distance that is left after the best motion of the points y onto x, matched one to one (W. Kabsch)."""
    x, y = x - x.mean(axis=0), y - y.mean(axis=0)
    if motion == "shift":
        return np.linalg.norm(x - y, axis=-1).max()
    left, _, right = np.linalg.svd(x.T @ y)
    turn = np.diag([1.0, 1.0, 1.0 if motion == "mirror" else np.linalg.det(left @ right)])
    if motion == "scaled":
        y = y * np.sqrt((x**2).sum() / (y**2).sum())
    return np.linalg.norm(x - y @ (left @ turn @ right).T, axis=-1).max()


def bent(rng):
    """A random bicubic Bezier net (4, 4, 3): 3 long, 4 wide, bent, and not symmetric in any way."""
    P = np.stack([*np.meshgrid(np.linspace(0, 3, 4), np.linspace(0, 4, 4), indexing="ij"), np.zeros((4, 4))], axis=-1)
    P[..., 2] = 0.4 * P[..., 0] * (3 - P[..., 0]) + 0.2 * P[..., 0] * P[..., 1]
    return P + rng.uniform(-0.3, 0.3, P.shape)


def patch(P):
    return dx.BezierPatch(P)


def pipe(start, turns):
    """A cylinder that begins at a part of a turn and goes round so many times; u goes round, w along it."""

    def points(u, w):
        angle = 2 * np.pi * (start + turns * u)
        return np.stack(np.broadcast_arrays(2 * np.cos(angle), 2 * np.sin(angle), 3 * w), axis=-1)

    return points


def turn(rng):
    """A random rotation, by 60 degrees at least."""
    while True:
        found = np.linalg.qr(rng.normal(size=(3, 3)))[0]
        found = found * np.linalg.det(found)
        if np.trace(found) <= 2:
            return found


# The first argument of most data sets is the second one, with something done to it.


@same_surface.data
def quarter_turn(rng):
    P = bent(rng)
    return {"f": patch(np.swapaxes(P, 0, 1)[::-1]), "g": patch(P)}


@same_surface.data
def slow_start(rng):
    """u is run through slowly at first: the same points, at other parameters."""
    g = patch(bent(rng))
    return {"f": lambda u, w: g(u * (1 + np.asarray(u)) / 2, w), "g": g}


@same_surface.data
def other_seam(rng):
    """The same pipe, begun elsewhere."""
    return {"f": pipe(rng.uniform(0.2, 0.4), 1), "g": pipe(0.0, 1)}


@same_surface.data
def twice_round(rng):
    """The pipe, covered two times."""
    return {"f": pipe(rng.uniform(0.0, 1.0), 2), "g": pipe(0.0, 1)}


@same_surface.data
def there_and_back(rng):
    """Half of the pipe, covered two times: as much area as the whole."""
    half = pipe(rng.uniform(0.0, 1.0), 0.5)
    return {"f": lambda u, w: half((1 - np.cos(2 * np.pi * np.asarray(u))) / 2, w), "g": pipe(0.0, 1)}


@same_surface.data
def a_part(rng):
    g = patch(bent(rng))
    return {"f": lambda u, w: g(0.7 * np.asarray(u), w), "g": g}


@same_surface.data
def carried(rng):
    P = bent(rng)
    return {"f": patch(P @ turn(rng) + rng.uniform(2, 4, 3)), "g": patch(P)}


@same_surface.data
def in_the_mirror(rng):
    P = bent(rng)
    return {"f": patch(P * [1, 1, -1] @ turn(rng) + rng.uniform(2, 4, 3)), "g": patch(P)}


@same_surface.data
def larger(rng):
    P = bent(rng)
    return {"f": patch(rng.uniform(1.2, 1.5) * P @ turn(rng) + rng.uniform(2, 4, 3)), "g": patch(P)}


@same_surface.data
def same_edges(rng):
    """One inner control point stands higher."""
    P = bent(rng)
    Q = P.copy()
    Q[1:3, 1:3, 2] += 2.0
    return {"f": patch(Q), "g": patch(P)}


@same_surface.data(blind=True)
def twins(rng):
    P = bent(rng)
    return {"f": patch(P), "g": patch(P)}


@same_surface.data(blind=True)
def backwards(rng):
    P = bent(rng)
    return {"f": patch(P[::-1]), "g": patch(P)}


@same_surface.mistake("area_not_compared", credit=0.5)
def _(f, g):
    """You compare the two sets of points, from both sides, and nothing else. A pipe that is gone round twice has the same
    points as a pipe; but it is covered twice. What could you measure that doubles?"""
    return _ladder(f, g, area=False)


@same_surface.mistake("one_sided", credit=0.5)
def _(f, g):
    """You ask whether every point of f lies near g, and compare areas; but you never ask whether every point of g lies near f.
    Half of a surface, gone over there and back, passes for the whole. Which points are missed?"""
    return _ladder(f, g, both=False)


@same_surface.mistake("one_sided_no_area", credit=0.25)
def _(f, g):
    """For you it is enough that every point of f lies on g. So does every part of g, however small, and however often it is
    covered. Which two questions are still to be asked?"""
    return _ladder(f, g, area=False, both=False)


@same_surface.mistake("never_exchanged", credit=0.5)
def _(f, g):
    """You run u and w backwards, each and both, and never exchange them: that is four of the eight symmetries of a square. Look
    at a sheet of squared paper: how many ways are there to lay it down on itself?"""
    return _ladder(f, g, symmetries=SYMMETRIES[:4])


@same_surface.mistake("parameters_must_agree", credit=0.25)
def _(f, g):
    """You compare points at matching parameters only, or your border for sets is narrower than a grid is wide. A patch that is run
    through slowly at first is 'different' for you, and a pipe that begins elsewhere 'moved'. How far is a point of f from the
    *nearest* point of g, whatever its parameters, and what is that compared with?"""
    return _ladder(f, g, sets=False)


@same_surface.mistake("mirror_is_moved", credit=0.5)
def _(f, g):
    """Your best motion may be a mirror. No hand can carry a left glove to where it is a right one: a rotation has a
    determinant. What is that of your matrix?"""
    return _ladder(f, g, motion="mirror")


@same_surface.mistake("larger_is_moved", credit=0.5)
def _(f, g):
    """You bring both surfaces to one size before you compare them, so that a larger one passes for a moved one. Carrying a
    thing about does not make it grow. Which step of yours changes lengths?"""
    return _ladder(f, g, motion="scaled")


@same_surface.mistake("shift_only", credit=0.5)
def _(f, g):
    """You find out whether g was shifted, and not whether it was turned. After the shift two clouds of matched points are left
    about one centre. Which rotation carries one to the other as nearly as can be?"""
    return _ladder(f, g, motion="shift")


@same_surface.mistake("edges_only", credit=0.25)
def _(f, g):
    """You looked at the four edges. Two surfaces may have all their edges in common and part inside, as Coons and Ferguson do.
    Where else should you take samples?"""
    F, G = f(U, W), g(U, W)
    rim = np.ones(F.shape[:2], dtype=bool)
    rim[1:-1, 1:-1] = False
    size = np.linalg.norm(np.ptp(G.reshape(-1, 3), axis=0))
    return "same map" if np.linalg.norm(F - G, axis=-1)[rim].max() <= SAME * size else _ladder(f, g)
