"""Running a rebuilt notebook, with a session that lives in this process (the sandbox has tests of its own)."""

import ast
import contextlib
import io
import time
import traceback

import numpy as np
import pytest

from autograder import catalogue
from autograder.errors import CallFailed, SandboxError
from autograder.notebook.master import Master, MasterCell
from autograder.notebook.rebuild import rebuild
from autograder.notebook.run import MAX_RESTARTS, run
from autograder.notebook.score import annotate, marks

SEED = b"hidden"


class FakeResult:
    def __init__(self, outputs, status="ok", note=""):
        self.outputs, self.status, self.note = outputs, status, note


class FakeSession:
    """Runs cells in a dict. ``die()`` and ``hang()`` in a cell end it, as a killed process would."""

    opened = 0

    def __init__(self):
        FakeSession.opened += 1
        self.names = {"die": self._die, "np": np}
        self.alive = True

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        self.alive = False

    def _die(self):
        self.alive = False
        raise SystemExit

    def run_cell(self, source):
        assert self.alive, "a dead session was used"
        written = io.StringIO()
        try:
            tree = ast.parse(source)
            last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
            with contextlib.redirect_stdout(written):
                exec(compile(tree, "cell", "exec"), self.names)
                value = eval(compile(ast.Expression(last.value), "cell", "eval"), self.names) if last else None
        except SystemExit:
            return FakeResult([], "died" if not self.alive else "ok", "os._exit was called" if not self.alive else "")
        except Exception as error:
            lines = traceback.format_exception_only(error)
            return FakeResult(
                [{"output_type": "error", "ename": type(error).__name__, "evalue": str(error), "traceback": lines}], "error"
            )
        outputs = [{"output_type": "stream", "name": "stdout", "text": written.getvalue()}] if written.getvalue() else []
        if value is not None:
            outputs.append({"output_type": "execute_result", "data": {"text/plain": repr(value)}, "metadata": {}})
        return FakeResult(outputs)

    def call_all(self, name, sets, *, deadline):
        answers = []
        for args in sets:
            if time.monotonic() > deadline:
                break
            try:
                answers.append(self.call(name, args))
            except CallFailed as failure:
                answers.append(failure)
                if failure.kind != "error":
                    break
        return answers

    def call(self, name, args):
        if not self.alive:
            raise CallFailed("died", "the process has ended")
        if name not in self.names:
            raise CallFailed("missing", f"no function {name}")
        try:
            return self.names[name](*args)
        except SystemExit:
            raise CallFailed("died", "the process has ended") from None
        except Exception as error:
            bases = tuple(kind.__name__ for kind in type(error).__mro__)
            raise CallFailed("error", str(error), exception=type(error).__name__, bases=bases) from None

    def files(self):
        return {"made.txt": b"by the learner"}


@pytest.fixture(autouse=True)
def _count():
    FakeSession.opened = 0


def master(*cells):
    return Master("nb", {cell.name: cell for cell in cells}, {"name": "python3"})


def solution(name, source="raise NotImplementedError"):
    return MasterCell(name, "code", source, checksum="0" * 32, solution=True)


def a_test(name, source, points=2.0):
    return MasterCell(name, "code", source, checksum="0" * 32, locked=True, grade=True, points=points)


def cell(source, name=None, kind="code", **metadata):
    if name is not None:
        metadata["nbgrader"] = {"grade_id": name}
    return {"cell_type": kind, "source": source, "metadata": metadata, "id": name or "free"}


def graded(instructors, *cells, exercises=None, session=FakeSession, **options):
    built = rebuild({"cells": list(cells), "metadata": {}}, instructors)
    ran = run(built, session, exercises or catalogue.shipped().get, lambda name: SEED, **options)
    given = marks(built, ran)
    annotate(built, given)
    return built, ran, given


