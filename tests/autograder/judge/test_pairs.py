"""Labelled pairs of surfaces, curves, solids, fields, values, nets, masks and words: where the judge must place each.

Each row is a right answer, another answer, and the tier at which that must end, with no mistake listed that could name it.
``python tests/autograder/judge/test_pairs.py`` prints the table.
"""

import math

import numpy as np
import pytest

from autograder.exercise import exercise
from autograder.judge import judge

TURN = 2 * np.pi


def stacked(x, y, z):
    return np.stack(np.broadcast_arrays(x, y, z), axis=-1)


def cylinder(u, w, r=2.0, h=5.0):
    return stacked(r * np.cos(TURN * u), r * np.sin(TURN * u), h * w)


def frustum(u, w, r1=3.0, r2=1.0, h=4.0):
    rho = r1 + (r2 - r1) * w
    return stacked(rho * np.cos(TURN * u), rho * np.sin(TURN * u), h * w)


def sphere(u, w, r=2.0, south=-np.pi / 2, height=np.pi):
    return stacked(
        r * np.cos(south + height * u) * np.cos(TURN * w),
        r * np.cos(south + height * u) * np.sin(TURN * w),
        r * np.sin(south + height * u),
    )


def torus(u, w, big=3.0, r=1.0):
    rho = big + r * np.cos(TURN * u)
    return stacked(rho * np.cos(TURN * w), rho * np.sin(TURN * w), r * np.sin(TURN * u))


def carried_circle(u, w):
    return stacked(3 * np.cos(TURN * w) + np.cos(TURN * u), 3 * np.sin(TURN * w), np.sin(TURN * u))


def blend(u, w, p00, p01, p10, p11):
    u, w = (np.asarray(t)[..., None] for t in np.broadcast_arrays(u, w))
    return (1 - u) * (1 - w) * p00 + (1 - u) * w * p01 + u * (1 - w) * p10 + u * w * p11


def spindle(u, w):
    return torus(u, w, 0.7, 2.3)


def double_cone(u, w):
    return stacked((3 * u - 1) * np.cos(TURN * w), (3 * u - 1) * np.sin(TURN * w), 2 * u)


A, B, C = np.array([1.0, 2, 0]), np.array([4.0, 1, 2]), np.array([0.0, 5, 3])
QUAD = (np.array([0.0, 0, 0]), np.array([0.0, 3, 1]), np.array([4.0, 0, 0]), np.array([5.0, 4, 2]))


def quad(u, w):
    return blend(u, w, *QUAD)


def triangle(u, w):
    return blend(u, w, A, C, B, C)


def square(u, w):
    return stacked(u, w, 0 * u)


def saddle(u, w):
    return stacked(2 * u - 1, 2 * w - 1, (2 * u - 1) ** 2 - (2 * w - 1) ** 2)


NET = np.array(
    [
        [[-2, 2, 2], [1, 2, -2], [-2, 7, 2], [-1, 14, -2]],
        [[1, 0, -2], [5, 3, 0], [1, 9, 1], [3, 11, 0]],
        [[5, 0, 0], [4, 4, 2], [8, 6, -2], [5, 13, -1]],
        [[7, 1, 1], [11, 3, -2], [8, 9, -1], [7, 11, 2]],
    ],
    dtype=float,
)
BUMPED = NET.copy()
BUMPED[1, 2] += [0.5, 0, 1]
NOISY = NET + np.random.default_rng(5).normal(scale=0.3, size=NET.shape)


def bezier(u, w, net=NET):
    u, w = np.broadcast_arrays(u, w)

    def bernstein(t):
        return np.stack([math.comb(3, i) * t**i * (1 - t) ** (3 - i) for i in range(4)], axis=-1)

    return np.einsum("...i,...j,ijk->...k", bernstein(np.asarray(u)), bernstein(np.asarray(w)), net)


def turned(axis, degrees):
    k = np.array(axis, dtype=float) / np.linalg.norm(axis)
    cross = np.array([[0, -k[2], k[1]], [k[2], 0, -k[0]], [-k[1], k[0], 0]])
    t = np.radians(degrees)
    return np.eye(3) + np.sin(t) * cross + (1 - np.cos(t)) * cross @ cross


