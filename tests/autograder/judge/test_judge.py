"""What the judge promises behind the gates: recognised mistakes, credits, hidden data, and the same verdict every time."""

import json
import math

import numpy as np
import pytest

from autograder.exercise import exercise
from autograder.judge import judge
from autograder.result import Verdict

TURN = 2 * np.pi
SECRET = b"course secret, student, digest"


def stack(x, y, z):
    return np.stack(np.broadcast_arrays(x, y, z), axis=-1)


def right(u, w, r, h):
    return stack(r * np.cos(TURN * u), r * np.sin(TURN * u), h * w)


class TestMistakes:
    @pytest.mark.parametrize("name", ["diameter", "no_height", "swap_uw"])
    @pytest.mark.parametrize("seed", [0, SECRET])
    def test_a_mistake_is_named_with_its_hint(self, tube, name, seed):
        known = next(m for m in tube.mistakes if m.id == name)
        verdict = judge(tube, known.formula, seed=seed)
        assert (verdict.tier, verdict.mistake) == ("mistake", name)
        assert known.hint in verdict.part("look")
        assert verdict.fraction == (0.5 if known.credit is None else known.credit)

    def test_another_way_of_writing_it_is_the_same_mistake(self, tube):
        known = tube.mistakes[0]
        before = judge(tube, lambda u, w, *rest: known.formula(u, w, *rest) * [1, 1, 3], seed=SECRET)
        tube.also(known.id)(lambda u, w, r, h: known.formula(u, w, r, h) * [1, 1, 3])
        after = judge(tube, lambda u, w, *rest: known.formula(u, w, *rest) * [1, 1, 3], seed=SECRET)
        assert before.mistake is None
        assert (after.mistake, after.tier) == (known.id, "mistake")
        assert known.hint in after.message

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


class TestAtTheTolerance:
    @pytest.mark.parametrize("amount", [0.7e-9, 1.2e-9, 1.7e-9])
    def test_hardly_off_in_all_coordinates_is_close_and_not_relabelled(self, tube, amount):
        """Each coordinate is within the tolerance, the distance is not: no relabelling explains that."""

        def call(u, w, r, h):
            return right(u, w, r, h) + amount * np.hypot(np.sqrt(8) * r, h)

        verdict = judge(tube, call)
        assert (verdict.tier, verdict.symmetries) == ("close", ())
        assert judge(tube, lambda *a: 0.5 * call(*a) + 0.5 * right(*a)).tier == ("identical" if amount < 1e-9 else "close")


class TestSingleNumbers:
    @pytest.mark.parametrize("bad", [lambda u, w: w == 1 / 3, lambda u, w: u == 0 < w < 1, lambda u, w: 0 < u < 1 == w])
    def test_a_function_of_single_numbers_is_asked_at_fractions_and_on_sides_too(self, tube, bad):
        """A spline's knots lie there, and its last span ends there."""

        def call(u, w, r, h):
            return [math.nan if bad(u, w) else r * math.cos(TURN * u), r * math.sin(TURN * u), h * w]

        assert judge(tube, call).tier == "not finite"


class TestOtherDimensions:
    def test_a_curve_run_backwards(self, helix):
        verdict = judge(helix, lambda u, r, pitch: helix.reference(1 - np.asarray(u), r, pitch))
        assert (verdict.tier, verdict.symmetries) == ("relabelled", ("flip_u",))

    def test_a_curve_at_another_speed(self, helix):
        assert judge(helix, lambda u, r, pitch: helix.reference(np.asarray(u) ** 2, r, pitch)).tier == "same set"

    def test_a_curve_has_ends_and_one_parameter(self, helix):
        told = judge(helix, lambda u, r, pitch: helix.reference(np.asarray(u) ** 2, r, pitch)).message
        assert "with the same ends, but u runs at another speed along it." in told

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