RIGHT = "def cylinder(u, w, r, h):\n    a = 2*np.pi*w\n    u = np.asarray(u)\n" + (
    "    return np.stack(np.broadcast_arrays(r*np.cos(a), r*np.sin(a), h*u), axis=-1)"
)


def shipped_reference(name):
    exercise = catalogue.shipped().find(name)

    class Session(FakeSession):
        def call(self, called, args):
            assert called == name
            return exercise.reference(*args)

    return Session


def test_an_exercise_cell_is_judged_and_never_run():
    """The guard: were the cell sent to the session, its text would raise a NameError there."""
    instructors = master(solution("cylinder"), a_test("check_cylinder", "check(cylinder)", 4.0))
    built, ran, given = graded(
        instructors, cell("pass", "cylinder"), cell("forged = 1/0", "check_cylinder"), session=shipped_reference("cylinder")
    )
    assert given["check_cylinder"].points == 4.0
    outputs = built.cells[1]["outputs"]
    assert outputs[0]["output_type"] == "display_data"
    assert "text/html" in outputs[0]["data"]
    assert outputs[-1]["output_type"] == "execute_result"
    assert outputs[-1]["data"] == {"text/plain": "4.0"}
    assert ran.cells[1].verdict.outcome == "passed"
    assert built.cells[1]["source"] == "check(cylinder)"


def test_a_missing_function_scores_zero_and_says_so():
    instructors = master(a_test("check_cylinder", "check(cylinder)", 4.0))
    _, ran, given = graded(instructors, cell("", "check_cylinder"))
    assert given["check_cylinder"].points == 0.0
    assert ran.cells[0].verdict.outcome == "not run"


def test_our_own_fault_has_no_mark_and_asks_for_a_look():
    """A sandbox that cannot be opened is never the learner's zero."""

    def broken():
        raise SandboxError("no bubblewrap")

    instructors = master(a_test("check_cylinder", "check(cylinder)"), a_test("t", "assert False"))
    built, ran, given = graded(instructors, cell("", "check_cylinder"), cell("", "t"), session=broken)
    assert [given[name].points for name in ("check_cylinder", "t")] == [None, None]
    assert given["check_cylinder"].look
    assert given["t"].look
    assert len(ran.faults) == 2
    assert not any(out["output_type"] == "execute_result" for out in built.cells[0]["outputs"])


def test_a_judge_that_crashes_is_our_fault(monkeypatch):
    def broken(*args, **kwargs):
        raise ZeroDivisionError("in the judge")

    monkeypatch.setattr("autograder.notebook.run.judge", broken)
    instructors = master(a_test("check_cylinder", "check(cylinder)"))
    _, ran, given = graded(instructors, cell("", "check_cylinder"))
    assert given["check_cylinder"].points is None
    assert "ZeroDivisionError" in ran.faults[0]


def test_an_unknown_check_is_ordinary_unless_the_notebook_is_ours():
    """An ordinary course may have a function called check; in our notebooks an unknown exercise could not be judged."""
    instructors = master(a_test("t", "check(nothing_of_ours)"))
    helper = cell("def check(f): return f()\ndef nothing_of_ours(): return 1.5")
    _, _, given = graded(instructors, helper, cell("", "t"))
    assert given["t"].points == 1.5
    _, _, given = graded(instructors, helper, cell("", "t"), uses_check=True)
    assert given["t"].points is None


def test_a_dead_process_costs_only_its_own_cell():
    """The cells before are run again in a fresh session, the killer is not, the cells after go on."""
    instructors = master(a_test("before", "assert x == 1"), a_test("after", "assert x == 1; assert y == 2"))
    built, ran, given = graded(
        instructors, cell("x = 1"), cell("", "before"), cell("z = 3\ndie()"), cell("y = 2"), cell("", "after")
    )
    assert given["before"].points == 2.0
    assert given["after"].points == 2.0
    assert ran.restarts == 1
    assert built.cells[2]["outputs"][-1]["ename"] == "ProcessEnded"