def placed(surface, matrix=None, shift=(0.0, 0.0, 0.0), scale=1.0):
    """The surface turned, scaled, then shifted."""
    matrix = np.eye(3) if matrix is None else matrix
    return lambda u, w: scale * surface(u, w) @ matrix.T + np.array(shift)


def traced(surface, u_of, w_of=lambda u, w: w):
    """The surface at other parameters."""
    return lambda u, w: surface(u_of(u, w), w_of(u, w))


def squared(u, w):
    return u**2


def bent(u, w):
    return u + 0.1 * np.sin(np.pi * u) * w


ODD = turned([1, 2, 3], 70)
MIRROR = np.diag([1.0, 1.0, -1.0])

PAIRS = [
    ("cylinder, the same formula", cylinder, lambda u, w: cylinder(u, w), "identical"),
    (
        "cylinder, cosine as a shifted sine",
        cylinder,
        lambda u, w: stacked(2 * np.sin(TURN * u + np.pi / 2), 2 * np.sin(TURN * u), 5 * w),
        "identical",
    ),
    ("cylinder, clockwise", cylinder, lambda u, w: cylinder(1 - u, w), "relabelled"),
    ("cylinder, from the top", cylinder, lambda u, w: cylinder(u, 1 - w), "relabelled"),
    ("cylinder, u and w exchanged", cylinder, lambda u, w: cylinder(w, u), "relabelled"),
    ("cylinder, both backwards", cylinder, lambda u, w: cylinder(1 - u, 1 - w), "relabelled"),
    ("cylinder, exchanged and one backwards", cylinder, lambda u, w: cylinder(w, 1 - u), "relabelled"),
    ("cylinder, exchanged and both backwards", cylinder, lambda u, w: cylinder(1 - w, 1 - u), "relabelled"),
    ("cylinder, starts on +y", cylinder, lambda u, w: cylinder((u + 0.25) % 1.0, w), "other start"),
    ("cylinder, starts anywhere and runs clockwise", cylinder, lambda u, w: cylinder((0.37 - u) % 1.0, w), "other start"),
    ("cylinder, 3.14 for π", cylinder, lambda u, w: stacked(2 * np.cos(6.28 * u), 2 * np.sin(6.28 * u), 5 * w), "close"),
    ("cylinder, 22/7 for π", cylinder, lambda u, w: stacked(2 * np.cos(44 / 7 * u), 2 * np.sin(44 / 7 * u), 5 * w), "close"),
    ("cylinder, float32", cylinder, lambda u, w: cylinder(u, w).astype(np.float32), "close"),
    ("cylinder, u squared", cylinder, traced(cylinder, squared), "same set"),
    ("cylinder, u squared and clockwise", cylinder, traced(cylinder, lambda u, w: 1 - u**2), "same set"),
    ("cylinder, helical u lines", cylinder, traced(cylinder, lambda u, w: (u + w) % 1.0), "same set"),
    ("cylinder, twice round", cylinder, traced(cylinder, lambda u, w: (2 * u) % 1.0), "covered"),
    ("cylinder, degrees", cylinder, lambda u, w: stacked(2 * np.cos(360 * u), 2 * np.sin(360 * u), 5 * w), "covered"),
    ("cylinder, half round", cylinder, traced(cylinder, lambda u, w: u / 2), "part"),
    ("cylinder, 3.1 for π", cylinder, lambda u, w: stacked(2 * np.cos(6.2 * u), 2 * np.sin(6.2 * u), 5 * w), "part"),
    ("cylinder, u as the angle", cylinder, lambda u, w: stacked(2 * np.cos(u), 2 * np.sin(u), 5 * w), "part"),
    ("cylinder, half as high", cylinder, lambda u, w: cylinder(u, w / 2), "part"),
    ("cylinder, w ignored", cylinder, lambda u, w: cylinder(u, 0 * w), "part"),
    ("cylinder, one point", cylinder, lambda u, w: cylinder(0 * u, 0 * w), "part"),
    ("cylinder, too tall", cylinder, lambda u, w: cylinder(u, w, 2.0, 6.0), "more"),
    ("cylinder, other radius", cylinder, lambda u, w: cylinder(u, w, 2.5), "different"),
    ("cylinder, other scale", cylinder, lambda u, w: 1.5 * cylinder(u, w), "moved"),
    ("cylinder, axis x", cylinder, lambda u, w: np.roll(cylinder(u, w), 1, axis=-1), "moved"),
    ("cylinder, hanging down", cylinder, lambda u, w: cylinder(u, w, 2.0, -5.0), "moved"),
    ("cylinder, centred", cylinder, placed(cylinder, shift=(0, 0, -2.5)), "moved"),
    ("cylinder, u squared and tilted", cylinder, placed(traced(cylinder, squared), ODD, (1, 0, 3)), "moved"),
    ("cylinder for a frustum of its mean radius", frustum, lambda u, w: cylinder(u, w, 2.0, 4.0), "different"),
    ("frustum, radii exchanged", frustum, lambda u, w: frustum(u, w, 1.0, 3.0), "moved"),
    ("frustum, u squared and tilted", frustum, placed(traced(frustum, squared), ODD, (1, 0, 3)), "moved"),
    ("frustum, sum of radii", frustum, lambda u, w: frustum(u, w, 3.0, 4.0), "different"),
    ("sphere, north first", sphere, lambda u, w: sphere(1 - u, w), "relabelled"),
    ("sphere, starts on +y", sphere, lambda u, w: sphere(u, (w + 0.25) % 1.0), "other start"),
    ("sphere, whole circle turned", sphere, lambda u, w: sphere(u, w, height=TURN), "covered"),
    ("sphere, upper half twice", sphere, lambda u, w: sphere(u, w, south=0.0), "part"),
    ("sphere, axis tilted", sphere, placed(sphere, ODD), "same set"),
    ("sphere, even heights", sphere, traced(sphere, lambda u, w: np.arcsin(2 * u - 1) / np.pi + 0.5), "same set"),
    ("cylinder, infinitely fast at one end", cylinder, traced(cylinder, lambda u, w: u**1.5, lambda u, w: w**0.6), "same set"),
    ("cylinder, overlapping by a twentieth", cylinder, traced(cylinder, lambda u, w: 1.05 * u), "covered"),
    ("bezier, five times as fast at the end", bezier, traced(bezier, lambda u, w: u / (u + 5 * (1 - u))), "same set"),
    ("torus, infinitely fast at one end", torus, traced(torus, lambda u, w: u**1.5, lambda u, w: w**0.6), "same set"),
    ("sphere, slow at one pole", sphere, traced(sphere, lambda u, w: u**3), "same set"),
    ("sphere, slow at both", sphere, traced(sphere, lambda u, w: u**3 * (10 - 15 * u + 6 * u**2)), "same set"),
    ("sphere, elsewhere", sphere, placed(sphere, shift=(1, 2, 3)), "moved"),
    (
        "sphere, radius not shrunk",
        sphere,
        lambda u, w: stacked(2 * np.cos(TURN * w), 2 * np.sin(TURN * w), 4 * u - 2),
        "different",
    ),
    ("torus, tube half a turn later", torus, lambda u, w: torus((u + 0.5) % 1.0, w), "other start"),
    ("torus, both starts elsewhere, exchanged", torus, lambda u, w: torus((w + 0.2) % 1.0, (u + 0.7) % 1.0), "other start"),
    ("torus, half a tube", torus, lambda u, w: torus(u / 2, w), "part"),
    ("spindle torus, half a tube", spindle, lambda u, w: spindle(u / 2, w), "part"),
    ("double cone, a sector", double_cone, lambda u, w: double_cone(u, w / 6), "part"),
    ("double cone, twice round", double_cone, lambda u, w: double_cone(u, 2 * w), "covered"),
    ("torus, R read as the outer radius", torus, lambda u, w: torus(u, w, 2.0), "different"),
    ("torus, circle carried along", torus, carried_circle, "different"),
    ("circle carried along, turned", carried_circle, torus, "different"),
    ("triangle, the whole parallelogram", triangle, lambda u, w: blend(u, w, A, C, B, B + C - A), "more"),
    ("triangle, run from another corner", triangle, lambda u, w: blend(u, w, B, A, C, A), "same set"),
    ("triangle, clamped", triangle, lambda u, w: blend(u, np.minimum(w, 1 - u), A, C, B, B + C - A), "covered"),
    ("triangle, another triangle", triangle, lambda u, w: blend(u, w, A, C, B, 2 * C), "different"),
    ("square, u squared", square, traced(square, squared), "same set"),
    ("square, half of it", square, lambda u, w: square(u / 2, w), "part"),
    ("square, upright", square, lambda u, w: stacked(u, 0 * u, w), "moved"),
    ("square, bent and tilted", square, placed(traced(square, bent), ODD, (3, 2, 1)), "moved"),
    (
        "saddle, upside down is turned",
        saddle,
        lambda u, w: stacked(2 * u - 1, 2 * w - 1, (2 * w - 1) ** 2 - (2 * u - 1) ** 2),
        "moved",
    ),
    ("saddle, exchanged", saddle, lambda u, w: saddle(w, u), "relabelled"),
    ("saddle, steeper", saddle, lambda u, w: saddle(u, w) * [1, 1, 1.3], "different"),
    ("quadrilateral, p01 and p10 exchanged", quad, lambda u, w: blend(u, w, QUAD[0], QUAD[2], QUAD[1], QUAD[3]), "relabelled"),
    ("quadrilateral, corners round the loop", quad, lambda u, w: blend(u, w, QUAD[0], QUAD[3], QUAD[1], QUAD[2]), "different"),
    (
        "quadrilateral, plane through three corners",
        quad,
        lambda u, w: blend(u, w, QUAD[0], QUAD[1], QUAD[2], QUAD[1] + QUAD[2]),
        "different",
    ),
    ("quadrilateral, counted twice", quad, lambda u, w: 2 * quad(u, w), "moved"),
    ("Bezier, transposed", bezier, lambda u, w: bezier(u, w, NET.transpose(1, 0, 2)), "relabelled"),
    ("Bezier, rows reversed", bezier, lambda u, w: bezier(u, w, NET[::-1]), "relabelled"),
    ("Bezier, mirrored", bezier, placed(bezier, MIRROR), "moved"),
    ("Bezier, turned and scaled", bezier, placed(bezier, ODD, (1, 2, 3), 0.5), "moved"),
    ("Bezier, turned, scaled and transposed", bezier, lambda u, w: placed(bezier, ODD, (1, 2, 3), 0.5)(w, u), "moved"),
    ("Bezier, bent", bezier, traced(bezier, bent), "same set"),
    ("Bezier, bent and turned", bezier, placed(traced(bezier, bent), ODD, (1, 2, 3)), "moved"),
    (
        "Bezier, bent, slow at an edge, and turned",
        bezier,
        placed(traced(bezier, bent, lambda u, w: w**1.5), ODD, (1, 2, 3)),
        "moved",
    ),
    ("Bezier, bent and mirrored", bezier, placed(traced(bezier, bent), ODD @ MIRROR, (1, 2, 3)), "moved"),
    ("Bezier, a quarter of it", bezier, lambda u, w: bezier(u / 2, w / 2), "part"),
    ("Bezier, one control point off", bezier, lambda u, w: bezier(u, w, BUMPED), "different"),
    ("Bezier, noise in the net", bezier, lambda u, w: bezier(u, w, NOISY), "different"),
    ("a flat array", square, lambda u, w: np.asarray(u) + np.asarray(w), "shape"),
    ("not a number at a corner", square, lambda u, w: square(u, w) * ((u + w) / (u + w))[..., None], "not finite"),
]


