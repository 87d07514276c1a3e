"""The patch of each quadric lies on it, reaches as far as it should, and is exact as NURBS too."""

import directrix as dx
import numpy as np
import pytest
from directrix.errors import ConversionError, NumberError

U, W = np.linspace(0, 1, 17)[:, None], np.linspace(0, 1, 16)[None]
SURFACES = {
    "ellipsoid": (1 / 9, 1 / 4, 1, 0, 0, 0, 0, 0, 0, -1),
    "hyperboloid of one sheet": (1 / 9, 1 / 4, -1, 0, 0, 0, 0, 0, 0, -1),
    "hyperboloid of two sheets": (1 / 9, 1 / 4, -1, 0, 0, 0, 0, 0, 0, 1),
    "cone": (1 / 9, 1 / 4, -1, 0, 0, 0, 0, 0, 0, 0),
    "elliptic paraboloid": (1 / 3, 1 / 2, 0, 0, 0, 0, 0, 0, -2, 0),
    "hyperbolic paraboloid": (1 / 3, -1 / 2, 0, 0, 0, 0, 0, 0, -2, 0),
    "elliptic cylinder": (1 / 9, 1 / 4, 0, 0, 0, 0, 0, 0, 0, -1),
    "hyperbolic cylinder": (1 / 9, -1 / 4, 0, 0, 0, 0, 0, 0, 0, -1),
    "parabolic cylinder": (1 / 3, 0, 0, 0, 0, 0, 0, 0, -2, 0),
    "intersecting planes": (1, -4, 0, 0, 0, 0, 0, 0, 0, 0),
    "parallel planes": (1, 0, 0, 0, 0, 0, 0, 0, 0, -4),
    "coincident planes": (0, 0, 0, 0, 0, 0, 1, 2, 2, -9),
}
TWO = {"hyperboloid of two sheets", "cone", "hyperbolic cylinder", "intersecting planes", "parallel planes"}


@pytest.mark.parametrize("kind", SURFACES)
@pytest.mark.parametrize("extent", [None, 0.7, 20.0])
def test_patches_lie_on_their_quadric(kind, extent):
    """Moved and turned anywhere, F = 0 at all points of all sheets, and of their NURBS; two sheets where there are two."""
    quadric = dx.Transform.rotate((1, 2, 3), 0.8, (1, 0, 2)) @ dx.Quadric(*SURFACES[kind])
    assert quadric.classify().kind == kind
    patches = dx.quadric_patches(quadric, extent)
    assert len(patches) == (2 if kind in TWO else 1)
    for patch in patches:
        for surface in (patch, dx.to_nurbs(patch)):
            points = surface(U, W)
            assert np.abs(quadric(points)).max() < 1e-11 * (1 + np.abs(points).max()) ** 2
            assert patch.area() > 0
    if len(patches) == 2:
        assert np.abs(patches[0](U, W) - patches[1](U, W)).max() > 1e-3


@pytest.mark.parametrize(
    "kind", ["elliptic cylinder", "cone", "elliptic paraboloid", "hyperboloid of one sheet", "parallel planes"]
)
def test_extent_is_how_far_it_reaches(kind):
    """Along its axis an unbounded patch ends at the extent."""
    points = np.concatenate([p(U, W).reshape(-1, 3) for p in dx.quadric_patches(dx.Quadric(*SURFACES[kind]), 5.0)])
    assert points[:, 2].max() == pytest.approx(5)


@pytest.mark.parametrize(
    ("coefficients", "what"),
    [
        ((1, 1, 1, 0, 0, 0, 0, 0, 0, 1), "is empty"),
        ((0, 0, 0, 0, 0, 0, 0, 0, 0, 0), "is everything"),
        ((1, 1, 0, 0, 0, 0, 0, 0, 0, 0), "is a line"),
        ((1, 1, 1, 0, 0, 0, 0, 0, 0, 0), "is a point"),
    ],
)
def test_what_is_no_surface_is_refused(coefficients, what):
    with pytest.raises(ConversionError, match=what):
        dx.quadric_patches(dx.Quadric(*coefficients))
    with pytest.raises(NumberError, match="extent must be greater than 0"):
        dx.quadric_patches(dx.Quadric(*SURFACES["cone"]), 0)