def test_an_exercise_that_kills_its_process_costs_only_itself():
    instructors = master(a_test("check_cylinder", "check(cylinder)"), a_test("after", "assert x == 1"))
    _, _, given = graded(
        instructors, cell("x = 1\ndef cylinder(u, w, r, h): die()"), cell("", "check_cylinder"), cell("", "after")
    )
    assert given["check_cylinder"].points == 0.0
    assert given["after"].points == 2.0


def test_restarts_are_bounded_and_what_is_left_has_no_mark():
    """A notebook of nothing but killers cannot keep the grader busy; what was not run is not a zero."""
    killers = [cell(f"die()  # {number}") for number in range(MAX_RESTARTS + 3)]
    instructors = master(a_test("t", "assert True"))
    _, _, given = graded(instructors, *killers, cell("", "t"))
    assert given["t"].points is None
    assert given["t"].look
    assert FakeSession.opened == MAX_RESTARTS + 1


def test_a_cell_good_once_and_fatal_in_the_replay_is_left_out():
    source = "import builtins\ntry:\n    builtins.seen += 1; die()\nexcept AttributeError:\n    builtins.seen = 0"
    import builtins

    try:
        instructors = master(a_test("t", "assert True"))
        _, ran, given = graded(instructors, cell(source), cell("die()"), cell("", "t"))
    finally:
        del builtins.seen
    assert given["t"].points == 2.0
    assert ran.restarts == 2


def test_no_time_left_means_no_mark():
    instructors = master(a_test("t", "assert True"))
    _, _, given = graded(instructors, cell("", "t"), seconds=-1.0)
    assert given["t"].points is None
    assert "time" in given["t"].note


def test_a_function_that_sleeps_in_every_call_does_not_keep_the_class_waiting():
    """Each call stays below its limit, and the judge makes hundreds: no mark, no fault of ours, and the time is bounded."""

    class Sleepy(FakeSession):
        def call(self, name, args):
            time.sleep(0.02)
            return np.random.default_rng().random((*np.broadcast(*args[:2]).shape, 3))

    instructors = master(a_test("t", "check(cylinder)", 4.0))
    started = time.monotonic()
    _, ran, given = graded(instructors, cell("", "t"), session=Sleepy, seconds=0.1)
    assert time.monotonic() - started < 5
    assert given["t"].points is None
    assert "time" in given["t"].note
    assert ran.faults == []


def test_what_thousands_of_cells_show_is_bounded_and_no_mark_is_lost_for_it():
    instructors = master(a_test("t", "print('x' * 10**6)\n1.5"), a_test("u", "print('x' * 10**6)\nassert False"))
    loud = [cell("print('x' * 10**6)") for _ in range(60)]
    built, _, given = graded(instructors, *loud, cell("", "t"), cell("", "u"))
    assert sum(len(str(made["outputs"])) for made in built.cells) < 34_000_000
    assert "left out" in str(built.cells[59]["outputs"])
    assert (given["t"].points, given["u"].points) == (1.5, 0.0)


def test_an_update_of_many_displays_is_bounded():
    """One megabyte in two hundred places of each cell: the session changes the outputs that it gave before."""
    places = []

    class Updating(FakeSession):
        def run_cell(self, source):
            if source == "update":
                for place in places:
                    place.update(data={"text/plain": "x" * 10**6})
                return FakeResult([])
            new = [{"output_type": "display_data", "data": {"text/plain": "."}, "metadata": {}} for _ in range(200)]
            places.extend(new)
            return FakeResult(new)

    built, _, _ = graded(master(), *[cell("show")] * 5, cell("update"), session=Updating)
    assert sum(len(str(made["outputs"])) for made in built.cells) < 34_000_000


def test_a_tag_of_the_submission_does_not_skip_a_test():
    """nbclient skips a tagged cell, and nbgrader then gives it full points."""
    instructors = master(a_test("t", "assert False"))
    built, _, given = graded(instructors, cell("", "t", tags=["skip-execution"]))
    assert given["t"].points == 0.0
    assert "tags" not in built.cells[0]["metadata"]


