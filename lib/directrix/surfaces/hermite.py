"""The geometric form: the bicubic Hermite patch, by corners, tangents and twists; the Ferguson patch among them."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from directrix import checks
from directrix.basis import hermite
from directrix.checks import Array
from directrix.errors import ShapeError
from directrix.surfaces.tensor import TensorPatch, window
from directrix.transform import Transform

TWISTS = ("zero", "coons", "adini")


class HermitePatch(TensorPatch):
    """The bicubic patch S(u, w) = F(u) G F(w)ᵀ of four corners, eight tangents and four twists.

    F = (F1, F2, F3, F4) blend p(0), p(1), p'(0), p'(1), and

        G = [[p00,  p01,  pw00,  pw01 ],
             [p10,  p11,  pw10,  pw11 ],
             [pu00, pu01, puw00, puw01],
             [pu10, pu11, puw10, puw11]]

    in Mortenson's order (Geometric Modeling, 3rd ed.), first index u: p01 is the corner u = 0, w = 1; pu, pw are
    derivatives by u and w; the twist puw is the mixed derivative. In his words S = U M_F G M_Fᵀ Wᵀ with U = (u³ u² u 1). The
    twists do not move the boundary curves. Derivatives to any order; those above the third are 0.

    Parameters
    ----------
    G : (4, 4, 3), in any one unit of length

    Raises
    ------
    ShapeError
        If G is not of shape (4, 4, 3).
    NumberError
        If a number in it is not finite.

    Examples
    --------
    >>> G = np.zeros((4, 4, 3))
    >>> G[1:, :2] = [[(1, 0, 0), (1, 4, 0)], [(1, 0, 0), (1, 0, 0)], [(1, 0, 0), (1, 0, 0)]]
    >>> G[:2, 1:] = [[(0, 4, 0), (0, 4, 0), (0, 4, 0)], [(1, 4, 0), (0, 4, 0), (0, 4, 0)]]
    >>> G[2, 2] = 0, 0, 64                       # a twist at the corner (0, 0)
    >>> patch = HermitePatch(G)
    >>> patch(0.5, 0.25)                         # F3(1/2) F3(1/4) 64 = 1/8 9/64 64
    array([0.5  , 1.   , 1.125])
    >>> patch.derivative(0, 0, 1, 1)
    array([ 0.,  0., 64.])
    """

    G: Array

    def __init__(self, G: ArrayLike) -> None:
        given = checks.array("G", G)
        if given.shape != (4, 4, 3):
            raise ShapeError(
                f"G must have shape (4, 4, 3), rows (p, p, pu, pu) by columns (p, p, pw, pw); got {given.shape}. From corners "
                "and tangents: HermitePatch.of(p, pu, pw, twists).",
                got=given.shape,
            )
        self._hold(G=given)

    @staticmethod
    def of(p: ArrayLike, pu: ArrayLike, pw: ArrayLike, twists: ArrayLike | str = "zero") -> HermitePatch:
        """The patch of corner blocks, each indexed [u corner, w corner].

        Parameters
        ----------
        p, pu, pw : (2, 2, 3)
            Corners, derivatives by u, derivatives by w.
        twists : (2, 2, 3), ``zero``, ``coons`` or ``adini``
            Given twists, or a rule: ``zero`` makes a Ferguson patch; ``coons`` those with which the patch is the bilinearly
            blended Coons patch of its own edges, see `coons_twists`. Adini's rule takes the Coons patch of the edges around the
            corner, and for a single patch these are the same edges, so ``adini`` is another name for ``coons``.

        Raises
        ------
        ShapeError, NumberError
            If a block is not (2, 2, 3), or the rule is unknown.

        Examples
        --------
        >>> p = [[(0, 0, 0), (0, 1, 0)], [(1, 0, 0), (1, 1, 1)]]
        >>> along_u, along_w = [[(1, 0, 0)] * 2] * 2, [[(0, 1, 0)] * 2] * 2
        >>> HermitePatch.of(p, along_u, along_w, "coons").twists[0, 0]
        array([ 0.,  0., -1.])
        """
        p, pu, pw = (_corner_block(name, block) for name, block in (("p", p), ("pu", pu), ("pw", pw)))
        if isinstance(twists, str):
            checks.choice("twists", twists, TWISTS, hint="Or give the four vectors, shape (2, 2, 3).")
            puw = np.zeros((2, 2, 3)) if twists == "zero" else coons_twists(assembled(p, pu, pw, np.zeros((2, 2, 3))))
        else:
            puw = _corner_block("twists", twists)
        return HermitePatch(assembled(p, pu, pw, puw))

    @property
    def corners(self) -> Array:
        """p, indexed [u corner, w corner], shape (2, 2, 3)."""
        return self.G[:2, :2]

    @property
    def tangents_u(self) -> Array:
        """pu, the derivatives by u at the corners, shape (2, 2, 3)."""
        return self.G[2:, :2]

    @property
    def tangents_w(self) -> Array:
        """pw, the derivatives by w at the corners, shape (2, 2, 3)."""
        return self.G[:2, 2:]

    @property
    def twists(self) -> Array:
        """puw, the mixed derivatives at the corners, shape (2, 2, 3)."""
        return self.G[2:, 2:]

    def _net(self) -> Array:
        return self.G

    def _functions_u(self, u: Array, order: int) -> Array:
        return hermite(u, order)

    def _functions_w(self, w: Array, order: int) -> Array:
        return hermite(w, order)

    def moved(self, transform: Transform) -> HermitePatch:
        """The patch under an affine map: corners move as points, tangents and twists as vectors."""
        G = transform.vectors(self.G)
        G[:2, :2] += transform.offset
        return HermitePatch(G)

    def patch(self, u0: float, u1: float, w0: float, w1: float) -> HermitePatch:
        """The part from (u0, w0) to (u1, w1) as a Hermite patch of its own: its corner data, by the chain rule."""
        u0, u1, w0, w1 = window(u0, u1, w0, w1)
        u, w, long_u, long_w = np.array([u0, u1]), np.array([w0, w1]), u1 - u0, w1 - w0
        p, pu, pw, puw = (np.array(block) for block in self._mesh(u, w, ((0, 0), (1, 0), (0, 1), (1, 1))))
        return HermitePatch(assembled(p, long_u * pu, long_w * pw, long_u * long_w * puw))

    def swap(self) -> HermitePatch:
        """The same surface with u and w exchanged: G transposed."""
        return HermitePatch(self.G.swapaxes(0, 1))


class Ferguson(HermitePatch):
    """The Ferguson patch: the bicubic Hermite patch of four corners and eight tangents, with zero twists.

    It equals the cubically blended Coons patch of its own four edges. Zero twists flatten the corners: the net of its Bezier
    form is a parallelogram there (J. C. Ferguson, Multivariable curve interpolation, J. ACM 11 (1964) 221-228; Farin, Curves
    and Surfaces for CAGD, 5th ed., on twists).

    Parameters
    ----------
    p, pu, pw : (2, 2, 3), indexed [u corner, w corner]
        Corners, derivatives by u, derivatives by w, in any one unit of length.

    Raises
    ------
    ShapeError
        If a block is not of shape (2, 2, 3).

    Examples
    --------
    >>> p = [[(0, 0, 0), (0, 1, 0)], [(1, 0, 0), (1, 1, 0)]]
    >>> bump = Ferguson(p, [[(1, 0, 8)] * 2, [(1, 0, -8)] * 2], [[(0, 1, 0)] * 2] * 2)
    >>> bump(0.5, 0.5)
    array([0.5, 0.5, 2. ])
    >>> bump.derivative(1, 0, 1, 1)
    array([0., 0., 0.])
    """

    def __init__(self, p: ArrayLike, pu: ArrayLike, pw: ArrayLike) -> None:
        corners, tangents_u, tangents_w = (_corner_block(name, block) for name, block in (("p", p), ("pu", pu), ("pw", pw)))
        super().__init__(assembled(corners, tangents_u, tangents_w, np.zeros((2, 2, 3))))

    def moved(self, transform: Transform) -> Ferguson:
        """The Ferguson patch under an affine map."""
        return Ferguson(transform.points(self.corners), transform.vectors(self.tangents_u), transform.vectors(self.tangents_w))

    def swap(self) -> Ferguson:
        """The same surface with u and w exchanged."""
        return Ferguson(*(block.swapaxes(0, 1) for block in (self.corners, self.tangents_w, self.tangents_u)))


def assembled(p: Array, pu: Array, pw: Array, puw: Array) -> Array:
    """G (4, 4, 3) from its four blocks (2, 2, 3)."""
    return np.concatenate([np.concatenate([p, pw], axis=1), np.concatenate([pu, puw], axis=1)])


def coons_twists(G: ArrayLike) -> Array:
    """The twists with which a Hermite patch equals the bilinearly blended Coons patch of its four edges.

    t_ij = (pw_1j - pw_0j) + (pu_i1 - pu_i0) - (p11 - p10 - p01 + p00), Adini's twists of a single patch
    (Farin, Curves and Surfaces for CAGD, 5th ed., on twists). They vanish for a translational surface.

    Parameters
    ----------
    G : (4, 4, 3) as `HermitePatch`; its twist block is ignored

    Returns
    -------
    (2, 2, 3), indexed [u corner, w corner]

    Raises
    ------
    ShapeError
        If G is not of shape (4, 4, 3).

    Examples
    --------
    >>> G = np.zeros((4, 4, 3))
    >>> G[1, 1] = 0, 0, 1                        # one corner lifted, all tangents 0
    >>> coons_twists(G)[0, 1]
    array([ 0.,  0., -1.])
    """
    G = HermitePatch(G).G
    p, pu, pw = G[:2, :2], G[2:, :2], G[:2, 2:]
    return np.asarray((pw[1] - pw[0])[None] + (pu[:, 1] - pu[:, 0])[:, None] - (p[1, 1] - p[1, 0] - p[0, 1] + p[0, 0]))


def _corner_block(name: str, block: ArrayLike) -> Array:
    given = checks.array(name, block)
    if given.shape != (2, 2, 3):
        hint = " Use .reshape(2, 2, 3), first index u." if given.size == 12 else ""
        raise ShapeError(
            f"{name} must have shape (2, 2, 3), indexed [u corner, w corner]; got {given.shape}.{hint}",
            name=name,
            got=given.shape,
        )
    return given
