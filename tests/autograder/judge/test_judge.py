"""What the judge promises: gates, credits, hidden data, recognised mistakes, and the same verdict every time."""

import json
import math

import numpy as np
import pytest

from autograder.catalogue import shipped
from autograder.errors import CallFailed, SandboxError
from autograder.exercise import REFUSAL_CREDIT, exercise
from autograder.judge import judge
from autograder.result import Verdict

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


class TestShapes:
    def test_a_function_without_open_meshes_keeps_the_credit_for_the_rest(self, tube):
        verdict = judge(tube, lambda u, w, r, h: np.stack([r * np.cos(TURN * u), r * np.sin(TURN * u), h * w], axis=-1))
        assert (verdict.tier, verdict.fraction, verdict.outcome) == ("shape", tube.shape_credit, "partial")
        assert "(9, 1) and (1, 7)" in verdict.message

    def test_a_function_of_single_numbers_keeps_the_credit_for_these(self, tube):
        verdict = judge(tube, lambda u, w, r, h: [r * math.cos(TURN * u), r * math.sin(TURN * u), h * w])
        assert (verdict.tier, verdict.fraction) == ("shape", tube.shape_credit)
        assert "single numbers only" in verdict.message

    def test_a_mistake_under_a_wrong_shape_is_named_too(self, tube):
        def call(u, w, r, h):
            return np.stack([r / 2 * np.cos(TURN * u), r / 2 * np.sin(TURN * u), h * w], axis=-1)

        verdict = judge(tube, call)
        assert (verdict.mistake, verdict.fraction) == ("diameter", 0.5 * tube.shape_credit)
        assert "(9, 1) and (1, 7)" in verdict.message

    def test_wrong_for_single_numbers_is_not_excused_by_the_shape(self, tube):
        verdict = judge(tube, lambda u, w, r, h: [r * math.cos(u), r * math.sin(3 * u), h * w])
        assert verdict.fraction == 0.0

    def test_coordinates_on_the_first_axis(self, tube):
        verdict = judge(
            tube, lambda u, w, r, h: np.array(np.broadcast_arrays(r * np.cos(TURN * u), r * np.sin(TURN * u), h * w))
        )
        assert verdict.tier == "shape"
        assert "coordinates last" in verdict.message

    def test_a_mesh_made_inside(self, tube):
        verdict = judge(tube, lambda u, w, r, h: right(*np.meshgrid(u, w), r, h))
        assert (verdict.tier, verdict.fraction) == ("shape", 0.0)
        assert "a mesh of all pairs" in verdict.message

    def test_empty_arrays_are_a_remark_and_no_loss(self, tube):
        def call(u, w, r, h):
            if np.size(u) == 0:
                raise IndexError("nothing there")
            return right(u, w, r, h)

        verdict = judge(tube, call)
        assert verdict.fraction == 1.0
        assert "A remark, no marks lost" in verdict.message

    @pytest.mark.parametrize("convert", [np.float32, list, lambda a: a.tolist(), lambda a: a.astype(object)])
    def test_what_asarray_takes_is_an_answer(self, tube, convert):
        assert judge(tube, lambda *a: convert(np.round(right(*a), 12))).tier in ("identical", "close")

    def test_whole_numbers_are_an_answer(self):
        @exercise(points=1, title="Flat", kind="surface")
        def flat(u, w):
            """Return the origin."""
            return np.zeros((*np.broadcast_shapes(np.shape(u), np.shape(w)), 3))

        flat.data(lambda rng: {})
        assert (
            judge(flat, lambda u, w: np.zeros((*np.broadcast_shapes(np.shape(u), np.shape(w)), 3), dtype=int)).fraction == 1.0
        )


