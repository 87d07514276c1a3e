"""Ordinary test cells apart from the code that they test: which can be, and running them so.

Asserts in the learner's interpreter can be patched, read and forged. So a test cell runs, where it can, in a second process:
that one runs the instructor's source notebook without its solution cells, and what those cells bind (functions, data; never
builtins, imports or names of other cells) is the learner's, across a socket (``autograder.sandbox.guest.peer``). The learner's
process never sees the test.

Not every cell can: one that looks at a learner's class, or reads the text of a function, needs the objects themselves. Whether
a cell can is tried, before any submission is read, with the solution in ``source/``: it must get the same mark both ways. Where
trying would not tell, its text does (``autograder.notebook.reach``).
"""

from __future__ import annotations

import ast
import contextlib
import dataclasses
import functools
import hashlib
import json
import re
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from autograder.errors import CourseError
from autograder.notebook.marks import returns_number, scored
from autograder.notebook.master import Master, MasterCell, checksum
from autograder.notebook.reach import reaching

MODES = ("calibrated", "apart", "shared")
Pair = Callable[[], tuple[Any, Any]]
ROUNDS = 6  # of trying; what still changes its mark then is shared
VERSION = 4  # of what is remembered and of what can cross: raise it when either changes


@dataclass(frozen=True)
class Step:
    """A code cell of the instructor's source notebook. ``solution``: its text is the learner's to write."""

    name: str
    source: str
    solution: bool = False
    test: bool = False


@dataclass(frozen=True)
class Script:
    """How the test cells of a notebook are run.

    Attributes
    ----------
    steps : the instructor's code cells, in order
    names : what the solution cells bind and the others mention
    apart : grade ids of test cells that run apart
    shared : the other ordinary test cells, with the reason
    numbers : grade ids of ordinary test cells that return a number of points with the solution
    engine : "ipython", or "jupyter": what the notebook shows comes from a real kernel (``autograder.notebook.kernel``)
    """

    steps: tuple[Step, ...] = ()
    names: tuple[str, ...] = ()
    apart: frozenset[str] = frozenset()
    shared: Mapping[str, str] = field(default_factory=dict)
    numbers: frozenset[str] = frozenset()
    engine: str = "ipython"


class Tests:
    """The tests' process of one submission, beside the learner's.

    Parameters
    ----------
    script : Script
        How the notebook's tests are run.
    learner, tests : sessions
        Opened together.
    done : sequence of (int, str)
        What an earlier pair of processes had run, to be run again: the number of the step (-1: a test cell) and its text.
    """

    def __init__(self, script: Script, learner: Any, tests: Any, done: Sequence[tuple[int, str]] = ()) -> None:
        self.script, self.learner, self.session = script, learner, tests
        self.done: list[tuple[int, str]] = []
        for number, source in done:
            self._run(number, source)

    @property
    def alive(self) -> bool:
        """Whether more cells can be run."""
        return bool(self.session.alive and self.learner.alive)

    def run(self, name: str, source: str) -> Any:
        """Run a test cell, after the instructor's cells that come before it; returns its CellResult."""
        ran = {number for number, _ in self.done}
        for number, step in enumerate(self.script.steps):
            if step.name == name:
                break
            if not step.test and number not in ran:
                text = _imports(step.source) if step.solution else step.source
                if text and not text.isspace():  # an empty cell does nothing and has no number
                    self._run(number, text)
        return self._run(-1, source)

    def _run(self, number: int, source: str) -> Any:
        result = self.session.run_apart(source, self.script.names, self.learner)
        if self.alive:
            self.done.append((number, source))
        return result


@dataclass(frozen=True)
class Apart:
    """What running a notebook's tests apart takes: the script, what opens (learner's, tests') sessions, and a real kernel."""

    script: Script
    open_pair: Pair
    kernel: Callable[[Sequence[str | None]], Any] | None = None  # runs the sources of a notebook's cells


