"""Faults at random moments over a graded class; whatever happens, running again gives what one clean run gives.

    python tests/faults/fault_rounds.py [--faults 200] [--backend sqlite postgres dask dask-postgres] [--seed 0] [--keep FOLDER]

A class of thirteen (right, wrong, missing, broken, dying, slow, dated) is graded by a process that meets one fault; then, now
and then, somebody hands in again, somebody marks by hand, and the next grader meets the next fault. After every fault what is
there must be whole: in ``autograded/`` nothing but files that a clean run writes, in the gradebook one row of each and no mark
that a clean run does not give. After up to four faults a grader is left in peace, and the gradebook and every byte under
``autograded/`` must be those of a clean run, with every manual mark as it was given. Prints one line for each kind of fault and
ends with 1 if anything differed.

Full disks are tried on a small file system in memory and read-only folders as mounts where root runs this; by file size limits
and permissions elsewhere.
More than 400 lines: the faults, the class that meets them and what is compared afterwards make sense together only.
"""

import argparse
import collections
import contextlib
import difflib
import importlib
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import traceback
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT), str(ROOT / "lib")]

from autograder import fleet  # noqa: E402
from autograder.errors import DirectrixError  # noqa: E402
from tests.autograder.conftest import ORDINARY, ORDINARY_CONFIG, Classroom, PostgresClassroom, generated  # noqa: E402
from tests.autograder.fleet.dask_processes import Processes  # noqa: E402
from tests.autograder.postgres_server import Server  # noqa: E402
from tests.faults.faults import FAULTS, Scene, limited, unlimited  # noqa: E402

# A sandbox with few packages starts quickly, so that faults meet the grading and not its start.
CONFIG = ORDINARY_CONFIG + 'c.Directrix.packages = ("numpy",)\n'
HALF = "def half(x): return x / 2"
ADD = {"add": "def add(a, b): return a + b"}
NAP = "import time\ntime.sleep(0.06)\n"
# What each hands in first and, perhaps, a second time: the answer to `square`, and whether there is a second notebook.
CLASS = {
    "s00": (NAP + "def square(x): return x * x", NAP + "def square(x): return x + x"),
    "s01": (NAP + "def square(x): return 4", "def square(x): return x * x"),
    "s02": ("import os; os._exit(0)", "def square(x): return x ** 2"),
    "s03": (NAP + "def square(x) return x", NAP + "def square(x): return x * x"),
    "s04": (None, "def square(x): return x * x"),
    "s05": (NAP + "def square(x): return x * x", None),
    "s06": ("def square(x): return b'x' * (8 << 30)", NAP + "def square(x): return x * x"),
    "s07": ("open('notes.txt', 'w').write('n' * 3000)\ndef square(x): return x * x", "def square(x): return 'x'"),
    "s08": (NAP + "def square(x): return 144", NAP + "def square(x): return x * x"),
    "s09": (NAP + "print('out' * 400)\ndef square(x): return x * x", "def square(x): return -x"),
    "s10": ("broken", "def square(x): return x * x"),
    "s11": ("def square(x): return x * x", "broken"),
    "s12": (NAP + "def square(x): return x * x * (x < 9)", NAP + "def square(x): return x * x"),
}
MOST = 90.0  # seconds that a grader may take, whatever happens to it


class Differs(AssertionError):
    """What is there is not what a clean run gives."""


def hand_in(room, student, turn):
    answer = CLASS[student][turn]
    number = int(student[1:])
    one = "no notebook" if answer == "broken" else {"half": HALF, **({"square": answer} if answer else {})}
    notebooks = {"one": one, **({"two": ADD} if number % 3 else {})}
    room.hand_in(student, notebooks, files={"data.csv": b"1,2\n" * number}, timestamp=f"2027-0{1 + turn}-01 10:00:00")