def test_the_last_of_duplicates_counts_and_is_flagged():
    instructors = master(a_test("t", "assert x == 2"))
    built, _, given = graded(instructors, cell("x = 1"), cell("", "t"), cell("x = 2"), cell("", "t"))
    assert given["t"].points == 2.0
    assert given["t"].look
    assert "more than once" in built.cells[-1]["outputs"][-1]["data"]["text/plain"]


def test_a_deleted_test_cell_has_no_mark():
    instructors = master(a_test("t", "assert True"))
    built, _, given = graded(instructors, cell("x = 1"))
    assert given == {}
    assert built.notes[0].cell == "t"
    assert built.notes[0].look


def test_execution_counts_go_up_and_outputs_are_harmless():
    instructors = master()
    built, _, _ = graded(instructors, cell("print('\\ud800')"), cell("text", kind="markdown"), cell("1 + 1"))
    assert [c.get("execution_count") for c in built.cells] == [1, None, 2]
    assert built.cells[2]["outputs"][0]["execution_count"] == 2


def test_files_that_the_notebook_wrote_are_kept():
    _, ran, _ = graded(master(), cell("x = 1"))
    assert ran.files == {"made.txt": b"by the learner"}


BASIS = """def bernstein(n, t):
    t = np.asarray(t, float)[..., None]
    i = np.arange(n + 1)
    return {factor} * t**i * (1 - t)**(n - i)
"""
COUNT = "np.array([__import__('math').comb(n, k) for k in i])"
PATCH = """def together(u, w, P):
    return np.einsum('...i,...j,ijk->...k', bernstein(len(P) - 1, u), bernstein(P.shape[1] - 1, w), P)

def bezier_patch(u, w, P):
    return together(u, w, P){more}
"""


@pytest.mark.parametrize(
    ("factor", "more", "follows", "said"),
    [
        ("1", "", ("bernstein",), "It comes out wrong only because `bernstein`, which it calls, is not right yet."),
        ("1", " * [1, 1, -1]", (), "`bezier_patch` calls `bernstein`, which is not right yet: put that right first"),
        (COUNT, " * [1, 1, -1]", (), ""),
    ],
)
def test_a_later_exercise_that_fails_for_an_earlier_one_says_so(factor, more, follows, said):
    """The chain from the text of two cells to the card: proved, told as a fact, or not mentioned where the earlier is right."""
    names = ("bernstein", "bezier_patch")
    instructors = master(*(one for name in names for one in (solution(name), a_test(f"check_{name}", f"check({name})"))))
    built, ran, _ = graded(
        instructors,
        cell(BASIS.format(factor=factor), "bernstein"),
        cell("", "check_bernstein"),
        cell(PATCH.format(more=more), "bezier_patch"),
        cell("", "check_bezier_patch"),
    )
    verdict = ran.cells[3].verdict
    assert verdict.outcome != "passed"
    assert verdict.follows == follows
    shown = built.cells[3]["outputs"][0]["data"]["text/plain"]
    assert said.replace("`", "") in shown
    assert ("not right yet" in verdict.message) == bool(said)


def test_the_stub_of_an_earlier_exercise_is_named():
    """Its error comes up through the later function, which is written."""
    instructors = master(
        solution("bernstein"), a_test("a", "check(bernstein)"), solution("p"), a_test("b", "check(bezier_patch)")
    )
    stub = "def bernstein(n, t):\n    raise NotImplementedError"
    _, ran, _ = graded(instructors, cell(stub, "bernstein"), cell("", "a"), cell(PATCH.format(more=""), "p"), cell("", "b"))
    assert ran.cells[3].verdict.outcome == "not run"
    assert ran.cells[3].verdict.part("wrong") == "`bezier_patch` calls `bernstein`, which is not written yet."
