"""Quadrics: the surfaces of degree two in x, y and z, written implicitly by ten coefficients.

    F(x, y, z) = A x² + B y² + C z² + D xy + E yz + F zx + G x + H y + J z + K = hᵀ Q h,    h = (x, y, z, 1)

The off-diagonal entries of the symmetric 4x4 matrix Q are *halves*: D/2, E/2, F/2, G/2, H/2, J/2. Mortenson (Geometric
Modeling, on quadric surfaces) prints the mixed terms as 2 D xy, so that his D is half of ours.

Which surface the ten numbers mean is read from Q = [[M, b], [bᵀ, c]] by rank and signs, never from the signs of A, B and C
alone: those change when the surface is turned.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from directrix import checks
from directrix.errors import DegenerateError, NumberError, ShapeError
from directrix.frozen import Frozen
from directrix.quadric.kinds import KINDS, Classification, classified
from directrix.transform import Transform

Array = NDArray[np.float64]

__all__ = ["KINDS", "Classification", "Quadric"]

ROUNDING = 1e-13  # coefficients are trusted to this fraction: some hundred units in the last place


class Quadric(Frozen):
    """The quadric A x² + B y² + C z² + D xy + E yz + F zx + G x + H y + J z + K = 0.

    Source: the lecture's list of implicit forms; Mortenson, Geometric Modeling, on quadric surfaces (whose D, E, F, G, H, J
    are half of these).

    Parameters
    ----------
    A, B, C, D, E, F, G, H, J, K : float
        Finite coefficients; only their ratios matter to the surface. There is no I.
    tolerance : float
        Relative accuracy to which the coefficients are known; `classify` takes less for zero. Rounding by default;
        `Quadric.through` puts in what its points allow.
    size : float
        Largest coordinate the caller means, in units of length; 0 if the coefficients themselves tell. See `classify`.

    Raises
    ------
    GeometryError
        If a coefficient is not finite.

    Examples
    --------
    >>> sphere = Quadric(1, 1, 1, 0, 0, 0, -2, 0, 0, -3)
    >>> sphere([3, 0, 0]), sphere([1, 0, 0])
    (0.0, -4.0)
    >>> sphere.gradient([3, 0, 0])
    array([4., 0., 0.])
    >>> sphere.classify()
    Classification('ellipsoid', center=[1. 0. 0.], radii=[2. 2. 2.])
    """

    A: float
    B: float
    C: float
    D: float
    E: float
    F: float
    G: float
    H: float
    J: float
    K: float
    tolerance: float
    size: float

    def __init__(
        self,
        A: float,
        B: float,
        C: float,
        D: float,
        E: float,
        F: float,
        G: float,
        H: float,
        J: float,
        K: float,
        *,
        tolerance: float = ROUNDING,
        size: float = 0.0,
    ) -> None:
        given = zip("ABCDEFGHJK", (A, B, C, D, E, F, G, H, J, K), strict=True)
        self._hold(**{name: checks.number(f"coefficient {name} of a quadric", value) for name, value in given})
        self._hold(tolerance=_fraction("tolerance", tolerance), size=checks.not_negative("size", size))

    def __repr__(self) -> str:
        return f"Quadric({', '.join(f'{value:g}' for value in self.coefficients)})"

    @classmethod
    def from_matrix(cls, matrix: ArrayLike, **known: float) -> Quadric:
        """The quadric hᵀ Q h = 0 of a 4x4 matrix Q, symmetric or not: only its symmetric part counts.

        Parameters
        ----------
        matrix : (4, 4) array_like
        known : tolerance and size, as for `Quadric`

        Raises
        ------
        GeometryError
            If the matrix is not 4x4.

        Examples
        --------
        >>> import numpy as np
        >>> Quadric.from_matrix(np.diag([1, 1, 0, -4]))
        Quadric(1, 1, 0, 0, 0, 0, 0, 0, 0, -4)
        """
        Q = _square(matrix)
        S = Q + Q.T
        half = np.diag(S) / 2
        A, B, C, K = half
        return cls(A, B, C, S[0, 1], S[1, 2], S[2, 0], S[0, 3], S[1, 3], S[2, 3], K, **known)

    @classmethod
    def through(cls, points: ArrayLike) -> Quadric:
        """The quadric through nine points in general position; the best one for more.

        Minimises Σ F(x_i)² / Σ |∇F(x_i)|², to first order the sum of squared distances, and does not change when the points
        are moved rigidly or scaled. Source: G. Taubin, IEEE Trans. PAMI 13 (1991) 1115-1138.

        Parameters
        ----------
        points : (n, 3) array_like, n >= 9
            Measured points; unit of length as you like.

        Returns
        -------
        Quadric
            With its `tolerance` set from the scatter of the points, so that a measured cylinder classifies as one.

        Raises
        ------
        GeometryError
            If there are fewer than 9 points or they lie on many quadrics at once (on a plane, a line, a conic, ...).

        Examples
        --------
        >>> x = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1], [.6, .8, 0], [0, .6, .8], [.8, 0, .6]]
        >>> Quadric.through(x).classify().kind
        'ellipsoid'
        """
        X = checks.points("points", points, least=9)
        mean = X.mean(axis=0)
        scale = float(np.sqrt(((X - mean) ** 2).sum(axis=1).mean()))
        if scale == 0:
            raise DegenerateError("Quadric.through needs points in general position; all points given are the same")
        terms, slopes = _monomials((X - mean) / scale)
        centred = terms - terms.mean(axis=0)
        # Written in a basis in which every quadric has mean squared gradient 1, the best one is the last singular vector.
        _, sizes, turn = np.linalg.svd(slopes.reshape(-1, 9) / np.sqrt(len(X)), full_matrices=False)
        rank_lost = sizes[-1] <= 1e-10 * sizes[0]
        _, misfit, choice = np.linalg.svd(centred @ (turn.T / np.where(rank_lost, 1.0, sizes)) / np.sqrt(len(X)))
        misfit = np.pad(misfit, (0, 9 - len(misfit)))
        if rank_lost or misfit[-2] <= 1e-9 * misfit[0]:
            raise DegenerateError(
                f"Quadric.through needs points that lie on one quadric only; the {len(X)} points given lie on many "
                "(on a plane, a line or a conic section): add points off it"
            )
        best = turn.T @ (choice[-1] / sizes)
        A, B, C, D, E, F, G, H, J = best
        standard = cls(A, B, C, D, E, F, G, H, J, -float(terms.mean(axis=0) @ best))
        move = np.eye(4)
        move[:3] = np.column_stack([np.eye(3), -mean]) / scale
        known = max(ROUNDING, 8 * misfit[-1] / misfit[-2], 64 * np.finfo(float).eps * misfit[0] / misfit[-2])
        Q = move.T @ standard.matrix @ move * scale**2
        return cls.from_matrix(Q, tolerance=float(known), size=float(np.abs(X).max()))

    @property
    def coefficients(self) -> Array:
        """The ten coefficients A ... K, shape (10,)."""
        return np.array([getattr(self, name) for name in "ABCDEFGHJK"])

    @property
    def matrix(self) -> Array:
        """The symmetric matrix Q of hᵀ Q h, shape (4, 4)."""
        A, B, C, D, E, F, G, H, J, K = self.coefficients
        return np.array([[2 * A, D, F, G], [D, 2 * B, E, H], [F, E, 2 * C, J], [G, H, J, 2 * K]]) / 2

    def __call__(self, points: ArrayLike) -> Any:
        """The value F at points of shape (..., 3): negative on one side of the surface, positive on the other, shape (...)."""
        x, y, z = np.moveaxis(_places(points), -1, 0)
        A, B, C, D, E, F, G, H, J, K = self.coefficients
        value = x * (A * x + D * y + G) + y * (B * y + E * z + H) + z * (C * z + F * x + J) + K
        return float(value) if value.ndim == 0 else value

    value = __call__

    def gradient(self, points: ArrayLike) -> Array:
        """The gradient (∂F/∂x, ∂F/∂y, ∂F/∂z) at points of shape (..., 3), shape (..., 3): normal to the surface on it."""
        X = _places(points)
        Q = self.matrix
        return 2 * (X @ Q[:3, :3] + Q[:3, 3])

    def classify(self, tolerance: float | None = None, *, size: float | None = None) -> Classification:
        """Kind, centre, axes and radii, read from rank and signature of Q and of its 3x3 block.

        In the frame (center; e1, e2, e3), with radii (a, b, c), the surface is

        ========================== ======================================================================
        ellipsoid                  x²/a² + y²/b² + z²/c² = 1, a >= b >= c
        hyperboloid of one sheet   x²/a² + y²/b² - z²/c² = 1, a >= b
        hyperboloid of two sheets  z²/c² - x²/a² - y²/b² = 1, a >= b
        cone                       x²/a² + y²/b² = z²/c², a >= b, c = 1: a, b are tangents of half angles
        elliptic paraboloid        x²/a + y²/b = 2z, a >= b: the radii of curvature at the vertex
        hyperbolic paraboloid      x²/a - y²/b = 2z, a >= b
        elliptic cylinder          x²/a² + y²/b² = 1, a >= b
        hyperbolic cylinder        x²/a² - y²/b² = 1
        parabolic cylinder         x²/a = 2z
        intersecting planes        x²/a² = y²/b², a = 1 >= b: e1 bisects the smaller angle
        parallel planes            x² = a²
        coincident planes          x² = 0, or the linear equation of one plane
        line                       the line through center along e3
        point                      the point center
        empty                      no real point: x² + y² + z² = -1, x² + y² = -1, x² = -1, or 0 = 1
        everything                 0 = 0
        ========================== ======================================================================

        Parameters
        ----------
        tolerance : float, optional
            Coefficients are trusted to this fraction of the largest they are computed with, compared at equal dimension
            (quadratic parts with quadratic, lengths with lengths), so that the answer does not depend on the unit of length.
            Default: the quadric's own, 1e-13 unless it was fitted.
        size : float, optional
            Largest coordinate that was in play, where it cannot be seen in the coefficients (a cylinder carried a long way
            along its own axis and back).

        Raises
        ------
        GeometryError
            If tolerance or size is negative.

        Examples
        --------
        >>> Quadric(1, 1, -1, 0, 0, 0, 0, 0, 0, -1).classify().kind
        'hyperboloid of one sheet'
        >>> Quadric(0, 0, 0, 2, 0, 0, 0, 0, -2, 0).classify()      # xy = z: a saddle turned by 45 degrees
        Classification('hyperbolic paraboloid', center=[0. 0. 0.], radii=[ 1.  1. inf])
        """
        tolerance = self.tolerance if tolerance is None else _fraction("tolerance", tolerance)
        size = self.size if size is None else checks.not_negative("size", size)
        return classified(self.matrix, tolerance, size)

    def moved(self, transform: Transform) -> Quadric:
        """The quadric carried by a transform T, as ``transform @ quadric``: Q' = T⁻ᵀ Q T⁻¹.

        Raises
        ------
        DegenerateError
            If T has no inverse.

        Examples
        --------
        >>> Transform.translate((2, 0, 0)) @ Quadric(1, 1, 0, 0, 0, 0, 0, 0, 0, -1)
        Quadric(1, 1, 0, 0, 0, 0, -4, 0, 0, 3)
        """
        back = transform.inverse().matrix
        reach = (
            float(np.abs(transform.linear).sum(axis=1).max() * self.size + np.abs(transform.offset).max()) if self.size else 0.0
        )
        return Quadric.from_matrix(back.T @ self.matrix @ back, tolerance=self.tolerance, size=reach)


def _square(matrix: ArrayLike) -> Array:
    given = checks.array("matrix", matrix)
    if given.shape != (4, 4):
        raise ShapeError(f"matrix must have shape (4, 4); got {given.shape}.", got=given.shape)
    return given


def _places(points: ArrayLike) -> Array:
    given = checks.array("points", points)
    if given.ndim == 0 or given.shape[-1] != 3:
        raise ShapeError(f"points must have shape (..., 3); got {given.shape}.", got=given.shape)
    return given


def _monomials(X: Array) -> tuple[Array, Array]:
    """x², y², z², xy, yz, zx, x, y, z at points (n, 3), shape (n, 9), and their gradients, shape (n, 3, 9)."""
    x, y, z = X.T
    one, nil = np.ones_like(x), np.zeros_like(x)
    terms = np.stack([x * x, y * y, z * z, x * y, y * z, z * x, x, y, z], axis=1)
    slopes = np.stack(
        [
            np.stack([2 * x, nil, nil, y, nil, z, one, nil, nil], axis=1),
            np.stack([nil, 2 * y, nil, x, z, nil, nil, one, nil], axis=1),
            np.stack([nil, nil, 2 * z, nil, y, x, nil, nil, one], axis=1),
        ],
        axis=1,
    )
    return terms, slopes


def _fraction(name: str, value: float) -> float:
    """A relative tolerance: at 1 everything would be zero."""
    given = checks.not_negative(name, value)
    if given >= 1:
        raise NumberError(
            f"{name} must be below 1, a fraction of the largest coefficient; got {given:g}.", name=name, got=given
        )
    return given