def rows(tables):
    """Grades and comments by student, notebook, cell and kind, without what manual work decides."""
    grades, comments = {}, {}
    for student, notebook, cell, kind, auto, manual, extra, look in tables["grades"]:
        key = (student, notebook, cell, kind)
        if key in grades:
            raise Differs(f"two grades of {key}")
        grades[key] = (auto, manual, extra, look)
    for student, notebook, cell, auto, manual in tables["comments"]:
        comments.setdefault((student, notebook, cell), []).append((auto, manual))
    return grades, comments


class Reference:
    """What a clean run gives when everybody has handed in once, and when everybody has twice."""

    def __init__(self, template, scratch):
        self.grades, self.comments, self.files, self.seconds = [], [], [], []
        for turn in (0, 1):
            room = template.copy(scratch / f"reference{turn}")
            for student in CLASS:
                hand_in(room, student, turn)
            started = time.monotonic()
            process = Grader(room, None, 2)
            if process.wait(MOST) not in (0, 1):
                raise Differs(f"the clean run itself failed:\n{process.said()}")
            self.seconds.append(time.monotonic() - started)
            remembered = room.folder / ".directrix" / "apart"
            shutil.copytree(remembered, template.folder / ".directrix" / "apart", dirs_exist_ok=True)
            grades, comments = rows(room.tables())
            self.grades.append(grades)
            self.comments.append(comments)
            self.files.append(room.autograded())


class Grader:
    """A grader as a process of its own, forked so that it starts quickly, in a session of its own."""

    logs = Path()  # away from the disk that is filled

    def __init__(self, room, scheduler, workers, *, force=False, prepare=None):
        self.log = self.logs / f"{room.folder.name}.log"
        self.began = self.log.stat().st_size if self.log.exists() else 0
        self.status = None
        blocked = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGTERM, signal.SIGINT})  # a signal that comes at once
        self.pid = os.fork()
        if self.pid == 0:
            self._grade(room, scheduler, workers, force, prepare, blocked)
        signal.pthread_sigmask(signal.SIG_SETMASK, blocked)

    def _grade(self, room, scheduler, workers, force, prepare, signals):
        code = 70
        try:
            signal.signal(signal.SIGTERM, signal.SIG_DFL)
            signal.signal(signal.SIGINT, signal.default_int_handler)
            signal.pthread_sigmask(signal.SIG_SETMASK, signals)
            os.setsid()
            descriptor = os.open(self.log, os.O_WRONLY | os.O_CREAT | os.O_APPEND)
            os.dup2(descriptor, 1)
            os.dup2(descriptor, 2)
            module = importlib.import_module("autograder.fleet.grade")
            module.BATCH, module.BATCH_SECONDS = 3, 0.3
            importlib.import_module("autograder.gradebook.engine").BUSY_SECONDS = 2
            if prepare is not None:
                prepare()
            graded = fleet.grade(room.course(), room.assignment, workers=workers, force=force, scheduler=scheduler)
            unlimited()
            statuses = collections.Counter(student.status for student in graded.students)
            print(json.dumps({"statuses": statuses, "faults": graded.faults}), flush=True)
            code = 1 if graded.failures else 0
        except DirectrixError as error:
            unlimited()
            print(f"directrix: {error}", flush=True)
            code = 1
        except KeyboardInterrupt:
            code = 130
        except BaseException:
            unlimited()
            traceback.print_exc()
        finally:
            os._exit(code)

    def wait(self, seconds):
        """Its exit code, negative for a signal; None while it runs."""
        deadline = time.monotonic() + seconds
        while self.status is None:
            pid, status = os.waitpid(self.pid, os.WNOHANG)
            if pid:
                self.status = os.waitstatus_to_exitcode(status)
            elif time.monotonic() > deadline:
                return None
            else:
                time.sleep(0.005)
        return self.status

    def said(self):
        with contextlib.suppress(OSError), self.log.open("rb") as file:
            file.seek(self.began)
            return file.read().decode("utf-8", "replace")
        return ""


