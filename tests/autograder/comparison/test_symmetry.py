import numpy as np
import pytest

from autograder.comparison.symmetry import symmetries

SURFACE = {
    "id": lambda u, w: (u, w),
    "flip_u": lambda u, w: (1 - u, w),
    "flip_w": lambda u, w: (u, 1 - w),
    "swap": lambda u, w: (w, u),
    "rot180": lambda u, w: (1 - u, 1 - w),
    "rot90": lambda u, w: (1 - w, u),
    "rot270": lambda u, w: (w, 1 - u),
    "antiswap": lambda u, w: (1 - w, 1 - u),
}
TURNS_THE_NORMAL = {"flip_u", "flip_w", "swap", "antiswap"}
POINTS = np.array([[0.25, 0.5], [0.0, 1.0], [0.75, 0.125]])


def test_a_surface_has_the_eight_of_the_square_by_name():
    assert {s.name for s in symmetries(("u", "w"))} == set(SURFACE)


@pytest.mark.parametrize("symmetry", symmetries(("u", "w")), ids=lambda s: s.name)
def test_each_does_what_its_name_says(symmetry):
    expected = np.array([SURFACE[symmetry.name](u, w) for u, w in POINTS])
    assert (symmetry(POINTS) == expected).all()
    assert (symmetry.determinant == -1) == (symmetry.name in TURNS_THE_NORMAL)


@pytest.mark.parametrize(("names", "count"), [(("u",), 2), (("u", "w"), 8), (("u", "v", "w"), 48)])
def test_there_are_two_to_the_n_times_n_factorial_of_them_the_identity_first(names, count):
    every = symmetries(names)
    assert len({s.name for s in every}) == len(every) == count
    assert every[0].name == "id"


@pytest.mark.parametrize("symmetry", symmetries(("u", "v", "w")), ids=lambda s: s.name)
def test_the_inverse_undoes_it_and_has_its_determinant(symmetry):
    points = np.random.default_rng(3).integers(0, 1025, size=(7, 3)) / 1024
    assert (symmetry.inverse(symmetry(points)) == points).all()
    assert symmetry.inverse.determinant == symmetry.determinant


def test_half_of_a_solids_keep_its_sense():
    assert sum(s.determinant for s in symmetries(("u", "v", "w"))) == 0
