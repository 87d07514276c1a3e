"""All that grading writes into a notebook is in the catalogue, the sandbox's sentences too, and a translation changes it."""

import re
import signal
import string
from types import SimpleNamespace

import pytest

from autograder import catalogue, messages
from autograder.errors import CallFailed, SandboxError
from autograder.notebook import kernel, limit, safe
from autograder.notebook.marks import CellRun, judged, mark, partial, scored
from autograder.notebook.master import Master, MasterCell
from autograder.notebook.rebuild import rebuild
from autograder.notebook.run import ENDED, MAX_RESTARTS, run
from autograder.notebook.score import annotate, marks
from autograder.notebook.told import told
from autograder.sandbox import messages as english
from autograder.sandbox import outputs


@pytest.fixture
def marked(monkeypatch):
    """Another language, in which each text is its key and its facts: ``<sandbox.memory <sandbox.cell> 512>``."""
    monkeypatch.setattr(messages, "TEXT", dict(messages.ENGLISH))
    facts = {key: [name for _, name, _, _ in string.Formatter().parse(text) if name] for key, text in messages.ENGLISH.items()}
    messages.TEXT.update({key: " ".join([f"<{key}", *(f"{{{name}}}" for name in facts[key])]) + ">" for key in facts})


def sandbox_says():
    """Each sentence of the sandbox, with what it is in the other language."""
    for what, key in zip((english.CELL, english.CALL, english.FILES, english.START, english.TEST), PLACES, strict=True):
        yield english.memory(what, 2**29), f"<sandbox.memory <sandbox.{key}> 512>"
    yield english.cpu_time(english.CELL, 2.5), "<sandbox.cpu_time <sandbox.cell> 2.5>"
    yield english.wall_time(english.TEST, 10), "<sandbox.wall_time <sandbox.test> 10>"
    yield english.notebook_time(300.0), "<sandbox.notebook_time 300>"
    yield english.closed(english.CALL), "<sandbox.closed <sandbox.call>>"
    yield english.protocol(ValueError("cell")), "<sandbox.protocol cell>"
    yield english.died(english.CELL, 0, 3), "<sandbox.exit <sandbox.cell> 3>"
    yield english.died(english.CELL, 50, 0), "<sandbox.signal <sandbox.cell> <sandbox.number 50>>"
    for number, how in english.SIGNALS.items():
        yield english.died(english.CELL, number, 0), f"<sandbox.signal <sandbox.cell> <sandbox.{how.key}>>"
    yield english.not_shown("video/ogg"), "<sandbox.not_shown video/ogg>"
    yield english.not_shown(""), "<sandbox.not_shown <sandbox.nothing>>"


PLACES = ("cell", "call", "files", "start", "test")
SAID = list(sandbox_says())


def test_the_catalogue_speaks_as_the_sandbox_does():
    """It has each of its texts, in English the very same."""
    assert {key: text for key, text in messages.ENGLISH.items() if key.startswith("sandbox.")} == {
        f"sandbox.{key}": text for key, text in english.WORDS.items()
    }


@pytest.mark.parametrize("said", [said for said, _ in SAID])
def test_in_english_it_is_told_as_it_was_said(said):
    assert told(said) == str(said)


@pytest.mark.parametrize(("said", "other"), SAID)
def test_the_sandbox_is_told_in_another_language(marked, said, other):
    """Also what stands inside a sentence; and the sandbox itself goes on speaking English."""
    assert told(said) == other
    assert "<" not in said


def test_all_that_the_sandbox_says_was_tried():
    """The list above leaves out none."""
    keys = {key for _, other in SAID for key in re.findall(r"<sandbox\.(\w+)", other)}
    assert keys == set(english.WORDS)
    assert {signal.SIGSEGV, signal.SIGKILL, signal.SIGSYS} <= english.SIGNALS.keys()


def test_what_a_learner_wrote_is_not_translated(marked):
    """A text that only reads as one of the sandbox's stays as it is."""
    assert told("this cell") == "this cell"
    assert safe.bundle({"text/plain": "it was killed {what}"}) == {"text/plain": "it was killed {what}"}


def test_what_cannot_be_shown_is_told_in_the_notebook(marked):
    """From the sandbox's check of an output to the file that is written."""
    ((shown, _),) = outputs.outputs((("display_data", (("video/ogg", "x"),), (), ""),), 1000, 10)
    assert safe.outputs([shown])[0]["data"] == {"text/plain": "<sandbox.not_shown video/ogg>"}


# --- what grading says itself

BUSY = english.wall_time(english.CELL, 1.0)