class TestGates:
    def message(self, posed, call, tier, *, fraction=0.0):
        verdict = judge(posed, call, seed=SECRET)
        assert (verdict.tier, verdict.fraction) == (tier, fraction), verdict.message
        return verdict.message

    def test_a_forgotten_return(self, tube):
        assert "returned nothing" in self.message(tube, lambda *a: None, "error")

    def test_complex_numbers(self, tube):
        assert "complex" in self.message(tube, lambda *a: right(*a) + 0j, "error")

    def test_text(self, tube):
        assert "returned text" in self.message(tube, lambda *a: "done", "error")
        assert "returned text" in self.message(tube, lambda *a: np.array(["1.0", "2.0"]), "error")

    def test_a_function_instead_of_its_value(self, tube):
        assert "brackets" in self.message(tube, lambda *a: right, "error")

    def test_coordinates_of_different_shapes(self, tube):
        message = judge(tube, lambda u, w, r, h: [np.cos(u), np.sin(u), h]).message
        assert "different shapes (x of shape (167,), y of shape (167,), z of shape ())" in message
        assert "np.broadcast_arrays" in message

    def test_an_object(self, tube):
        assert "Thing" in self.message(tube, lambda *a: type("Thing", (), {})(), "error")

    def test_writing_into_the_arguments(self, tube):
        def call(u, w, r, h):
            u *= TURN
            return stack(r * np.cos(u), r * np.sin(u), h * w)

        assert "writes into the arrays" in judge(tube, call).message

    def test_writing_into_the_arguments_under_a_single_form(self, tube):
        def call(u, w, r, h):
            u = np.asarray(u)
            u[...] = 0
            return right(u, w, r, h)

        assert "writes into the arrays" in judge(tube, call).message

    def test_not_a_number_at_an_edge_names_the_edge(self, tube):
        message = self.message(tube, lambda u, w, r, h: right(u, w, r, h) * np.asarray(w / w)[..., None], "not finite")
        assert "on edges, such as u = 0, w = 0" in message

    @pytest.mark.parametrize("size", [1e155, 1e300])
    def test_numbers_whose_squares_overflow_are_the_learners_not_the_judges(self, tube, size):
        self.message(tube, lambda u, w, r, h: right(u, w, r, h) * 0 + size * np.array([1, -1, 1]), "not finite")

    def test_not_a_number_at_a_corner_names_the_corner(self, tube):
        def call(u, w, r, h):
            u, w = np.broadcast_arrays(np.asarray(u, dtype=float), w)
            return np.where(((u == 1) & (w == 1))[..., None], np.inf, right(u, w, r, h))

        assert "corner u = 1, w = 1" in self.message(tube, call, "not finite")

    def test_dividing_by_the_largest_parameter_is_not_pointwise(self, tube):
        self.message(tube, lambda u, w, r, h: right(u / (np.max(u) + 1e-300), w, r, h), "not pointwise")

    def test_own_parameters_are_not_pointwise(self, tube):
        grid = np.meshgrid(np.linspace(0, 1, 20), np.linspace(0, 1, 11))
        assert "always returns shape (11, 20, 3)" in self.message(tube, lambda u, w, r, h: right(*grid, r, h), "not pointwise")

    def test_a_mesh_that_differs_from_its_points_is_not_pointwise(self, tube):
        def call(u, w, r, h):
            factor = 2 if np.ndim(u) == 2 else 1
            return right(u, w, factor * r, h)

        assert "mesh" in self.message(tube, call, "not pointwise")

    def test_random_numbers_are_not_repeatable(self, tube):
        rng = np.random.default_rng(1)
        assert "two different answers" in self.message(tube, lambda *a: right(*a) + rng.uniform(), "not repeatable")

    def test_a_list_that_grows_is_not_repeatable(self, tube):
        seen = []

        def call(u, w, r, h):
            seen.append(np.size(u))
            return right(u, w, r, h * len(seen))

        self.message(tube, call, "not repeatable")

    def test_a_wrong_signature_shows_the_right_one(self, tube):
        assert "def tube(u, w, r, h):" in self.message(tube, lambda u, w: u, "error")

    def test_an_undefined_name(self, tube):
        def call(u, w, r, h):
            return radius  # noqa: F821

        assert "'radius' is not defined" in self.message(tube, call, "error")

    def test_endless_recursion(self, tube):
        def call(u, w, r, h):
            return call(u, w, r, h)

        assert "calls itself without end" in self.message(tube, call, "error")

    def test_leaving_the_program(self, tube):
        def call(u, w, r, h):
            raise SystemExit

        assert "where it should return" in self.message(tube, call, "error")

    @pytest.mark.parametrize(
        ("kind", "tier", "word"),
        [
            ("timeout", "timeout", "too long"),
            ("memory", "error", "memory"),
            ("died", "error", "ended"),
            ("refused", "error", "taken"),
        ],
    )
    def test_the_limits_of_the_sandbox_have_their_own_words(self, tube, kind, tier, word):
        def call(*arguments):
            raise CallFailed(kind, "over the limit")

        assert word in self.message(tube, call, tier)

    def test_after_a_limit_nothing_more_is_asked(self, tube):
        calls = []

        def call(*arguments):
            calls.append(arguments)
            raise CallFailed("timeout", "2 s")

        judge(tube, call, seed=SECRET)
        assert len(calls) == 1

    def test_the_line_of_the_learner_is_told(self, tube):
        def call(*arguments):
            raise CallFailed("error", "boom", exception="KeyError", line=3, source="    return table[u]")

        assert "Line 3: return table[u]" in judge(tube, call).message

    def test_an_error_on_one_data_set_only(self, tube):
        def call(u, w, r, h):
            if h < 0:
                raise RuntimeError("a height must be positive")
            return right(u, w, r, h)

        verdict = judge(tube, call)
        assert (verdict.tier, verdict.fraction) == ("error", 0.25)  # one of two data sets that count, and half of that
        assert "Right on the data set any_size" in verdict.message
        assert "hanging" in verdict.part("where")


