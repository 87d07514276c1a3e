"""Solids: the tricubic Bezier hyperpatch of 64 points, and the nets of its six faces."""

from math import comb

import directrix as dx
import numpy as np

from autograder.exercise import exercise

SHAKEN = (
    "200002210001110022001121111102222001122020022000",
    "021101021002110011122011001202101221020221220210",
    "121121100220120011110120200202012210021022212112",
    "121220110000201210001102122200212220021101022201",
)


def lattice(size=(1.0, 1.0, 1.0)):
    """A regular net (4, 4, 4, 3): P[i, j, k] = (i, j, k), stretched."""
    return np.stack(np.meshgrid(*[np.arange(4.0)] * 3, indexing="ij"), axis=-1) * size


# The lecture data: a lattice with steps 3, 4 and 5, whose points were moved by -1, 0 or 1 each way, written here as 0, 1, 2.
LECTURE = lattice((3, 4, 5)) + np.reshape([int(digit) - 1 for digit in "".join(SHAKEN)], (4, 4, 4, 3))


def any_net(rng):
    """A random net: three different steps, the whole bent and shaken, so that the inner points count."""
    P = lattice(rng.uniform(1.5, 2.5, 3) + [0.0, 1.0, 2.0])
    P[..., 2] += rng.uniform(0.8, 1.2) * P[..., 0] * (P[..., 0].max() - P[..., 0])
    P[..., 0] += rng.uniform(0.3, 0.5) * P[..., 1] * (P[..., 1].max() - P[..., 1])
    return P + rng.uniform(-0.5, 0.5, P.shape)


def _bernstein(t):
    """The four cubic Bernstein functions, shape t.shape + (4,)."""
    t = np.asarray(t, dtype=float)
    return np.stack([comb(3, i) * t**i * (1 - t) ** (3 - i) for i in range(4)], axis=-1)


def _sum(u, v, w, P, functions=_bernstein):
    """Σ f_i(u) f_j(v) f_k(w) P_ijk for parameters that broadcast."""
    u, v, w = np.broadcast_arrays(u, v, w)
    return np.einsum("...i,...j,...k,ijkd->...d", functions(u), functions(v), functions(w), P)


# A8.4 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=6, title="Tricubic Bezier hyperpatch", kind="solid")
def hyperpatch(u, v, w, P):
    """Return the points of the solid that 64 control points make: the tricubic Bezier hyperpatch.

    u goes with the first axis of P, v with the second, w with the third: at u = v = w = 0 the point is P[0, 0, 0], at u = 1,
    v = w = 0 it is P[3, 0, 0].

    u, v, w : numbers or arrays in [0, 1] that broadcast against each other
    P : control points, an array of shape (4, 4, 4, 3)

    Returns the points, shape of u, v and w together + (3,).
    """
    return dx.BezierHyperpatch(P)(u, v, w)


@hyperpatch.data
def lecture(rng):
    return {"P": LECTURE}


@hyperpatch.data
def any_solid(rng):
    return {"P": any_net(rng)}


@hyperpatch.data(blind=True)
def regular_lattice(rng):
    return {"P": lattice()}


@hyperpatch.mistake("uw_exchanged", credit=0.5)
def _(u, v, w, P):
    """The right piece of solid, with u and w exchanged: your u runs along the third axis of P. Let u alone grow from 0 to 1: you
    should go from P[0, 0, 0] to P[3, 0, 0]. Where do you arrive?"""
    return _sum(w, v, u, P)


@hyperpatch.mistake("vw_exchanged", credit=0.5)
def _(u, v, w, P):
    """u is right, v and w have changed places. The signature says u, v, w, in the order of the axes of P; who comes from patches
    with u and w is easily misled. Let v alone grow: at which corner do you arrive?"""
    return _sum(u, w, v, P)


@hyperpatch.mistake("uv_exchanged", credit=0.5)
def _(u, v, w, P):
    """w is right, u and v have changed places. The first axis of P belongs to u, the second to v. Let u alone grow from 0 to 1:
    at which corner do you arrive, and at which should you?"""
    return _sum(v, u, w, P)


@hyperpatch.mistake("trilinear", credit=0.25)
def _(u, v, w, P):
    """You mixed the eight corners only; the other 56 points never enter. All corners are right and, on a regular lattice,
    everything is. Look at an edge of the solid: should it be straight?"""
    return _sum(u, v, w, P[::3, ::3, ::3], lambda t: np.stack([1 - np.asarray(t), t], axis=-1))


@hyperpatch.mistake("no_binomials", credit=0.5)
def _(u, v, w, P):
    """Your weights lack the binomial numbers 1, 3, 3, 1. The corners are right; but inside your weights no longer add up to 1,
    and the solid is drawn towards the origin. How much do they add up to at u = v = w = 1/2?"""
    return _sum(u, v, w, P, lambda t: _bernstein(t) / [1, 3, 3, 1])


