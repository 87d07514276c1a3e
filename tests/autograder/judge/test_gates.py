"""The gates before any comparison: shapes, errors, finite numbers, point by point, repeatable; stubs, and our own failures."""

import importlib
import math

import numpy as np
import pytest

from autograder.errors import CallFailed, SandboxError
from autograder.exercise import exercise
from autograder.judge import judge

TURN = 2 * np.pi
SECRET = b"course secret, student, digest"


def stack(x, y, z):
    return np.stack(np.broadcast_arrays(x, y, z), axis=-1)


def right(u, w, r, h):
    return stack(r * np.cos(TURN * u), r * np.sin(TURN * u), h * w)


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

    def test_another_number_of_coordinates(self, tube):
        verdict = judge(tube, lambda *a: right(*a)[..., :2])
        assert verdict.tier == "shape"
        assert "2 numbers for each place; wanted are 3, (167, 3)." in verdict.message
        assert "one array for each coordinate" in verdict.message

    def test_an_error_under_one_form_is_a_sentence_of_its_own(self, tube):
        """What Python says of it ends without a full stop, or with one; the next sentence begins after one."""
        for said in ("cannot", "cannot."):

            def call(u, w, r, h, said=said):
                if np.ndim(u):
                    raise TypeError(said)
                return right(u, w, r, h)

            assert " stops with TypeError: cannot. With arrays " in judge(tube, call).message

    def test_a_mask_has_no_coordinates(self):
        """A turned mesh is one; a single number is not one coordinate of a point."""

        @exercise(points=1, title="Half", kind="mask")
        def half(u, w):
            """Return where u + w <= 1."""
            return np.add(u, w) <= 1

        half.data(lambda rng: {})
        turned = judge(half, lambda u, w: np.asarray(half.reference(u, w)).T).message
        assert "the first axis belongs to u" in turned
        single = judge(half, lambda u, w: True).message
        for message in (turned, single):
            assert "coordinates last" not in message
            assert "np.stack" not in message
            assert "number a point" not in message

    def test_what_to_begin_with_names_the_parameters_of_the_exercise(self, tube):
        flat = judge(tube, lambda *a: np.reshape(right(*a), (-1, 3))).message
        assert "Begin with u, w = np.broadcast_arrays(u, w)" in flat

        @exercise(points=1, title="Cube", kind="solid")
        def cube(u, v, w):
            """Return (u, v, w)."""
            return stack(u, v, w)

        cube.data(lambda rng: {})
        flat = judge(cube, lambda u, v, w: np.reshape(stack(u, v, w), (-1, 3))).message
        assert "Begin with u, v, w = np.broadcast_arrays(u, v, w)" in flat

    def test_a_table_for_a_number_and_a_turned_table_have_words_of_their_own(self):
        @exercise(points=1, title="Sum", kind="value")
        def total(a):
            """Return the sum."""
            return float(np.sum(a))

        @exercise(points=1, title="Table", kind="net")
        def table(a):
            """Return the rows twice."""
            return np.stack([a, 2 * a])

        for posed in (total, table):
            posed.data(lambda rng: {"a": rng.uniform(size=3)})
        assert "The answer is a single number: is a sum, a mean or an index missing?" in judge(total, lambda a: a).message
        assert judge(table, lambda a: table.reference(a).T).message.endswith("which axis is which in the statement?")

    def test_what_only_blind_data_show_is_not_followed_up(self, tube):
        """No "the first case" where no case was told."""
        verdict = judge(tube, lambda u, w, r, h: right(u, w, h, r))
        assert "which cannot see this mistake" in verdict.message
        assert "first case" not in verdict.message

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

    @pytest.mark.parametrize(("form", "ndim"), [("mesh", 2), ("one pair of parameters", 0)])
    def test_what_is_right_in_a_list_only_is_not_pointwise(self, tube, form, ndim):
        """By five millionths: less than float32 may be off, but this is no float32."""

        def call(u, w, r, h):
            return right(u, w, r, h * (1 + 5e-6 * (np.ndim(u) == ndim)))

        assert form in self.message(tube, call, "not pointwise")

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

    def test_an_axis_that_is_not_there(self, tube):
        """numpy's AxisError is an IndexError too, but no index is too large."""
        message = judge(tube, lambda u, w, r, h: np.stack([u, w, u], axis=7)).message
        assert "asks for an axis that its array does not have: axis 7 is out of bounds" in message
        assert "Print the shape of that array" in message
        assert "Indices run" not in message

    def test_a_package_that_is_not_there(self, tube):
        """It may be there in the learner's own JupyterLab: what the grader has is told."""

        def call(u, w, r, h):
            return importlib.import_module("a_package_that_is_not_there")

        verdict = judge(tube, call)
        assert (verdict.tier, verdict.fraction) == ("error", 0.0)
        assert verdict.part("wrong").startswith("Your function stopped at an import: No module named")
        assert "numpy, plotly and what comes with Python itself" in verdict.part("look")

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
