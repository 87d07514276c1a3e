"""Bernstein, Hermite and Lagrange functions: exact values, invariants, and numpy's polynomials as the oracle."""

from math import comb

import numpy as np
import pytest
from directrix.basis import bernstein, de_casteljau, hermite, lagrange, linear, monomials
from numpy.polynomial import Polynomial

T = np.arange(9) / 8


@pytest.mark.parametrize("degree", range(8))
def test_bernstein_values_against_polynomials(degree):
    """C(n, i) t^i (1 - t)^(n - i), expanded by numpy, with all derivatives up to two beyond the degree."""
    for derivative in range(degree + 3):
        mine = bernstein(degree, T, derivative)
        for i in range(degree + 1):
            oracle = comb(degree, i) * Polynomial([0, 1]) ** i * Polynomial([1, -1]) ** (degree - i)
            assert np.allclose(mine[:, i], oracle.deriv(derivative)(T) if derivative else oracle(T), atol=1e-9)


@pytest.mark.parametrize("degree", range(12))
def test_bernstein_functions_sum_to_one(degree):
    """Exactly on dyadic t, and their derivatives sum to 0."""
    assert (bernstein(degree, T).sum(axis=-1) == 1).all() or np.allclose(bernstein(degree, T).sum(axis=-1), 1, atol=1e-15)
    assert np.allclose(bernstein(degree, T, 1).sum(axis=-1), 0, atol=1e-12)


def test_bernstein_at_the_ends_is_exact():
    """0^0 = 1: no logarithm, no NaN."""
    assert bernstein(5, np.array(0.0)).tolist() == [1, 0, 0, 0, 0, 0]
    assert bernstein(5, np.array(1.0)).tolist() == [0, 0, 0, 0, 0, 1]
    assert bernstein(0, T).tolist() == [[1]] * 9


def test_the_course_numbers():
    """n = 3 at 0.1 and 0.2."""
    assert np.allclose(
        bernstein(3, np.array([0.1, 0.2])), [[0.729, 0.243, 0.027, 0.001], [0.512, 0.384, 0.096, 0.008]], atol=1e-15
    )


@pytest.mark.parametrize("degree", [1, 2, 5, 9])
def test_de_casteljau_is_the_bernstein_sum(degree):
    """The slow honest way and the fast one, and both halves are the same curve."""
    points = np.random.default_rng(degree).normal(size=(degree + 1, 3))
    for t in (0.0, 0.125, 0.7, 1.0):
        point, left, right = de_casteljau(points, t)
        assert np.allclose(point, bernstein(degree, np.array(t)) @ points, atol=1e-14)
        assert np.allclose(bernstein(degree, T) @ left, bernstein(degree, t * T) @ points, atol=1e-13)
        assert np.allclose(bernstein(degree, T) @ right, bernstein(degree, t + (1 - t) * T) @ points, atol=1e-13)


def test_hermite_functions_take_what_they_are_named_after():
    """(p(0), p(1), p'(0), p'(1)) of F_i are the unit vectors."""
    ends = np.array([0.0, 1.0])
    table = np.concatenate([hermite(ends), hermite(ends, 1)])
    assert table.tolist() == np.eye(4).tolist()


def test_hermite_functions_against_their_formulas():
    """As the lecture writes them; the third derivative is constant, the fourth 0."""
    t = T
    assert np.allclose(
        hermite(t), np.stack([2 * t**3 - 3 * t**2 + 1, -2 * t**3 + 3 * t**2, t**3 - 2 * t**2 + t, t**3 - t**2], -1), atol=1e-15
    )
    assert hermite(t, 3).tolist() == [[12, -12, 6, 6]] * 9
    assert not hermite(t, 4).any()


@pytest.mark.parametrize("nodes", [[0, 1], [0, 0.5, 1], [0, 0.2, 0.45, 0.7, 1], [0, 0.1, 0.15, 0.4, 0.6, 0.65, 1]])
def test_lagrange_interpolates_and_differentiates(nodes):
    """L_i(t_j) is exactly 0 or 1; polynomials are reproduced with all derivatives."""
    nodes = np.array(nodes)
    assert lagrange(nodes, nodes).tolist() == np.eye(len(nodes)).tolist()
    p = Polynomial(np.arange(1.0, len(nodes) + 1))
    for derivative in range(len(nodes) + 1):
        oracle = p.deriv(derivative)(T) if derivative else p(T)
        assert np.allclose(lagrange(nodes, T, derivative) @ p(nodes), oracle, rtol=1e-9, atol=1e-9 * 10**derivative)


def test_monomials_and_their_derivatives():
    """0^0 = 1; beyond the degree all is 0."""
    assert monomials(3, np.array([0.0, 2.0])).tolist() == [[1, 0, 0, 0], [1, 2, 4, 8]]
    assert monomials(3, np.array(2.0), 2).tolist() == [0, 0, 2, 12]
    assert monomials(2, np.array(2.0), 3).tolist() == [0, 0, 0]


def test_linear_meets_both_ends():
    """0.1 + (0.3 - 0.1) * 1 is not 0.3 in floats; the weighted mean is."""
    assert linear(np.array([0.0, 1.0]), 0.1, 0.3).tolist() == [0.1, 0.3]
    assert linear(np.zeros((4, 1)), np.zeros(3), np.ones(3), 1).tolist() == [[1, 1, 1]] * 4
    assert linear(np.zeros((4, 1)), np.zeros(3), np.ones(3), 2).tolist() == [[0, 0, 0]] * 4