def helix(u, r=2.0, pitch=3.0):
    return stacked(r * np.cos(TURN * u), r * np.sin(TURN * u), pitch * u)


def circle(u, r=2.0):
    return stacked(r * np.cos(TURN * u), r * np.sin(TURN * u), 0 * u)


def block(u, v, w):
    return stacked(2 * u + 0.3 * v * w, 3 * v + u**2 * w, 4 * w - 0.5 * u * v)


def up(u, w):
    """Unit vectors over the square."""
    return stacked(0.6 * np.cos(TURN * u), 0.6 * np.sin(TURN * u), 0.8 + 0 * w)


def inside(u, w):
    return np.asarray(u) + np.asarray(w) <= 1


CORNERS = np.random.default_rng(3).normal(size=(4, 3, 3))
ONE = np.eye(4)[1][:, None, None] * np.ones(3)

OTHERS = [
    ("curve: helix, the same", "curve", helix, lambda u: helix(u), "identical"),
    ("curve: helix, from the top", "curve", helix, lambda u: helix(1 - u), "relabelled"),
    ("curve: circle, starts on +y", "curve", circle, lambda u: circle((u + 0.25) % 1), "other start"),
    ("curve: circle, clockwise from +y", "curve", circle, lambda u: circle((0.25 - u) % 1), "other start"),
    ("curve: helix, 3.14 for π", "curve", helix, lambda u: stacked(2 * np.cos(6.28 * u), 2 * np.sin(6.28 * u), 3 * u), "close"),
    ("curve: helix, u squared", "curve", helix, lambda u: helix(u**2), "same set"),
    ("curve: circle, twice round", "curve", circle, lambda u: circle(2 * u), "covered"),
    ("curve: circle, degrees", "curve", circle, lambda u: stacked(2 * np.cos(360 * u), 2 * np.sin(360 * u), 0 * u), "covered"),
    ("curve: helix, half of it", "curve", helix, lambda u: helix(u / 2), "part"),
    ("curve: helix, one point", "curve", helix, lambda u: helix(0 * u), "part"),
    ("curve: helix, goes on", "curve", helix, lambda u: helix(1.5 * u), "more"),
    ("curve: helix, elsewhere", "curve", helix, lambda u: helix(u) + [1, 2, 3], "moved"),
    ("curve: helix, left-handed", "curve", helix, lambda u: helix(u) * [1, 1, -1], "moved"),
    ("curve: helix, tilted and u squared", "curve", helix, lambda u: helix(u**2) @ ODD.T, "moved"),
    ("curve: helix, steeper", "curve", helix, lambda u: helix(u, pitch=4.0), "different"),
    ("curve: numbers for points", "curve", helix, lambda u: np.asarray(u) * 2, "shape"),
    ("curve: divided by u", "curve", helix, lambda u: helix(u) * (u / u)[..., None], "not finite"),
    ("solid: the same", "solid", block, lambda u, v, w: block(u, v, w), "identical"),
    ("solid: v and w exchanged", "solid", block, lambda u, v, w: block(u, w, v), "relabelled"),
    ("solid: all round", "solid", block, lambda u, v, w: block(v, w, u), "relabelled"),
    ("solid: v backwards", "solid", block, lambda u, v, w: block(u, 1 - v, w), "relabelled"),
    ("solid: rounded", "solid", block, lambda u, v, w: block(u, v, w) * 1.0005, "close"),
    ("solid: w squared", "solid", block, lambda u, v, w: block(u, v, w**2), "same set"),
    ("solid: a half", "solid", block, lambda u, v, w: block(u, v, w / 2), "part"),
    ("solid: one layer", "solid", block, lambda u, v, w: block(u, v, 0 * w), "part"),
    ("solid: tilted", "solid", block, lambda u, v, w: block(u, v, w) @ ODD.T + [1, 2, 3], "moved"),
    ("solid: twice as large", "solid", block, lambda u, v, w: 2 * block(u, v, w), "moved"),
    ("solid: a term is missing", "solid", block, lambda u, v, w: block(u, v, w) - stacked(0 * u, u**2 * w, 0 * v), "different"),
    ("field: the same", "field", up, lambda u, w: up(u, w), "identical"),
    ("field: rounded", "field", up, lambda u, w: np.round(up(u, w), 4), "close"),
    ("field: points to the other side", "field", up, lambda u, w: -up(u, w), "different"),
    ("field: u backwards means nothing here", "field", up, lambda u, w: up(1 - u, w), "different"),
    ("mask: the same", "mask", inside, lambda u, w: ~(np.asarray(u) + np.asarray(w) > 1), "identical"),
    ("mask: strictly inside", "mask", inside, lambda u, w: np.asarray(u) + np.asarray(w) < 1, "different"),
    ("mask: the other half", "mask", inside, lambda u, w: ~inside(u, w), "different"),
    ("mask: one answer for all", "mask", inside, lambda u, w: True, "different"),
    ("net: the same as lists", "net", CORNERS, CORNERS.tolist(), "identical"),
    ("net: rounded", "net", CORNERS, np.round(CORNERS, 4), "close"),
    ("net: transposed", "net", CORNERS, CORNERS.transpose(1, 0, 2), "shape"),
    ("net: a row too many", "net", CORNERS, np.concatenate([CORNERS, CORNERS[:1]]), "shape"),
    ("net: rows in another order", "net", CORNERS, CORNERS[[2, 0, 3, 1]], "different"),
    ("net: one row off", "net", CORNERS, CORNERS + ONE, "different"),
    ("net: off by a factor", "net", CORNERS, 3 * CORNERS, "different"),
    ("net: not a number", "net", CORNERS, CORNERS * np.where(ONE == 1, np.nan, 1), "not finite"),
    ("basis: the same", "basis", np.array([0.25, 0.5, 0.25]), [0.25, 0.5, 0.25], "identical"),
    ("basis: backwards", "basis", np.array([0.1, 0.3, 0.6]), [0.6, 0.3, 0.1], "different"),
    ("basis: one too few", "basis", np.array([0.1, 0.3, 0.6]), [0.1, 0.9], "shape"),
    ("value: the same", "value", 0.04, np.array(0.04), "identical"),
    ("value: rounded", "value", 0.041234, 0.0412, "close"),
    ("value: twice", "value", 0.04, 0.08, "different"),
    ("value: a whole number off by one", "value", 48, 49, "different"),
    ("value: as a word", "value", 48, "48", "different"),
    ("value: nothing", "value", 0.04, None, "error"),
    ("value: a tuple, one element off", "value", (1.0, 2.0), (1.0, 3.0), "different"),
    ("word: the same", "label", "horn", "horn", "identical"),
    ("word: in capitals", "label", "horn", "Horn", "different"),
    ("word: another", "label", "horn", "ring", "different"),
    ("yes or no: the same", "label", True, np.True_, "identical"),
    ("yes or no: the other", "label", True, False, "different"),
]


