"""Every message of the checks: what provokes it, and the neighbour that must pass."""

import numpy as np
import pytest
from directrix import checks
from directrix.errors import DegenerateError, DomainError, NumberError, OrderError, ShapeError, WeightError

NAN = float("nan")

REFUSED = [
    (lambda: checks.array("a", [1, NAN]), NumberError, r"a must be finite; got nan at index \[1\]"),
    (lambda: checks.array("a", [[1, 2], [np.inf, 3]]), NumberError, r"got inf at index \[1, 0\]"),
    (lambda: checks.array("a", [1, -1e76]), NumberError, r"a must be at most 1e\+75 in size; got 1e\+76"),
    (lambda: checks.weights("weights", [1, 1e-80], (2,)), WeightError, "weights must be at least 1e-75; got 1e-80"),
    (lambda: checks.number("a", NAN), NumberError, "a must be finite; got nan"),
    (lambda: checks.array("a", ["x"]), ShapeError, "a must be real numbers"),
    (lambda: checks.array("a", None), ShapeError, "a must be real numbers; got None"),
    (lambda: checks.array("a", 1 + 2j), ShapeError, "a must be real numbers"),
    (lambda: checks.array("a", [[1, 2], [3]]), ShapeError, "rows of unequal length"),
    (lambda: checks.array("a", np.ma.masked_greater([1.0, 99.0], 9)), ShapeError, "got an array of which 1 are masked"),
    (lambda: checks.parameter("u", np.ma.masked), ShapeError, r"Leave those out, or give them a value with \.filled\(\)"),
    (lambda: checks.number("a", [1, 2]), ShapeError, r"a must be one number; got an array of shape \(2,\)"),
    (lambda: checks.positive("radius", 0), NumberError, "radius must be greater than 0; got 0"),
    (lambda: checks.not_negative("r1", -1e-9), NumberError, "r1 must be at least 0; got -1e-09"),
    (lambda: checks.not_zero("height", 0.0), NumberError, "height must not be 0: the surface would collapse"),
    (lambda: checks.choice("axis", "q", ("x", "y")), NumberError, "axis must be one of 'x', 'y'; got 'q'"),
    (lambda: checks.choice("axis", 1, ("x", "y"), hint="Try this."), NumberError, "got 1. Try this."),
    (lambda: checks.point("p", (1, 2)), ShapeError, r"p must have shape \(3,\); got \(2,\). Put it into space with z = 0"),
    (lambda: checks.point("p", [[1, 2, 3]]), ShapeError, r"p must have shape \(3,\); got \(1, 3\)\.$"),
    (lambda: checks.direction("k", (0, 0, 0)), DegenerateError, "k must not be the zero vector"),
    (lambda: checks.points("points", [[1, 2, 3]]), ShapeError, r"with n >= 2; got \(1, 3\)"),
    (lambda: checks.points("points", np.zeros((4, 2))), ShapeError, "Add a column of zeros for z"),
    (lambda: checks.points("points", np.zeros((3, 4))), ShapeError, "The coordinates are the last axis: transpose it"),
    (lambda: checks.net("net", np.zeros((16, 3))), ShapeError, r"For a 4 x 4 net use .reshape\(4, 4, 3\)"),
    (lambda: checks.net("net", np.zeros((20, 3))), ShapeError, r"Use .reshape\(m, n, 3\)"),
    (lambda: checks.net("net", np.zeros((3, 4, 4))), ShapeError, r"np.moveaxis\(net, 0, -1\)"),
    (lambda: checks.net("net", np.zeros((1, 4, 3))), ShapeError, r"with m, n >= 2; got \(1, 4, 3\)"),
    (lambda: checks.weights("weights", [1, 2], (3,)), ShapeError, r"must have shape \(3,\), one weight for each"),
    (lambda: checks.weights("weights", [1, 0, 2], (3,)), WeightError, r"weights\[1\] is 0"),
    (lambda: checks.whole("order", 2.0), OrderError, "order must be a whole number of at least 0; got 2.0"),
    (lambda: checks.whole("order", True), OrderError, "got True"),
    (lambda: checks.whole("order", -1), OrderError, "got -1"),
    (lambda: checks.order("order", 5, 4), OrderError, r"got order 5 \(degree 4\) for 4 points. Lower the order to 4"),
    (lambda: checks.order("order", 0, 4), OrderError, "order must be a whole number of at least 1"),
    (lambda: checks.increasing("tu", [0, 1], 3), ShapeError, r"tu must have shape \(3,\), one parameter for each point"),
    (lambda: checks.increasing("tu", [0, 0.5, 0.5, 1], 4), NumberError, "tu must increase from 0 to 1"),
    (lambda: checks.increasing("tu", [0, 0.5, 0.9], 3), NumberError, "tu must increase from 0 to 1"),
    (lambda: checks.increasing("tu", [0.1, 0.5, 1], 3), NumberError, "tu must increase from 0 to 1"),
    (lambda: checks.parameter("u", 1.1), DomainError, r"u must lie in \[0, 1\]; got u = 1.1. Pass the parameter itself"),
    (lambda: checks.parameter("u", [0.5, -1e-11]), DomainError, "got u = -1e-11"),
    (lambda: checks.parameter("u", [0.5, NAN]), DomainError, "got u = nan"),
    (lambda: checks.parameter("u", "half"), ShapeError, "u must be real numbers; got 'half'"),
    (lambda: checks.inside("u", 1.0), DomainError, "u must lie strictly between 0 and 1 to split there; got 1"),
    (lambda: checks.broadcast(u=np.zeros(3), w=np.zeros(4)), ShapeError, r"u of shape \(3,\) and w of shape \(4,\)"),
    (lambda: checks.derivative_order("n", 3, most=2, why="Numeric."), OrderError, "n must be at most 2 here; got 3. Numeric."),
    (lambda: checks.derivative_order("n", 0.5), OrderError, "n must be a whole number"),
    (lambda: checks.spanning("on a line", np.array([1.0, 1, 1]), np.array([2.0, 2, 2])), DegenerateError, "on a line"),
    (lambda: checks.spanning("on a line", np.zeros(3), np.array([2.0, 2, 2])), DegenerateError, "on a line"),
]  # fmt: skip

