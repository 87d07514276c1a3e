"""A right answer passes in any style, under any seed, for points, curves, solids, refusals and values."""

import math

import numpy as np
import pytest

from autograder.catalogue import shipped
from autograder.errors import CallFailed
from autograder.exercise import REFUSAL_CREDIT
from autograder.judge import judge

TURN = 2 * np.pi
SECRET = b"course secret, student, digest"


def stack(x, y, z):
    return np.stack(np.broadcast_arrays(x, y, z), axis=-1)


def right(u, w, r, h):
    return stack(r * np.cos(TURN * u), r * np.sin(TURN * u), h * w)


def by_lists(u, w, r, h):
    if np.ndim(u) == 0 and np.ndim(w) == 0:
        return [r * math.cos(TURN * u), r * math.sin(TURN * u), h * w]
    u, w = np.broadcast_arrays(u, w)
    return [by_lists(a, b, r, h) for a, b in zip(u, w, strict=True)] if u.size else np.zeros((*u.shape, 3))


def by_one_loop(u, w, r, h):
    u, w = np.broadcast_arrays(np.asarray(u, dtype=float), np.asarray(w, dtype=float))
    result = np.empty((*u.shape, 3))
    for i in np.ndindex(*u.shape):
        result[i] = r * math.cos(TURN * u[i]), r * math.sin(TURN * u[i]), h * w[i]
    return result


def by_complex_numbers(u, w, r, h):
    z = r * np.exp(2j * np.pi * np.asarray(u))
    return stack(z.real, z.imag, h * w)


def by_a_matrix(u, w, r, h):
    t = TURN * np.asarray(u)
    matrix = np.stack([np.stack([np.cos(t), -np.sin(t)], -1), np.stack([np.sin(t), np.cos(t)], -1)], -2)
    x, y = np.moveaxis(matrix @ np.array([r, 0.0]), -1, 0)
    return stack(x, y, h * w)


def by_vectorize(u, w, r, h):
    each = np.vectorize(lambda a, b: np.array([r * np.cos(TURN * a), r * np.sin(TURN * a), h * b]), signature="(),()->(k)")
    return each(u, w)


STYLES = [right, by_lists, by_one_loop, by_complex_numbers, by_a_matrix, by_vectorize]


class TestRight:
    @pytest.mark.parametrize("style", STYLES, ids=lambda f: f.__name__)
    def test_a_right_answer_in_any_style_passes_under_200_seeds(self, tube, style):
        for seed in range(200 if style is right else 40):
            verdict = judge(tube, style, seed=seed, figure=False)
            assert (verdict.outcome, verdict.fraction, verdict.tier) == ("passed", 1.0, "identical"), verdict.message

    def test_hidden_cases_tell_their_tier_and_nothing_else(self, tube):
        cases = [case for case in judge(tube, right, seed=SECRET).cases if case.hidden]
        assert [case.data for case in cases] == ["any_size", "hanging", "unit"]
        assert all((c.tier, c.deviation, c.where, c.yours, c.expected) == ("identical", None, None, None, None) for c in cases)

    def test_a_right_curve_and_a_right_solid_pass(self, helix, block):
        for posed in (helix, block):
            assert judge(posed, posed.reference, seed=SECRET).fraction == 1.0

    def test_where_the_reference_refuses_a_refusal_is_right(self, swept):
        assert judge(swept, swept.reference, seed=SECRET).fraction == 1.0

    def test_a_refusal_by_call_failed_counts_by_its_bases(self, swept):
        def call(u, w, curve, direction):
            if not np.any(direction):
                raise CallFailed("error", "no direction", exception="LengthError", bases=("LengthError", "ValueError"))
            return swept.reference(u, w, curve, direction)

        assert judge(swept, call).fraction == 1.0

    def test_an_answer_instead_of_a_refusal_is_named(self, swept):
        def call(u, w, curve, direction):
            return curve(u) + np.asarray(w)[..., None] * np.asarray(direction) / max(np.linalg.norm(direction), 1e-300)

        verdict = judge(swept, call)
        assert (verdict.fraction, verdict.outcome) == (REFUSAL_CREDIT, "partial")
        assert "must raise ValueError" in verdict.message
        assert [case.tier for case in verdict.cases] == ["identical", "different"]

    def test_another_exception_than_the_right_one_is_named(self, swept):
        def call(u, w, curve, direction):
            if not np.any(direction):
                raise ZeroDivisionError("by zero")
            return swept.reference(u, w, curve, direction)

        verdict = judge(swept, call)
        assert verdict.fraction == REFUSAL_CREDIT
        assert "ZeroDivisionError" in verdict.message

    def test_a_known_mistake_is_named_though_its_maker_refuses_nothing(self):
        """Who never divides by the length never meets a zero length: one slip must not hide the other."""
        sweep = shipped().find("linear_sweep")

        def call(u, w, curve, direction, d):
            u, w = np.broadcast_arrays(u, w)
            return curve(u) + d * w[..., None] * direction

        verdict = judge(sweep, call, seed=SECRET)
        assert (verdict.mistake, verdict.tier, verdict.fraction) == ("not_normalised", "mistake", 0.5 * REFUSAL_CREDIT)
        assert {case.tier for case in verdict.cases if case.data == "no_direction"} == {"different"}

    def test_a_wrong_answer_with_a_missing_refusal_is_told_both(self, swept):
        def call(u, w, curve, direction):
            return curve(1 - u) + np.asarray(w)[..., None] * np.asarray(direction) / max(np.linalg.norm(direction), 1e-300)

        verdict = judge(swept, call)
        assert (verdict.tier, verdict.fraction) == ("relabelled", 0.5 * REFUSAL_CREDIT)
        assert "u runs backwards" in verdict.message
        assert "Besides, there is no answer on the data set nowhere" in verdict.message

    def test_refusing_everything_is_worth_nothing(self):
        def call(*args):
            raise ValueError("no")

        assert judge(shipped().find("linear_sweep"), call, seed=SECRET).fraction == 0.0
