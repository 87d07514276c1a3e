"""The sandbox that an assignment needs: what learners may import there, how long a cell may take, one session a notebook."""

from __future__ import annotations

import contextlib
import dataclasses
import threading
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, Literal

from autograder.errors import IsolationError
from autograder.exercise import Exercise
from autograder.notebook.told import handed_over
from autograder.sandbox import Limits, Policy, Sandbox
from autograder.sandbox.kernel import KernelRun, run_notebook
from autograder.sandbox.packages import installed

Packages = tuple[str, ...] | Literal["all"]
ENVIRONMENT = {"NBGRADER_EXECUTION": "autograde"}
BASIC = ("numpy", "plotly")


def needs(exercises: Iterable[Exercise], packages: Packages, withhold: tuple[str, ...] = (), *, draws: bool = True) -> Policy:
    """What the sandbox offers: numpy, plotly and what exercises and course allow; all that is installed without exercises.

    Whether notebooks that pose no exercise draw with plotly decides only when it is loaded: once for all, or by who imports it.
    """
    posed = list(exercises)
    if packages == "all" or not (posed or packages):
        return Policy(packages="all") if posed or draws else Policy(packages="all", preload=())
    allowed = [package for exercise in posed for package in exercise.allow]
    withheld = [module for module in withhold if installed(module)]  # others lie beside the notebook, or are Python's own
    return Policy(packages=tuple(dict.fromkeys([*BASIC, *packages, *allowed, *withheld])))


def limits(timeout: float | None, *, exercises: bool) -> Limits:
    """The sandbox's limits with nbgrader's ``Execute.timeout`` as the CPU time of a cell; None: our own.

    Cells of an exercise notebook take milliseconds, and each that calls an endless loop takes all it may have: ten seconds are
    enough there. Nothing is known of the cells of an ordinary course, so they have the 30 seconds that nbgrader gives.
    """
    stock = Limits()
    own = Limits(cell_cpu=10.0) if exercises else Limits(cell_cpu=30.0, notebook_cpu=2.5 * stock.notebook_cpu)
    return own if timeout is None else dataclasses.replace(own, cell_cpu=timeout)


def environment(student: str) -> dict[str, str]:
    """What a notebook finds in its environment: nbgrader's word, the id of the student as on a JupyterHub, words of ours.

    So numbers of one's own (:mod:`autograder.personal`) are in grading what they were on the hub, where nobody typed an id.
    """
    return {**ENVIRONMENT, **handed_over(), **({"JUPYTERHUB_USER": student} if student else {})}


@dataclasses.dataclass(frozen=True)
class Opener:
    """Opens sessions in one running sandbox; ``level`` is the isolation that it has."""

    box: Sandbox
    bounds: Limits
    level: str
    withhold: tuple[str, ...] = ()

    def __call__(self, files: Mapping[str, bytes], student: str = "") -> Any:
        """A session that finds these files, without the modules that learners may not import; ``student`` hands in there."""
        return self.box.open(files=files, limits=self.bounds, environment=environment(student), withhold=self.withhold)

    def pair(self, files: Mapping[str, bytes], student: str = "") -> tuple[Any, Any]:
        """Such a session, and one beside it for test cells, which finds all modules."""
        return self.box.pair(files=files, limits=self.bounds, environment=environment(student), withhold=self.withhold)

    def kernel(self, files: Mapping[str, bytes], sources: Sequence[str | None], student: str = "") -> KernelRun:
        """A whole notebook in a real kernel, in a sandbox of its own with the same files, modules and limits."""
        return run_notebook(
            sources, files, policy=self.box.policy, limits=self.bounds, environment=environment(student), withhold=self.withhold
        )  # fmt: skip

    def trusted(self, files: Mapping[str, bytes]) -> Any:
        """A session for the instructor's own code: it finds all modules."""
        return self.box.open(files=files, limits=self.bounds, environment=ENVIRONMENT)


@contextlib.contextmanager
def opened(
    exercises: Iterable[Exercise],
    packages: Packages,
    level: str | None,
    timeout: float | None,
    withhold: Iterable[str] = (),
    *,
    draws: bool = True,
    begun: Begun | None = None,
    given: Iterable[Sequence[str]] = (),
) -> Iterator[Opener]:
    """Start the sandbox of an assignment; yields what opens a session in it, given the files that the notebook finds.

    ``withhold`` names modules that test cells may import and learners may not; ``draws`` is as in :func:`needs`; ``begun`` is
    a sandbox that starts already, and is taken if it is the right one; ``given`` are the code cells of each notebook as all
    learners were given them, never as the instructor has them.

    ``level`` None requires A or, where a machine gives no namespaces to a notebook of its own, A-. Which one it is stands in
    every report. Sessions may be opened from any thread.

    Raises
    ------
    IsolationError
        If this machine does not give the level.
    """
    posed, withheld = list(exercises), tuple(withhold)
    policy = needs(posed, packages, withheld, draws=draws)
    ready = begun.taken(policy, level) if begun is not None else None
    with ready or _sandbox(policy, level) as box:
        for cells in given:
            box.expect(cells)
        yield Opener(box, limits(timeout, exercises=bool(posed)), box.level, withheld)


class Begun:
    """A sandbox whose start nobody waits for: it is likely the one that will be needed, and the grader reads on meanwhile."""

    def __init__(self, policy: Policy, level: str | None) -> None:
        self._wanted = policy, level
        self._box: Sandbox | None = None
        self._thread = threading.Thread(target=self._start, name="sandbox, begun", daemon=True)
        self._thread.start()

    def __enter__(self) -> Begun:
        return self

    def __exit__(self, *exception: object) -> None:
        self._thread.join()
        if self._box is not None:
            self._box.close()

    def taken(self, policy: Policy, level: str | None) -> Sandbox | None:
        """The sandbox, which is the taker's from now on; None if another one is wanted, or it could not be started."""
        self._thread.join()
        if (policy, level) != self._wanted:
            return None
        box, self._box = self._box, None
        return box

    def _start(self) -> None:
        with contextlib.suppress(Exception):  # whoever needs one starts it again, and tells why that fails
            self._box = _sandbox(*self._wanted)


def _sandbox(policy: Policy, level: str | None) -> Sandbox:
    if level is not None:
        return Sandbox(policy=policy, level=level)
    best: IsolationError | None = None
    for possible in ("A", "A", "A-"):  # twice: a start that was disturbed from outside must not lead to a weaker level
        try:
            return Sandbox(policy=policy, level=possible)
        except IsolationError as error:
            best = best or error
    assert best is not None
    raise best