ACCEPTED = [
    (lambda: checks.array("a", np.ma.masked_greater([1.0, 2.0], 9)), [1, 2]),
    (lambda: checks.array("a", [1, 2]), [1, 2]),
    (lambda: checks.array("a", np.array([1, 2], dtype=object)), [1, 2]),
    (lambda: checks.number("a", np.float32(0.5)), 0.5),
    (lambda: checks.number("a", True), 1.0),
    (lambda: checks.number("a", -1e75), -1e75),
    (lambda: checks.weights("weights", [1e75, 1e-74], (2,)), [1e75, 1e-74]),
    (lambda: checks.positive("radius", 5e-324), 5e-324),
    (lambda: checks.not_negative("r1", 0), 0),
    (lambda: checks.not_zero("height", -1), -1),
    (lambda: checks.choice("axis", "x", ("x", "y")), "x"),
    (lambda: checks.point("p", [1, 2, 3]), [1, 2, 3]),
    (lambda: checks.direction("k", (0, 0, 4)), [0, 0, 1]),
    (lambda: checks.points("points", np.zeros((2, 3))), np.zeros((2, 3))),
    (lambda: checks.net("net", np.zeros((2, 2, 3))), np.zeros((2, 2, 3))),
    (lambda: checks.weights("weights", [1e-9, 2], (2,)), [1e-9, 2]),
    (lambda: checks.whole("order", np.int64(3)), 3),
    (lambda: checks.order("order", 4, 4), 4),
    (lambda: checks.increasing("tu", [0, 0.5, 1], 3), [0, 0.5, 1]),
    (lambda: checks.parameter("u", [-1e-13, 1 + 1e-13]), [0, 1]),
    (lambda: checks.parameter("u", []), []),
    (lambda: checks.inside("u", 0.5), 0.5),
    (lambda: checks.broadcast(u=np.zeros((3, 1)), w=np.zeros(4)), (3, 4)),
    (lambda: checks.derivative_order("n", 2, most=2), 2),
]  # fmt: skip


@pytest.mark.parametrize(("call", "error", "message"), REFUSED)
def test_refused(call, error, message):
    """The right error, and a sentence with what must hold and what came."""
    with pytest.raises(error, match=message) as caught:
        call()
    assert type(caught.value) is error


@pytest.mark.parametrize(("call", "value"), ACCEPTED)
def test_accepted(call, value):
    """The neighbour of each refusal passes, with the value it stands for."""
    assert np.array_equal(call(), value)


def test_spanning_directions_pass():
    """A thin angle is no line."""
    checks.spanning("on a line", np.array([1.0, 0, 0]), np.array([1.0, 1e-6, 0]))


@pytest.mark.parametrize("size", [1e-200, 1.0, 1e200])
def test_lengths_neither_overflow_nor_vanish(size):
    """The squares of 1e200 and 1e-200 are no floats; the lengths are."""
    assert checks.length(size * np.array([3.0, 4.0, 0.0])) == pytest.approx(5 * size, rel=1e-15)
    if size <= checks.LARGEST:
        assert np.allclose(checks.direction("k", size * np.array([3.0, 4.0, 0.0])), [0.6, 0.8, 0], rtol=1e-15)


def test_a_checked_array_is_a_read_only_copy():
    """The caller's array is neither locked nor shared."""
    mine = np.ones(3)
    checked = checks.point("p", mine)
    assert mine.flags.writeable
    assert not checked.flags.writeable
    assert not np.shares_memory(mine, checked)


def test_parameters_inside_are_not_copied():
    """A hundred thousand parameters pass through as they are."""
    u = np.linspace(0, 1, 5)
    assert checks.parameter("u", u) is u


def test_the_bad_parameter_is_kept_as_a_fact():
    """For a program that shows it."""
    with pytest.raises(DomainError) as caught:
        checks.parameter("u", [0.0, 2.5])
    assert caught.value.facts == {"name": "u", "got": 2.5}