class Backend:
    """Where marks go and who grades: copies of the class over SQLite or PostgreSQL, on this machine or on a Dask cluster."""

    def __init__(self, name, scratch, stack):
        self.name, self.scratch = name, scratch
        self.server = stack.enter_context(contextlib.closing(Server())) if "postgres" in name else None
        self.cluster = stack.enter_context(Processes(scratch / "cluster", 2, tls=True)) if "dask" in name else None
        if self.cluster is not None:
            os.environ.update(self.cluster.certificates)
            import dask.config

            dask.config.refresh()
        database = self.server.create() if self.server is not None else None
        folder = scratch / "template"
        generated(folder, CONFIG, ORDINARY, "ps1", self.server.url(database) if database else None)
        if self.server is not None:
            self.template = PostgresClassroom(folder, "ps1", self.server, database)
        else:
            self.template = Classroom(folder, "ps1")
        self.template.course().secret()
        self.rooms = stack.enter_context(small_disk(scratch / "rooms"))

    @property
    def scheduler(self):
        return self.cluster.address if self.cluster is not None else None

    def fresh(self):
        shutil.rmtree(self.rooms / "course", ignore_errors=True)
        room = self.template.copy(self.rooms / "course")
        for student in CLASS:
            hand_in(room, student, 0)
        return room

    def done_with(self, room):
        if self.server is not None:
            self.server.sql(f"drop database {room.database} with (force)")


@contextlib.contextmanager
def small_disk(place):
    """A file system in memory of 24 MB where root may make one, else a folder."""
    place.mkdir()
    mounted = os.geteuid() == 0 and not subprocess.run(
        ["mount", "-t", "tmpfs", "-o", "size=24m", "tmpfs", place], check=False, capture_output=True
    ).returncode  # fmt: skip
    try:
        yield place
    finally:
        if mounted:
            subprocess.run(["umount", "-l", place], check=False)