class Scripted:
    """A session whose cells end as their first word says: ``ok``, ``timeout``, ``memory``, ``died``, ``refused``, ``error``."""

    stopped_by_clock = False

    def __init__(self):
        self.alive = True

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        self.alive = False

    def run_cell(self, source):
        status, _, more = source.partition(" ")
        if status == "fault":
            raise SandboxError("no zygote")
        if more == "busy":
            self.stopped_by_clock = True
        self.alive = status != "died"
        shown = [{"output_type": "stream", "name": "stdout", "text": "y" * limit.MOST_SHOWN}] if more == "much" else []
        return SimpleNamespace(outputs=shown, status=status, note=BUSY if more == "busy" else "")

    def call(self, name, arguments):
        raise CallFailed("timeout", english.cpu_time(english.CALL, 1.0))

    def call_all(self, name, sets, *, deadline):
        return [CallFailed("timeout", english.cpu_time(english.CALL, 1.0))]

    def files(self):
        return {}


def task(name, source="check(cylinder)", **more):
    return MasterCell(name, "code", source, checksum="0" * 32, locked=True, grade=True, points=2.0, **more)


def code(source, name=None):
    about = {} if name is None else {"nbgrader": {"grade_id": name}}
    return {"cell_type": "code", "source": source, "metadata": about, "id": name or "free"}


def written(*sources, tests=("ok",), session=Scripted, **options):
    """All texts in a graded notebook, and why cells of it have no mark."""
    names = [f"t{number}" for number in range(len(tests))]
    master = Master("nb", {name: task(name, source) for name, source in zip(names, tests, strict=True)}, {"name": "python3"})
    built = rebuild({"cells": [*map(code, sources), *(code("", name) for name in names)], "metadata": {}}, master)
    ran = run(built, session, catalogue.shipped().get, lambda name: b"hidden", **options)
    given = marks(built, ran)
    annotate(built, given)
    return " ".join([str(built.cells), *(one.note for one in given.values())])


def broken():
    raise SandboxError("no bubblewrap")


def tried(monkeypatch):
    """What grading writes, in all that it can meet."""
    for status in ENDED:
        yield written(status)
    yield written("error")
    yield written(tests=("timeout busy", "error"))
    yield written("fault", tests=("error", "check(cylinder)"))
    yield written(tests=("ok", "check(cylinder)"), session=broken)
    yield written(tests=("check(cylinder)",), seconds=-1.0)
    yield written(tests=("check(nothing_of_ours)",), uses_check=True)
    yield written(*(f"died {number}" for number in range(MAX_RESTARTS + 1)))
    yield written("ok much", "ok much")
    with monkeypatch.context() as patch:
        patch.setattr("autograder.notebook.run.judge", lambda *given, **more: 1 / 0)
        yield written(tests=("check(cylinder)",))
    verdict = SimpleNamespace(outcome="could not judge")
    runs = (None, CellRun("judged", verdict))
    yield " ".join(judged(one, 2.0).note for one in runs) + mark(code(""), task("t", "ok"), None).note
    yield " ".join(partial(shown, 2.0).note for shown in (None, "[1]", "nan", "7"))
    yield partial("[1]", 2.0, number=True).note + scored([], 2.0, number=True).note
    lost = {"output_type": "error", "ename": "NoAnswer", "evalue": messages.say("guest.cannot_leave", name="f", what="M")}
    yield scored([lost], 2.0).note
    yield from gone()
    yield from from_a_kernel()
    yield safe.text("x" * 20, 10)
    long = [
        {"output_type": "stream", "name": "stdout", "text": "y\n" * 30},
        {"output_type": "error", "ename": "E", "evalue": "", "traceback": ["x"] * 30},
    ]
    cut = {"cell_type": "code", "outputs": long}
    limit.limit_outputs([cut], 10, 10)
    yield str(cut)


def gone():
    """Cells that are missing, twice there, put back."""
    master = Master("nb", {"a": task("a"), "b": task("b")}, {"name": "python3"})
    twice = {"cells": [code("", "a"), code("", "a")], "metadata": {}}
    yield str([note.text for note in rebuild(twice, master).notes])
    yield str(rebuild(twice, master, add_missing=True).cells)


def from_a_kernel():
    """A notebook of which a real kernel showed nothing."""
    for ended in (None, SimpleNamespace(message=english.notebook_time(300.0))):
        built = rebuild({"cells": [code("", "t")], "metadata": {}}, Master("nb", {"t": task("t", "ok")}, {"name": "python3"}))
        runs = [CellRun("ok")]
        kernel.take(built, runs, SimpleNamespace(cells={}, files={}, ended=ended), frozenset())
        yield f"{built.cells} {runs[0].note}"


def test_all_that_grading_writes_is_in_the_catalogue(marked, monkeypatch):
    """Every text of it is said somewhere here, and no English is."""
    found = list(tried(monkeypatch))
    said = {key for text in found for key in re.findall(r"<(graded\.\w+(?:\.\w+)?)", text)}
    asked = {key for key in messages.ENGLISH if key.startswith("graded.")}
    assert asked - said == {"graded.no_response"}  # which goes to the gradebook, as a comment
    assert "<graded.kernel_lost <sandbox.notebook_time 300>>" in "".join(found)
    assert "<sandbox.wall_time <sandbox.cell> 1>" in "".join(found)
    left = re.sub(r"<[\w.]+", "", "".join(found))
    assert not re.search("stopped|not run|no mark|could not|runcated|cut here|missing|look", left)
