"""check(f) where f calls an earlier exercise of the same notebook that is not right yet."""

BASIS = "import numpy as np\ndef bernstein(n, t):\n    t = np.asarray(t)[..., None]\n    i = np.arange(n + 1)\n"
SLIP = BASIS + "    return t**i * (1 - t)**(n - i)"
PATCH = (
    "def bezier_patch(u, w, P):\n"
    "    return np.einsum('...i,...j,ijk->...k', bernstein(len(P) - 1, u), bernstein(P.shape[1] - 1, w), P)\n"
)


def test_a_notebook_is_told_which_function_to_put_right_first(notebook):
    """The proof is worked out in the kernel, with the learner's own functions."""
    notebook.run("from autograder import check")
    notebook.run(SLIP)
    notebook.run(PATCH)
    (shown,) = notebook.run("check(bezier_patch)").cards
    assert "It comes out wrong only because bernstein, which it calls, is not right yet." in shown
    assert "Next: Put bernstein right and check again; bezier_patch needs no change." in shown


def test_the_points_are_those_of_any_answer_that_is_right_on_some_data(notebook):
    """An earlier function that is right up to degree 3 only: half of the drawn data see it, so 1/2 x 1/2 of 6 points."""
    notebook.run("from autograder import catalogue\nright = catalogue.shipped().find('bernstein').reference")
    notebook.run("def bernstein(n, t):\n    return right(n, t) * (1 if n <= 3 else 1.5)")
    notebook.run(PATCH)
    checked = notebook.run("check(bezier_patch)")
    (shown,) = checked.cards
    assert checked.result == 1.5
    assert "It comes out wrong only because bernstein, which it calls, is not right yet." in shown
    assert "Worth: 0.5 (right on 1 of 2 data sets" in shown
    assert "= 0.25 of the points." in shown


def test_an_earlier_function_that_is_right_is_not_mentioned(notebook):
    """Only what is wrong is worth a word."""
    notebook.run("from autograder import check, catalogue")
    notebook.run("bernstein = catalogue.shipped().find('bernstein').reference")
    notebook.run(PATCH.replace("P)\n", "P) + 1\n"))
    (shown,) = notebook.run("check(bezier_patch)").cards
    assert "bernstein" not in shown


def test_the_stub_of_an_earlier_function_is_named(notebook):
    """Nothing is said against the function that is written."""
    notebook.run("from autograder import check")
    notebook.run(BASIS + "    raise NotImplementedError")
    notebook.run(PATCH)
    (shown,) = notebook.run("check(bezier_patch)").cards
    assert "bezier_patch calls bernstein, which is not written yet." in shown