def prepare(
    source: Path,
    master: Master,
    *,
    judged: Collection[str],
    open_session: Callable[[], contextlib.AbstractContextManager[Any]],
    open_pair: Pair,
    mode: str = "calibrated",
    memory: Path | None = None,
    settings: object = None,
) -> Script:
    """How the test cells of a notebook are to be run; tried with the instructor's solution unless it is remembered.

    Parameters
    ----------
    source : path
        The instructor's notebook with solutions.
    master : Master
        The cells as the gradebook has them.
    judged : collection of str
        The names whose ``check(name)`` is judged, not run.
    open_session, open_pair : callable
        A session that withholds nothing, and the pair (learner's, tests') that submissions get.
    mode : {"calibrated", "apart", "shared"}
        "apart" and "shared" insist.
    memory : path, optional
        File that remembers what came of it, for this text of the notebook and these ``settings``.

    Raises
    ------
    CourseError
        If the mode is none, if it is "apart" and a cell cannot be, or if a shared cell fails for want of a withheld module.
    """
    if mode not in MODES:
        raise CourseError(f"c.Sandbox.tests must be one of {', '.join(MODES)}; got {mode!r}")
    ordinary = {cell.name: cell for cell in master.graded if _is_test(cell, judged)}
    if not ordinary or mode == "shared":
        return Script(shared=dict.fromkeys(ordinary, "the course says so"))
    try:
        text = source.read_bytes()
        steps = tuple(_steps(json.loads(text), ordinary))
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return _insisted(Script(shared=dict.fromkeys(ordinary, f"there is no {source.name} in source/ to try it with")), mode)
    key = hashlib.sha256(json.dumps([VERSION, text.hex(), master.digest, repr(settings)]).encode()).hexdigest()
    script = _remembered(memory, key)
    if script is None:
        trial = _Trial(steps, ordinary, open_session, open_pair)
        script = dataclasses.replace(trial.settle(), steps=steps, numbers=frozenset(trial.numbers))
        _remember(memory, key, script)
    return _insisted(dataclasses.replace(script, steps=steps, names=_names(steps, script.shared)), mode)


def _is_test(cell: MasterCell, judged: Collection[str]) -> bool:
    return cell.cell_type == "code" and not cell.solution and cell.exercise not in judged


def _insisted(script: Script, mode: str) -> Script:
    if mode == "apart" and script.shared:
        why = "; ".join(f"{name}: {reason}" for name, reason in script.shared.items())
        raise CourseError(
            f"the course insists that test cells run apart (c.Sandbox.tests = 'apart'), and these cannot: {why}. "
            "Change those cells, or say 'calibrated'"
        )
    return script


def _steps(notebook: Mapping[str, Any], ordinary: Mapping[str, MasterCell]) -> Iterator[Step]:
    """The code cells of a source notebook."""
    for cell in notebook["cells"]:
        if cell["cell_type"] != "code":
            continue
        source = cell["source"] if isinstance(cell["source"], str) else "".join(cell["source"])
        about = cell.get("metadata", {}).get("nbgrader", {})
        name = str(about.get("grade_id", ""))
        solution, graded = bool(about.get("solution")), bool(about.get("grade"))
        if graded and not solution and name not in ordinary:
            continue  # an exercise's cell: judged, not run
        yield Step(name, source, solution, graded and not solution)


@dataclass
class _Trial:
    """Runs the instructor's own solution, with the tests beside it and with the tests apart."""

    steps: tuple[Step, ...]
    ordinary: Mapping[str, MasterCell]
    open_session: Callable[[], contextlib.AbstractContextManager[Any]]
    open_pair: Pair
    numbers: set[str] = field(default_factory=set)  # that return one

    def settle(self) -> Script:
        """Which cells run apart."""
        shared: dict[str, str] = {}
        wanted = self._together()
        texts = {step.name: step.source for step in self.steps if step.test}
        for name, cell in self.ordinary.items():
            if name not in texts:
                shared[name] = "the notebook in source/ has no such cell"
            elif cell.checksum and checksum("code", texts[name], cell) != cell.checksum:
                shared[name] = "the notebook in source/ has another text of it than the gradebook"
            elif wanted[name][0] != float(cell.points or 0.0):
                shared[name] = f"the solution in source/ does not pass it: {wanted[name][1]}"
        reaching = self._reaching()
        shared = reaching | shared
        for _ in range(ROUNDS):
            names = _names(self.steps, shared)
            script = Script(self.steps, names, frozenset(self.ordinary) - shared.keys(), dict(shared))
            got = self._apart(script)
            worse = {
                name: why
                for name, (points, why) in got.items()
                if (_less(points, wanted[name][0]) if name in shared else points != wanted[name][0])
            }
            if not worse:
                return script
            lost = next((name for name in worse if name in shared), None)
            shared |= {name: why for name, why in worse.items() if name not in shared}
            if lost is None:
                continue
            if reaching.pop(lost, None):  # it needs a withheld module, say: apart after all, if it can be
                del shared[lost]
                continue
            before = [step.name for step in self.steps[: [step.name for step in self.steps].index(lost)] if step.test]
            if any(name not in shared for name in before):  # one of these may bind what it needs
                shared |= {name: f"{lost}, which shares, may need what it leaves" for name in before if name not in shared}
            elif _less(self._apart(script)[lost][0], wanted[lost][0]):  # and not by chance
                raise CourseError(
                    f"the test cell {lost} has to share the learner's process ({shared[lost]}), where the solution "
                    f"in source/ fails it: {worse[lost]}. Does it need a withheld module?"
                )
        return Script(self.steps, (), frozenset(), {name: shared.get(name, "unsteady") for name in self.ordinary})

    def _reaching(self) -> dict[str, str]:
        """Test cells of which trying would not show that they need the learner's process."""
        tests = {step.name: _parsed(step.source) for step in self.steps if step.test}
        others = [_parsed(step.source) for step in self.steps if not step.test and not step.solution]
        return reaching(tests, others, [_parsed(step.source) for step in self.steps if step.solution])

    def _together(self) -> dict[str, tuple[float | None, str]]:
        marks = {}
        with self.open_session() as session:
            for step in self.steps:
                result = session.run_cell(step.source)
                if step.test:
                    marks[step.name] = self._mark(step, result)
                    self.numbers |= {step.name} if returns_number(result.outputs) else set()
        return marks

    def _apart(self, script: Script) -> dict[str, tuple[float | None, str]]:
        learner, second = self.open_pair()
        with learner, second:
            tests = Tests(script, learner, second)
            marks = {}
            for step in self.steps:
                if step.test and step.name in script.apart:
                    marks[step.name] = self._mark(step, tests.run(step.name, step.source))
                    continue
                result = learner.run_cell(step.source)
                if step.test and step.name in script.shared:
                    marks[step.name] = self._mark(step, result)
            return {name: mark for name, mark in marks.items() if self.ordinary.get(name) is not None}

    def _mark(self, step: Step, result: Any) -> tuple[float | None, str]:
        """Points, and in one line why not more."""
        points = float(self.ordinary[step.name].points or 0.0)
        errors = [output for output in result.outputs if output["output_type"] == "error"]
        if result.status != "ok":
            said = f"{errors[-1]['ename']}: {errors[-1]['evalue']}" if errors else result.note or result.status
            return 0.0, " ".join(said.split())[:200]
        return scored(result.outputs, points).points, "it prints to stderr, or returns another number of points"