@hyperpatch.mistake("reversed", credit=0.5)
def _(u, v, w, P):
    """The right solid, run from the far end: your parameters are 1 - u, 1 - v and 1 - w. Put 0 into your first Bernstein
    function: it belongs to P[0, 0, 0], and how much should it be there?"""
    return _sum(*(1 - np.asarray(t, dtype=float) for t in (u, v, w)), P)


@hyperpatch.mistake("first_layer", credit=0.25)
def _(u, v, w, P):
    """Your answer does not change with w: 16 of the 64 points enter, and what you have is one face, a patch in space. A solid
    needs a third sum. What should happen while w alone grows?"""
    return _sum(u, v, np.zeros_like(w, dtype=float), P)


@hyperpatch.mistake("through_all_points", credit=0.5)
def _(u, v, w, P):
    """Your solid passes through all 64 points: that is the point form of A5, with the parameters 0, 1/3, 2/3, 1. A Bezier form
    passes through its corners only; the others draw it towards themselves."""

    def lagrange(t):
        nodes, t = np.arange(4) / 3, np.asarray(t, dtype=float)
        others = [np.delete(nodes, i) for i in range(4)]
        return np.stack([np.prod((t[..., None] - o) / (x - o), axis=-1) for x, o in zip(nodes, others, strict=True)], axis=-1)

    return _sum(u, v, w, P, lagrange)


# A8.5 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=4, title="Six boundary surfaces of a solid", kind="net", accept={"close": 0.8})
def hyperpatch_faces(P):
    """Return the control nets of the six faces of a hyperpatch, in the order u = 0, u = 1, v = 0, v = 1, w = 0, w = 1.

    In each net the two remaining axes keep their order: the face v = 1 has u along its first axis and w along its second.

    P : control points of the solid, an array of shape (4, 4, 4, 3), axes u, v, w

    Returns an array of shape (6, 4, 4, 3).
    """
    return np.stack([face.control_net for face in dx.BezierHyperpatch(P).faces(outward=False)])


@hyperpatch_faces.data
def lecture(rng):
    return {"P": LECTURE}


@hyperpatch_faces.data
def any_solid(rng):
    return {"P": any_net(rng)}


def _faces(P):
    return [P[0], P[-1], P[:, 0], P[:, -1], P[:, :, 0], P[:, :, -1]]


@hyperpatch_faces.mistake("mid_slices", credit=0.5)
def _(P):
    """For the far faces you took the second layer of points. It lies inside the solid: along each axis there are four layers,
    and the boundary has the first and which other one?"""
    return np.stack([P[0], P[1], P[:, 0], P[:, 1], P[:, :, 0], P[:, :, 1]])


@hyperpatch_faces.mistake("all_slices_u", credit=0.25)
def _(P):
    """Your first four nets are the four layers of one axis; the two in the middle lie inside the solid. A cube has two faces
    across *each* of its three axes. Which of the faces are missing?"""
    return np.stack([*P, P[:, 0], P[:, -1]])


@hyperpatch_faces.also("all_slices_u")  # and two of the last axis
def _(P):
    return np.stack([*P, P[:, :, 0], P[:, :, -1]])


@hyperpatch_faces.mistake("transposed", credit=0.5)
def _(P):
    """You have the right six faces in the right order, each with its two parameters exchanged: rows and columns of your nets have
    changed places. The remaining axes should keep their order: on the face u = 0, v comes before w."""
    return np.stack([face.swapaxes(0, 1) for face in _faces(P)])


@hyperpatch_faces.mistake("near_far", credit=0.5)
def _(P):
    """All six faces are there, but near and far are exchanged in every pair: you give u = 1 where u = 0 is asked for. Which end
    of the axis has the index 0?"""
    return np.stack([_faces(P)[i] for i in (1, 0, 3, 2, 5, 4)])


@hyperpatch_faces.mistake("near_ones_first", credit=0.5)
def _(P):
    """The right six nets in another order: you list the three near faces and then the three far ones. The statement goes axis by
    axis: u = 0, u = 1, and then v."""
    return np.stack([_faces(P)[i] for i in (0, 2, 4, 1, 3, 5)])


@hyperpatch_faces.mistake("w_first", credit=0.5)
def _(P):
    """The right six nets, beginning with the last axis: your first pair is w = 0 and w = 1. Cutting P[0] off an array takes its
    *first* axis; which parameter belongs to that?"""
    return np.stack([_faces(P)[i] for i in (4, 5, 2, 3, 0, 1)])