class Round:
    """One class under faults until it is left in peace."""

    def __init__(self, backend, reference, chance, counts):
        self.backend, self.reference, self.chance, self.counts = backend, reference, chance, counts
        self.room = backend.fresh()
        self.turn = dict.fromkeys(CLASS, 0)
        self.manual = {}
        self.story = []
        self.force = False

    def run(self, faults):
        for kind in faults:
            self._fault(kind)
            self._whole()
            self._meanwhile()
        self._in_peace()
        self.backend.done_with(self.room)

    def _start(self, prepare=None):
        self.force = self.force or self.chance.random() < 0.3
        return Grader(self.room, self.backend.scheduler, self.chance.choice([1, 2, 3]), force=self.force, prepare=prepare)

    def _fault(self, kind):
        moment = self.chance.uniform(0.02, 1.1) * self.reference.seconds[1]
        limit = (lambda: limited(self.chance)) if kind == "file too large" else None
        grader = self._start(limit)
        scene = Scene(self.room, grader.pid, self.chance, self.backend.cluster)
        started = []
        scene.start = lambda: started.append(self._start()) or started[-1].pid
        try:
            ended = grader.wait(moment) if limit is None else None
            done = ended is None and (limit is not None or FAULTS[kind](scene))
            code = grader.wait(MOST)
            if code is None:
                os.killpg(grader.pid, signal.SIGKILL)
                raise Differs(f"after {kind} the grader did not end in {MOST} s:\n{grader.said()}")
            for other in started:
                if other.wait(MOST) not in (0, 1):
                    raise Differs(f"a second grader ended with {other.status}:\n{other.said()}")
        finally:
            scene.undo.close()
        self.story.append(
            f"{kind}{'' if done else ' (too late)'} at {moment:.2f} s of a{' forced' if self.force else ''} run -> {code}"
        )
        self.counts[kind][0 if done else 1] += 1
        if code == 70:
            raise Differs(f"after {kind} the grader ended with an error of its own:\n{grader.said()}")
        if code == 0:
            self.force = False

    def _meanwhile(self):
        """Somebody hands in again; an instructor marks by hand."""
        if self.chance.random() < 0.4:
            student = self.chance.choice(sorted(CLASS))
            if self.turn[student] == 0:
                self.turn[student] = 1
                hand_in(self.room, student, 1)
                self.story.append(f"{student} hands in again")
        grades, _ = rows(self.room.tables())
        if grades and self.chance.random() < 0.6:
            for key in self.chance.sample(sorted(grades), min(2, len(grades))):
                points = self.chance.choice([0.25, 0.5, 1.0])
                student, notebook, cell, kind = key
                self.room.sql(
                    f"update grade set manual_score = {points}, extra_credit = 0.125, needs_manual_grade = "
                    f"{'false' if self.backend.server else 0} where cell_id in (select b.id from base_cell b join notebook n "
                    f"on b.notebook_id = n.id where b.name = '{cell}' and n.name = '{notebook}' and b.type = '{kind}') and "
                    "notebook_id in (select sn.id from submitted_notebook sn join submitted_assignment s on "
                    f"sn.assignment_id = s.id where s.student_id = '{student}')"
                )
                self.manual[key] = (points, 0.125)
                self.story.append(f"{student}'s {cell} is marked by hand")

    def _expected(self, what):
        return {key: value for turn in (0, 1) for key, value in what[turn].items() if self.turn[_student(key)] == turn}

    def _whole(self):
        """After a fault: nothing half-written, nothing twice, no mark that a clean run does not give, no manual one lost."""
        files = self.room.autograded()
        for name, data in files.items():
            known = ".directrix-" in name or any(clean.get(name) == data for clean in self.reference.files)
            if not known and not self._unjudged(name.split("/")[0]):
                raise Differs(f"autograded/{name} is nothing that a clean run writes: {self._difference(name, data)}")
        for student in {name.split("/")[0] for name in files if ".directrix-" not in name}:
            mine = {name for name in files if name.startswith(f"{student}/ps1/")}
            whole = [{name for name in clean if name.startswith(f"{student}/ps1/")} for clean in self.reference.files]
            if mine and mine not in whole and not self._unjudged(student):
                raise Differs(f"autograded/{student} is not whole: {sorted(mine)}")
        grades, comments = rows(self.room.tables())
        for key, (auto, manual, extra, _) in grades.items():
            if auto is not None and all(known.get(key, (0,))[0] != auto for known in self.reference.grades):
                raise Differs(f"{key} has the mark {auto}, which no clean run gives")
            self._manual_kept(key, manual, extra)
        self._once(comments)

    def _difference(self, name, data):
        """The first lines in which a file is not the clean run's."""
        clean = self.reference.files[self.turn[name.split("/")[0]]].get(name, b"")
        lines = [text.decode("utf-8", "replace").splitlines() for text in (clean, data)]
        return list(difflib.unified_diff(*lines, n=0, lineterm=""))[3:9]

    def _unjudged(self, student):
        """Whether its journal says that something of it could not be judged, so that the next run grades it again."""
        path = self.room.folder / ".directrix" / "graded" / "ps1" / f"{student}.json"
        with contextlib.suppress(OSError, ValueError):
            entry = json.loads(path.read_text())
            return bool(entry.get("begun") or entry["report"]["faults"])
        return False

    def _manual_kept(self, key, manual, extra):
        if (manual, extra) != self.manual.get(key, (None, None)):
            raise Differs(f"{key} was marked by hand with {self.manual.get(key)} and has {manual}, {extra}")

    def _once(self, comments):
        twice = [key for key, found in comments.items() if len(found) > 1]
        if twice:
            raise Differs(f"two comments on {twice[0]}")

    def _in_peace(self):
        for _ in range(2):  # the second finds nothing to do
            grader = Grader(self.room, self.backend.scheduler, 2)
            code = grader.wait(MOST)
            if code not in (0, 1) or '"faults": []' not in grader.said():
                raise Differs(f"left in peace, the grader ended with {code}:\n{grader.said()}")
        grades, comments = rows(self.room.tables())
        wanted = self._expected(self.reference.grades)
        if grades.keys() != wanted.keys():
            raise Differs(f"rows of grades differ: {sorted(grades.keys() ^ wanted.keys())[:4]}")
        for key, (auto, manual, extra, look) in grades.items():
            self._manual_kept(key, manual, extra)
            if (auto, look if key not in self.manual else None) != (
                wanted[key][0],
                wanted[key][3] if key not in self.manual else None,
            ):
                raise Differs(f"{key} has {auto}, look {look}; a clean run gives {wanted[key]}")
        self._once(comments)
        if comments != self._expected(self.reference.comments):
            raise Differs("comments differ from a clean run's")
        files, clean = self.room.autograded(), self._expected(self.reference.files)
        if files != clean:
            different = sorted(name for name in files.keys() | clean.keys() if files.get(name) != clean.get(name))
            shown = self._difference(different[0], files.get(different[0], b""))
            raise Differs(f"autograded/ differs from a clean run's in {different[:4]}: {shown}")