def _less(points: float | None, than: float | None) -> bool:
    return (points or 0.0) < (than or 0.0)


def _names(steps: Sequence[Step], shared: Collection[str]) -> tuple[str, ...]:
    """What solution cells bind and the instructor's other cells mention, less what those bind themselves.

    Test cells that share the learner's process are not run in the tests', so what they bind is the learner's there.
    """
    bound: set[str] = set()
    others: set[str] = set()
    mentioned: set[str] = set()
    for step in steps:
        tree = _parsed(step.source)
        if step.test and step.name in shared:
            continue
        if step.solution:
            bound |= set(_bound(tree.body))
        else:
            others |= set(_bound(tree.body))
            mentioned |= set(re.findall(r"[^\W\d]\w*", step.source))
    imported = {alias for step in steps for alias in _imported(_parsed(step.source))}
    return tuple(sorted((bound & mentioned) - others - imported))


def _parsed(source: str) -> ast.Module:
    """The cell without its magics; nothing if it is no Python."""
    plain = re.sub(r"^\s*[%!].*$", "", source, flags=re.MULTILINE)
    try:
        return ast.parse(plain)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return ast.Module([], [])


def _imported(tree: ast.Module) -> Iterator[str]:
    for node in tree.body:
        if isinstance(node, ast.Import | ast.ImportFrom):
            yield from ((alias.asname or alias.name).partition(".")[0] for alias in node.names)


@functools.lru_cache(maxsize=1000)
def _imports(source: str) -> str:
    """The imports of a solution cell, which the instructor's tests may lean on."""
    nodes = [node for node in _parsed(source).body if isinstance(node, ast.Import | ast.ImportFrom)]
    return "\n".join(ast.unparse(node) for node in nodes)


def _bound(body: Sequence[ast.stmt]) -> Iterator[str]:
    """Names that statements bind at the top level of a notebook; imports apart."""
    for node in body:
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            yield node.name
            continue
        if isinstance(node, ast.Import | ast.ImportFrom):
            continue
        for part in _outside_functions(node):
            if isinstance(part, ast.Name) and isinstance(part.ctx, ast.Store):
                yield part.id
            elif isinstance(part, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
                yield part.name


def _outside_functions(node: ast.AST) -> Iterator[ast.AST]:
    yield node
    if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef | ast.Lambda | ast.GeneratorExp | ast.ListComp):
        return
    for child in ast.iter_child_nodes(node):
        yield from _outside_functions(child)


def _remembered(memory: Path | None, key: str) -> Script | None:
    if memory is None:
        return None
    try:
        kept = json.loads(memory.read_text("utf-8"))
        if kept["key"] != key:
            return None
        shared = {str(name): str(why) for name, why in kept["shared"].items()}
        return Script(apart=frozenset(map(str, kept["apart"])), shared=shared, numbers=frozenset(map(str, kept["numbers"])))
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return None


def _remember(memory: Path | None, key: str, script: Script) -> None:
    if memory is None:
        return
    kept = {"key": key, "apart": sorted(script.apart), "shared": dict(script.shared), "numbers": sorted(script.numbers)}
    text = json.dumps(kept, indent=1)
    with contextlib.suppress(OSError):  # it is tried again next time
        memory.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        fresh = memory.with_name(memory.name + ".new")
        fresh.write_text(text, "utf-8")
        fresh.replace(memory)