class TestNotRun:
    def test_the_stub(self, tube):
        def stub(*arguments):
            raise NotImplementedError("write me")

        verdict = judge(tube, stub, seed=SECRET)
        assert (verdict.outcome, verdict.tier, verdict.fraction) == ("not run", "error", 0.0)
        assert "tube is not written yet" in verdict.message

    def test_the_stub_is_not_a_refusal(self, swept):
        def stub(*arguments):
            raise NotImplementedError

        assert judge(swept, stub).outcome == "not run"

    def test_a_missing_function(self, tube):
        def call(*arguments):
            raise CallFailed("missing", "no function tube")

        verdict = judge(tube, call)
        assert verdict.outcome == "not run"
        assert "no function tube" in verdict.message

    def test_not_implemented_for_one_data_set_is_an_error(self, tube):
        def call(u, w, r, h):
            if h < 0:
                raise NotImplementedError("negative")
            return right(u, w, r, h)

        assert (judge(tube, call).outcome, judge(tube, call).tier) == ("partial", "error")


class TestCouldNotJudge:
    def test_a_sandbox_that_fails(self, tube):
        def call(*arguments):
            raise SandboxError("the pipe broke")

        verdict = judge(tube, call)
        assert (verdict.outcome, verdict.fraction) == ("could not judge", 0.0)
        assert "not your fault" in verdict.message

    def test_a_reference_that_fails(self):
        @exercise(points=1, title="Broken", kind="surface")
        def broken(u, w, r):
            """Return something."""
            return undefined  # noqa: F821

        broken.data(lambda rng: {"r": 1.0})
        assert judge(broken, right).outcome == "could not judge"

    def test_a_mistake_that_fails_costs_no_right_answer_anything(self, tube):
        @tube.mistake("broken")
        def _(u, w, r, h):
            """Never seen."""
            raise RuntimeError("ours")

        assert judge(tube, right).outcome == "passed"
        assert judge(tube, lambda *a: 2 * right(*a)).outcome == "could not judge"

    def test_data_that_cannot_be_drawn(self, tube):
        @tube.data
        def impossible(rng):
            raise KeyError("no such file")

        assert judge(tube, right).outcome == "could not judge"