def _student(key):
    return key.split("/")[0] if isinstance(key, str) else key[0]


def campaign(name, faults, seed, scratch, counts, problems):
    """Run that many faults over one backend; ``counts`` gets how many were done and came too late by kind."""
    Grader.logs = scratch
    chance = random.Random(f"{name} {seed}")
    with contextlib.ExitStack() as stack:
        backend = Backend(name, scratch, stack)
        lite = backend.template
        if backend.server is not None:  # a clean run over SQLite is the measure for both
            lite = Classroom(generated(scratch / "lite", CONFIG, ORDINARY, "ps1"), "ps1")
            shutil.copytree(backend.template.folder / ".directrix", lite.folder / ".directrix")
        reference = Reference(lite, scratch)
        apart = ".directrix/apart"  # how test cells run is tried once, not by each round's first grader
        if lite is not backend.template:
            shutil.copytree(lite.folder / apart, backend.template.folder / apart)
        kinds = [kind for kind in FAULTS if (kind != "database server crashed") or backend.server is not None]
        queue = []
        left = faults
        while left > 0:
            many = min(left, chance.choice([1, 2, 3, 3, 4]))
            while len(queue) < many:
                queue += chance.sample(kinds, len(kinds))
            one = Round(backend, reference, chance, counts)
            try:
                one.run([queue.pop() for _ in range(many)])
            except Differs as error:
                problems.append(f"{name}: {error}\n  after: " + "; ".join(one.story))
                print(problems[-1], flush=True)
            left -= many


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--faults", type=int, default=200, help="in all, shared by the backends")
    choices = ["sqlite", "postgres", "dask", "dask-postgres"]
    parser.add_argument("--backend", nargs="+", choices=choices, default=choices)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args(arguments)
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # so that servers and mounts are taken down
    os.environ["PATH"] = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    failed = 0
    for number, name in enumerate(options.backend):
        share = options.faults * (number + 1) // len(options.backend) - options.faults * number // len(options.backend)
        started = time.monotonic()
        counts, problems = collections.defaultdict(lambda: [0, 0]), []
        try:
            with tempfile.TemporaryDirectory(prefix="directrix-faults-") as scratch:
                campaign(name, share, options.seed, Path(scratch), counts, problems)
        finally:  # also of one that was ended before its time
            failed += len(problems)
            done = sum(hit for hit, _ in counts.values())
            late = sum(late for _, late in counts.values())
            print(f"{name}: {done} faults, {late} too late, {len(problems)} differences, {time.monotonic() - started:.0f} s")
            for kind, (hit, missed) in sorted(counts.items()):
                print(f"  {kind:34}{hit:>4}{f' ({missed} too late)' if missed else ''}", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
