"""Surfaces to draw, written out: the pictures are tested without the library's own forms."""

import numpy as np
import pytest


def points_of(*coordinates):
    return np.stack(np.broadcast_arrays(*coordinates), axis=-1)


@pytest.fixture
def saddle():
    """(u, w, u w): exact in binary at dyadic parameters, and not symmetric under an exchange of u and 1 - u."""
    return lambda u, w: points_of(u, w, u * w)


@pytest.fixture
def tube():
    """A cylinder of radius 2 and height 5, closed in u."""
    return lambda u, w: points_of(2 * np.cos(2 * np.pi * u), 2 * np.sin(2 * np.pi * u), 5 * w)