def posed(kind, right):
    """An exercise whose right answer this is: a function of the parameters, or a value."""
    names = {"surface": "u, w", "curve": "u", "solid": "u, v, w", "field": "u, w", "mask": "u, w"}.get(kind, "a")
    space = {"right": right if names != "a" else lambda a: right}
    exec(f"def posed({names}):\n    'Return it.'\n    return right({names})", space)
    made = exercise(points=1, title="Something", kind=kind)(space["posed"])
    made.data(lambda rng: {} if names != "a" else {"a": 1.0})
    return made


def judged(kind, right, answer):
    """The verdict on a pair."""
    with np.errstate(all="ignore"):
        return judge(posed(kind, right), answer if callable(answer) else lambda a: answer)


@pytest.mark.parametrize(("right", "answer", "tier"), [pair[1:] for pair in PAIRS], ids=[pair[0] for pair in PAIRS])
def test_the_pair_is_placed(right, answer, tier):
    """Surfaces."""
    verdict = judged("surface", right, answer)
    assert verdict.tier == tier, verdict.message


@pytest.mark.parametrize(("kind", "right", "answer", "tier"), [pair[1:] for pair in OTHERS], ids=[pair[0] for pair in OTHERS])
def test_the_other_pair_is_placed(kind, right, answer, tier):
    """Whatever is no surface."""
    verdict = judged(kind, right, answer)
    assert verdict.tier == tier, verdict.message


if __name__ == "__main__":
    rows = [(name, "surface", right, answer, tier) for name, right, answer, tier in PAIRS] + OTHERS
    wrong = 0
    for name, kind, right, answer, tier in rows:
        found = judged(kind, right, answer).tier
        wrong += found != tier
        print(f"{name:50s} {tier:14s} {'' if found == tier else 'placed at ' + found}")
    print(f"{len(rows)} pairs, {len(rows) - wrong} placed as expected")