class TestMistakes:
    @pytest.mark.parametrize("name", ["diameter", "no_height", "swap_uw"])
    @pytest.mark.parametrize("seed", [0, SECRET])
    def test_a_mistake_is_named_with_its_hint(self, tube, name, seed):
        known = next(m for m in tube.mistakes if m.id == name)
        verdict = judge(tube, known.formula, seed=seed)
        assert (verdict.tier, verdict.mistake) == ("mistake", name)
        assert known.hint in verdict.part("look")
        assert verdict.fraction == (0.5 if known.credit is None else known.credit)

    def test_data_that_cannot_see_it_are_named(self, tube):
        verdict = judge(tube, tube.mistakes[1].formula)
        assert "Right on the data set unit, which cannot see this mistake" in verdict.part("right")
        assert [case.tier for case in verdict.cases] == ["mistake", "mistake", "identical"]

    def test_a_mistake_on_the_public_data_only_is_not_that_mistake(self, tube):
        public = {float(d.arguments["h"]) for d in tube.draw()}

        def call(u, w, r, h):
            return tube.mistakes[0].formula(u, w, r, h) if h in public else right(u, w, r, h)

        verdict = judge(tube, call, seed=SECRET)
        assert verdict.mistake is None
        assert verdict.fraction == 0.0

    def test_right_on_the_public_data_only_earns_nothing_and_tells_no_hidden_value(self, tube):
        public = {float(d.arguments["h"]) for d in tube.draw()}

        def call(u, w, r, h):
            return right(u, w, r if h in public else 1.1 * r, h)

        verdict = judge(tube, call, seed=SECRET)
        assert verdict.fraction == 0.0
        assert "Right on all the data shown here" in verdict.message
        hidden = {f"{float(d.arguments['r']):.4g}" for d in tube.draw(SECRET) if not d.blind}
        assert not any(number in verdict.to_json() for number in hidden)

    def test_a_mistake_with_a_rounded_constant(self, tube):
        def call(u, w, r, h):
            return stack(r / 2 * np.cos(6.28 * u), r / 2 * np.sin(6.28 * u), h * w)

        verdict = judge(tube, call)
        assert (verdict.mistake, verdict.fraction) == ("diameter", 0.5)
        assert "rounded constant" in verdict.message

    def test_a_mistake_and_a_relabelling(self, tube):
        verdict = judge(tube, lambda u, w, r, h: tube.mistakes[0].formula(1 - u, w, r, h))
        assert (verdict.mistake, verdict.fraction) == ("diameter", 0.25)
        assert "u runs backwards" in verdict.message

    def test_two_mistakes_at_once(self, tube):
        verdict = judge(tube, lambda u, w, r, h: stack(r / 2 * np.cos(TURN * u), r / 2 * np.sin(TURN * u), w))
        assert (verdict.mistake, verdict.fraction) == ("diameter", 0.125)
        assert "no height" in verdict.message

    def test_two_mistakes_are_not_found_where_another_coordinate_is_off(self, tube):
        verdict = judge(tube, lambda u, w, r, h: stack(r / 2 * np.cos(TURN * u), r * np.sin(TURN * u), w))
        assert verdict.mistake is None


class TestCredit:
    def test_a_tier_that_the_exercise_accepts(self, tube):
        for seed in (0, SECRET):
            verdict = judge(tube, lambda u, w, r, h: right(np.asarray(u) ** 2, w, r, h), seed=seed)
            assert (verdict.tier, verdict.fraction, verdict.outcome) == ("same set", 0.3, "partial")

    def test_hidden_data_must_be_the_same_set_as_well(self, tube):
        public = {float(d.arguments["h"]) for d in tube.draw()}

        def call(u, w, r, h):
            return right(np.asarray(u) ** 2, w, r if h in public else 2 * r, h)

        assert judge(tube, call, seed=SECRET).fraction == 0.0

    def test_without_search_the_function_is_asked_only_what_was_planned(self, tube):
        calls = []

        def call(u, w, r, h):
            calls.append(np.shape(u))
            return right(np.asarray(u) ** 2, w, r, h)

        verdict = judge(tube, call, search=False, figure=False)
        assert (verdict.tier, verdict.fraction) == ("different", 0.0)
        planned = len(calls)
        calls.clear()
        judge(tube, right, search=False, figure=False)
        assert planned == 3 * 3 + 3

    def test_calls_do_not_depend_on_whether_the_answer_is_right(self, tube):
        """All calls that marks hang on are the same, in the same order, for a right and for a wrong answer."""

        def recorded(answer):
            calls = []

            def call(*arguments):
                calls.append([np.array(a).tobytes() for a in arguments])
                return answer(*arguments)

            judge(tube, call, seed=SECRET, figure=False, search=False)
            return calls

        assert recorded(right) == recorded(lambda *a: 3 * right(*a))

    def test_the_worst_data_set_decides(self, tube):
        def call(u, w, r, h):
            return right(1 - u if h < 0 else u, w, r, h)

        verdict = judge(tube, call)
        assert (verdict.tier, verdict.fraction, verdict.symmetries) == ("relabelled", 0.5, ("flip_u",))

    def test_a_search_over_values_that_are_no_numbers_ends_quietly(self, tube):
        def call(u, w, r, h):
            u = np.asarray(u)
            return (
                right(u, w, r, h) * (1 + 1e-3 / (u - 0.32171))[..., None]
                + np.where(np.abs(u - 0.7) < 0.002, np.nan, 0)[..., None]
            )

        assert judge(tube, call, seed=SECRET).fraction == 0.0

    def test_a_search_ends_when_its_budget_is_spent(self, tube):
        """A function that answers the planned calls and then no more keeps its cheap finding."""
        calls = []

        def call(u, w, r, h):
            calls.append(1)
            if len(calls) > 3 * 3 + 3:
                raise MemoryError
            return right(np.asarray(u) ** 2, w, r, h)

        assert judge(tube, call).tier == "different"

    def test_blind_data_alone_do_not_pass(self, tube):
        assert judge(tube, lambda u, w, r, h: right(u, w, 1.0, 1.0)).fraction == 0.0


class TestJudgedAs:
    def test_the_reference(self, net_of_a_quarter):
        assert judge(net_of_a_quarter, net_of_a_quarter.reference, seed=SECRET).tier == "identical"

    def test_another_net_of_the_same_surface_is_right_where_accepted(self, net_of_a_quarter):
        def call(r, h):
            net, _ = net_of_a_quarter.reference(r, h)
            return net, np.array([[1.0, 1.0], [np.sqrt(2.0), np.sqrt(2.0)], [4.0, 4.0]])  # h0 h2 / h1² = 2

        verdict = judge(net_of_a_quarter, call, seed=SECRET)
        assert (verdict.outcome, verdict.fraction, verdict.tier) == ("passed", 1.0, "same set")
        assert "counts as right" in verdict.message
        assert not verdict.part("look")

    def test_its_mistake(self, net_of_a_quarter):
        verdict = judge(net_of_a_quarter, net_of_a_quarter.mistakes[0].formula, seed=SECRET)
        assert (verdict.mistake, verdict.fraction) == ("weight_1", 0.4)
        assert verdict.figure is not None

    def test_a_net_that_makes_no_surface_is_told_why(self, net_of_a_quarter):
        verdict = judge(net_of_a_quarter, lambda r, h: (np.zeros((3, 2, 3)), np.ones((2, 3))))
        assert verdict.tier == "shape"
        assert "weights (3, n)" in verdict.message

    def test_one_array_where_two_are_wanted(self, net_of_a_quarter):
        assert judge(net_of_a_quarter, lambda r, h: np.ones((3, 2))).fraction == 0.0


class TestVerdict:
    ANSWERS = (right, lambda *a: right(*a) ** 2, lambda u, w, r, h: right(np.sqrt(u), w, r, h), lambda *a: None)

    @pytest.mark.parametrize("answer", ANSWERS)
    def test_the_same_seed_gives_the_same_json(self, tube, answer):
        one, other = (judge(tube, answer, seed=SECRET).to_json() for _ in range(2))
        assert one == other

    @pytest.mark.parametrize("answer", ANSWERS)
    def test_it_goes_to_json_and_back(self, tube, answer):
        verdict = judge(tube, answer, seed=SECRET)
        assert Verdict.from_dict(json.loads(verdict.to_json())) == verdict

    def test_its_message_is_its_parts_in_the_order_they_are_read(self, tube):
        verdict = judge(tube, lambda u, w, r, h: right(u, w, r, 2 * h))
        assert verdict.message == " ".join(text for _, text in verdict.parts)
        order = [part for part, _ in verdict.parts]
        assert order == sorted(order, key=["right", "wrong", "where", "look"].index)

    def test_its_figure_shows_the_worst_public_data_that_see(self, tube):
        verdict = judge(tube, lambda u, w, r, h: right(u, w, r, h * h), seed=SECRET)
        figure = verdict.figure
        assert figure is not None
        expected, yours = np.array(figure.expected), np.array(figure.yours)
        assert expected.shape == yours.shape == (33, 33, 3)
        shown = max((d for d in tube.draw() if not d.blind), key=lambda d: abs(d.arguments["h"] ** 2 - d.arguments["h"]))
        grid = np.meshgrid(*[np.linspace(0, 1, 33)] * 2, indexing="ij")
        np.testing.assert_allclose(expected, right(*grid, **shown.arguments), atol=1e-5)

    def test_its_figure_has_none_where_a_point_is_no_number(self, tube):
        figure = judge(tube, lambda u, w, r, h: right(u, w, r, h) * np.asarray(w / w)[..., None]).figure
        assert figure is not None
        assert figure.yours[3][0] == [None, None, None]
        assert None not in figure.yours[3][1]

    def test_a_solid_shows_a_layer_and_a_curve_itself(self, block, helix):
        layer = judge(block, lambda *a: 2 * block.reference(*a)).figure
        assert layer is not None
        assert np.shape(layer.yours) == (33, 33, 3)
        line = judge(helix, lambda *a: 2 * helix.reference(*a)).figure
        assert line is not None
        assert (line.kind, np.shape(line.yours)) == ("curve", (129, 3))

    def test_single_number_functions_get_a_figure_too(self, tube):
        figure = judge(tube, lambda u, w, r, h: [r * math.cos(TURN * u), r * math.sin(TURN * u), h * w]).figure
        assert figure is not None
        assert np.shape(figure.yours) == (13, 13, 3)


class TestOtherDimensions:
    def test_a_curve_run_backwards(self, helix):
        verdict = judge(helix, lambda u, r, pitch: helix.reference(1 - np.asarray(u), r, pitch))
        assert (verdict.tier, verdict.symmetries) == ("relabelled", ("flip_u",))

    def test_a_curve_at_another_speed(self, helix):
        assert judge(helix, lambda u, r, pitch: helix.reference(np.asarray(u) ** 2, r, pitch)).tier == "same set"

    def test_a_part_of_a_curve(self, helix):
        assert judge(helix, lambda u, r, pitch: helix.reference(np.asarray(u) / 2, r, pitch)).tier == "part"

    def test_a_curve_elsewhere(self, helix):
        verdict = judge(helix, lambda u, r, pitch: helix.reference(u, r, pitch) + [0, 0, 3])
        assert verdict.tier == "moved"
        assert "moved by (0, 0, 3)" in verdict.message

    def test_a_closed_curve_that_starts_elsewhere(self):
        @exercise(points=1, title="Circle", kind="curve")
        def circle(u):
            """Return the unit circle."""
            return stack(np.cos(TURN * u), np.sin(TURN * u), 0.0)

        circle.data(lambda rng: {})
        verdict = judge(circle, lambda u: circle.reference(np.asarray(u) + 0.2))
        assert verdict.tier == "other start"
        assert "your u = 0 lies where u = 0.2 should be" in verdict.message

    def test_a_solid_with_two_parameters_exchanged(self, block):
        verdict = judge(block, lambda u, v, w, a, b, c: block.reference(v, u, w, a, b, c))
        assert (verdict.tier, verdict.symmetries) == ("relabelled", ("(v, u, w)",))

    def test_a_solid_at_another_speed(self, block):
        assert judge(block, lambda u, v, w, a, b, c: block.reference(u, np.asarray(v) ** 2, w, a, b, c)).tier == "same set"

    def test_a_solid_with_one_face_off(self, block):
        verdict = judge(block, lambda u, v, w, a, b, c: block.reference(u, v, w, a, b, c) * [1, 1, 1.2])
        assert verdict.fraction == 0.0
        assert "z is 1.2 times" in verdict.message
