"""Grading on a Dask cluster over TLS: what comes out, what workers are given, what is lost with one, who is refused."""

import contextlib
import importlib
import os
import pickle
import signal
import time
import tracemalloc
from types import SimpleNamespace

import dask
import distributed
import pytest

from autograder import fleet
from autograder.errors import CourseError
from autograder.fleet.connection import connected, safe
from tests.autograder.fleet.dask_processes import Processes

RIGHT = {"square": "def square(x): return x * x", "half": "def half(x): return x / 2"}
ADD = {"add": "def add(a, b): return a + b"}
SLOW = "import time\ntime.sleep(0.4)\ndef square(x): return x * x"
CYLINDER = (
    "def cylinder(u, w, r, h):\n    u, w = np.broadcast_arrays(u, w)\n    a = 2 * np.pi * u\n"
    "    return np.stack([r * np.cos(a), r * np.sin(a), h * w], axis=-1)"
)


@pytest.fixture(scope="module")
def cluster(tmp_path_factory):
    with Processes(tmp_path_factory.mktemp("dask") / "cluster", 2) as running:
        yield running


@pytest.fixture(autouse=True)
def _certificates(request, monkeypatch):
    """This process is the client: Dask reads its certificates from the environment when it is imported."""
    if "cluster" in request.fixturenames:
        running = request.getfixturevalue("cluster")
        names = {"ca-file": "ca.pem", "client.cert": "ca.pem", "client.key": "key.pem"}
        with dask.config.set({f"distributed.comm.tls.{name}": str(running.folder / "tls" / at) for name, at in names.items()}):
            yield
    else:
        yield


@pytest.fixture
def two_workers(cluster):
    """Both workers up, also after a test has killed one."""
    deadline = time.monotonic() + 90
    with connected(cluster.address) as client:
        while len(client.nthreads()) < 2:
            assert time.monotonic() < deadline, cluster.logs()
            time.sleep(0.1)
    return cluster


def hand_in(room, count, square=RIGHT["square"]):
    room.configure('c.Directrix.packages = ("numpy",)\n')  # starts quickly
    for number in range(count):
        room.hand_in(
            f"s{number:02d}", {"one": {**RIGHT, "square": square if number % 3 else "def square(x): return 4"}, "two": ADD}
        )


def test_what_was_sent_is_not_kept(two_workers):
    """Dask's own log of messages would hold the last thousand batches of submissions."""
    size, count = 50_000, 40
    with connected(two_workers.address) as client:
        client.submit(len, os.urandom(size), pure=False).result()  # what is loaded once
        tracemalloc.start()
        try:
            for _ in range(count):
                assert client.submit(len, os.urandom(size), pure=False).result() == size
            held, _ = tracemalloc.get_traced_memory()
        finally:
            tracemalloc.stop()
    assert held < 0.2 * count * size, f"{held / count:.0f} bytes of each message"


def test_a_class_has_the_marks_and_files_that_this_machine_gives(two_workers, ordinary, tmp_path):
    hand_in(ordinary, 9)
    ordinary.hand_in("broken", {"one": "no notebook"})
    ordinary.hand_in("dateless", {"one": RIGHT}, timestamp="the other day")
    ordinary.course().secret()
    local = ordinary.copy(tmp_path / "local")
    mine = fleet.grade(local.course(), "ps1", workers=1)
    graded = fleet.grade(ordinary.course(), "ps1", scheduler=two_workers.address)
    assert graded.level == mine.level
    assert [(s.student, s.status, s.score, s.broken) for s in graded.students] == [
        (s.student, s.status, s.score, s.broken) for s in mine.students
    ]
    assert ordinary.tables() == local.tables()
    assert ordinary.autograded() == local.autograded()
    assert {s.status for s in fleet.grade(ordinary.course(), "ps1", scheduler=two_workers.address).students} == {
        "unchanged", "broken"
    }  # fmt: skip


def test_exercises_are_judged_there_and_no_secret_crosses(two_workers, surfaces, tmp_path, monkeypatch):
    """What is sent is looked at: no course secret, no path of the course, of each submission its own files and seeds."""
    module = importlib.import_module("autograder.fleet.cluster")
    crossed = []
    real = module.Cluster.__init__

    def watched(self, client, job, *others):
        crossed.append(pickle.dumps(job))
        submit = client.submit
        monkeypatch.setattr(client, "submit", lambda *args, **kwargs: crossed.append(args[2]) or submit(*args, **kwargs))
        real(self, client, job, *others)

    monkeypatch.setattr(module.Cluster, "__init__", watched)
    monkeypatch.setattr(module, "BATCH", 1)
    surfaces.hand_in("id-4711", {"known-forms": {"cylinder": CYLINDER}})
    surfaces.hand_in("id-0815", {"known-forms": {"cylinder": CYLINDER.replace("2 * np.pi", "np.pi")}})
    secret = surfaces.course().secret()
    local = surfaces.copy(tmp_path / "local")
    mine = fleet.grade(local.course(), "A1", workers=1)
    graded = fleet.grade(surfaces.course(), "A1", scheduler=two_workers.address)
    assert (graded.student("id-4711").score, graded.student("id-0815").score) == (4.0, mine.student("id-0815").score)
    assert graded.student("id-0815").score < 4.0
    assert surfaces.tables() == local.tables()
    assert surfaces.autograded() == local.autograded()
    job, *batches = crossed
    assert len(batches) == 2
    for data in crossed:
        assert secret not in data
        assert secret.hex().encode() not in data
        assert str(surfaces.folder).encode() not in data
    for data, other in zip(sorted(batches, key=lambda data: b"id-4711" in data), (b"id-4711", b"id-0815"), strict=True):
        assert other not in data
    assert b"def cylinder" in job  # the reference goes with the assignment


def test_a_worker_that_is_killed_costs_nothing(two_workers, ordinary, tmp_path):
    ordinary.course().secret()
    hand_in(ordinary, 12, SLOW)
    local = ordinary.copy(tmp_path / "local")
    victims = two_workers.workers()
    assert len(victims) == 2
    killed = []

    def kill(done, total, student):
        if done == 2:
            killed.append(victims[0])
            os.kill(victims[0], signal.SIGKILL)

    graded = fleet.grade(ordinary.course(), "ps1", scheduler=two_workers.address, progress=kill)
    assert killed
    assert not set(killed) & set(two_workers.workers())
    assert {student.status for student in graded.students} == {"graded"}
    assert graded.failures == ()
    fleet.grade(local.course(), "ps1")
    assert ordinary.tables() == local.tables()
    assert ordinary.autograded() == local.autograded()
    assert list(ordinary.folder.rglob("*.directrix-*")) == []


def test_a_workers_sandbox_that_is_killed_is_started_again(two_workers, ordinary):
    hand_in(ordinary, 8, SLOW)

    def kill(done, total, student):
        if done == 1:
            for pid in two_workers.sandboxes():
                with contextlib.suppress(ProcessLookupError):
                    os.kill(pid, signal.SIGKILL)

    graded = fleet.grade(ordinary.course(), "ps1", scheduler=two_workers.address, progress=kill)
    assert graded.failures == ()
    assert {student.score for student in graded.students} == {6.0, 4.0}


def test_a_submission_that_ends_every_worker_is_given_up_alone(two_workers, ordinary, monkeypatch):
    """It cannot be a learner's doing, since learners' processes are elsewhere; but if it happens, the class goes on."""
    module = importlib.import_module("autograder.fleet.cluster")
    hand_in(ordinary, 4)

    real = module.distributed.Future.exception

    def exception(self, *args, **kwargs):
        return RuntimeError("four workers died") if "s02" in names.get(self.key, "") else real(self, *args, **kwargs)

    names = {}
    fill = module.Cluster._fill

    def watched(self, queue):
        fill(self, queue)
        names.update({future.key: " ".join(task.student for task in tasks) for future, tasks in self._sent.items()})

    monkeypatch.setattr(module.Cluster, "_fill", watched)
    monkeypatch.setattr(module.distributed.Future, "exception", exception)
    graded = fleet.grade(ordinary.course(), "ps1", scheduler=two_workers.address)
    assert {s.student: s.status for s in graded.students} == {
        "s00": "graded", "s01": "graded", "s02": "failed", "s03": "graded"
    }  # fmt: skip
    assert "four workers died" in graded.faults[0]


def test_two_graders_who_share_a_cluster_share_no_job(ordinary):
    """In two containers the course lies at the same place and the process has the same id."""
    job = importlib.import_module("autograder.fleet.remote").Job
    plan = SimpleNamespace(rules=None, masters={}, instructor_files={}, scripts={}, open_session=SimpleNamespace(level="A"))
    assert job.of(ordinary.course(), "ps1", plan, {}).name != job.of(ordinary.course(), "ps1", plan, {}).name


@pytest.mark.parametrize(
    ("address", "fine"),
    [
        ("tls://10.0.0.4:8786", True), ("tcp://127.0.0.1:8786", True),
        ("tcp://[::1]:8786", True), ("tcp://localhost:8786", True),
        ("tcp://10.0.0.4:8786", False), ("tcp://cluster.example:8786", False), ("tcp://0.0.0.0:8786", False),
        ("ws://127.0.0.1:8786", False), ("127.0.0.1:8786", False), ("gateway://gateway.example:443/x", True),
    ],
)  # fmt: skip
def test_only_tls_leaves_this_machine(address, fine):
    assert safe(address) is fine


def test_an_open_cluster_is_refused_before_anything_is_sent(ordinary, monkeypatch):
    with pytest.raises(CourseError, match="neither TLS nor on this machine"):
        fleet.grade(ordinary.course(), "ps1", scheduler="tcp://10.0.0.4:8786")
    with pytest.raises(CourseError, match=r"tls://host:port, or tcp://127\.0\.0\.1:port"):
        fleet.grade(ordinary.course(), "ps1", scheduler="10.0.0.4:8786")
    with pytest.raises(CourseError, match=r"does not name distributed.comm.tls.ca-file.*DASK_DISTRIBUTED__COMM__TLS__CA_FILE"):
        fleet.grade(ordinary.course(), "ps1", scheduler="tls://127.0.0.1:9")
    monkeypatch.setattr(importlib.import_module("autograder.fleet.connection"), "PATIENCE", 1.0)
    with pytest.raises(CourseError, match="no Dask scheduler answers"):
        fleet.grade(ordinary.course(), "ps1", scheduler="tcp://127.0.0.1:9")


def test_a_scheduler_that_speaks_tls_and_listens_without_it_too_is_refused(cluster):
    """`dask scheduler --protocol tls,tcp`, if Dask was told not to insist on TLS: the second door leads to the workers too."""
    doors = {"protocol": ["tls", "tcp"], "port": [0, 0], "dashboard": False, "dashboard_address": "127.0.0.1:0"}
    ca, key = (str(cluster.folder / "tls" / name) for name in ("ca.pem", "key.pem"))
    roles = {f"tls_{role}_{what}": of for role in ("scheduler", "client") for what, of in (("cert", ca), ("key", key))}
    security = distributed.Security(tls_ca_file=ca, require_encryption=False, **roles)
    scheduler = {"cls": distributed.Scheduler, "options": {**doors, "security": security}}
    with distributed.SpecCluster(workers={}, scheduler=scheduler, security=security, silence_logs=50) as here:
        address = here.scheduler.address
        assert address.startswith("tls://")
        with pytest.raises(CourseError, match=r"^tcp://0\.0\.0\.0:\d+ is neither TLS"), connected(address):
            pass


def test_what_a_killed_grader_left_with_the_workers_is_taken_back_by_the_next_one(two_workers, ordinary):
    """Its sandboxes, one a worker, and the instructor's copies; a living grader's are left alone."""
    module, remote = (importlib.import_module(f"autograder.fleet.{name}") for name in ("cluster", "remote"))
    plan = SimpleNamespace(rules=None, masters={}, instructor_files={}, scripts={}, open_session=SimpleNamespace(level="A"))

    def jobs(client):
        return client.run_on_scheduler(lambda dask_scheduler: set(dask_scheduler.worker_plugins) - {"shuffle"})

    def begun(client):
        return module.Cluster(client, remote.Job.of(ordinary.course(), "ps1", plan, {}), 1, None, None, None)

    with connected(two_workers.address) as client, begun(client) as mine:
        before = len(two_workers.sandboxes())
        with connected(two_workers.address) as killed:
            theirs = begun(killed)
            assert jobs(client) == {mine.job.name, theirs.job.name}
            assert len(two_workers.sandboxes()) == before + 2
        with begun(client) as following:
            assert jobs(client) == {mine.job.name, following.job.name}
            assert len(two_workers.sandboxes()) == before + 2
    with connected(two_workers.address) as client:
        assert jobs(client) == set()


def test_without_a_certificate_nobody_gets_in(cluster, tmp_path, monkeypatch):
    """Another user of the machine, with certificates of his own making, is turned away by the scheduler."""
    from tests.autograder.fleet.dask_processes import certificates

    own = certificates(tmp_path / "own")
    names = {"ca-file": "CA_FILE", "client.cert": "CLIENT__CERT", "client.key": "CLIENT__KEY"}
    values = {f"distributed.comm.tls.{name}": own[f"DASK_DISTRIBUTED__COMM__TLS__{at}"] for name, at in names.items()}
    monkeypatch.setattr(importlib.import_module("autograder.fleet.connection"), "PATIENCE", 2.0)
    with dask.config.set(values), pytest.raises(CourseError, match="no Dask scheduler answers"), connected(cluster.address):
        pass


def test_a_scheduler_that_is_killed_stops_the_run_and_keeps_what_is_done(two_workers, ordinary, tmp_path, monkeypatch):
    """The next run goes on to what a clean one gives. The last test here, since the cluster has no scheduler any more."""
    monkeypatch.setattr(importlib.import_module("autograder.fleet.connection"), "PATIENCE", 3.0)  # it may come back so long
    hand_in(ordinary, 12, SLOW)
    ordinary.course().secret()
    local = ordinary.copy(tmp_path / "local")

    def kill(done, total, student):
        two_workers.started[0].kill()

    with pytest.raises(
        CourseError, match=r"^the Dask scheduler is gone \(.*\); what was graded so far is kept, and the next run"
    ):
        fleet.grade(ordinary.course(), "ps1", scheduler=two_workers.address, progress=kill)
    kept = {name.split("/")[0] for name in ordinary.autograded()}
    assert 0 < len(kept) < 12
    assert list(ordinary.folder.rglob("*.directrix-*")) == []
    again = fleet.grade(ordinary.course(), "ps1", workers=4)
    assert {student.student for student in again.students if student.status == "unchanged"} == kept
    assert fleet.grade(local.course(), "ps1", workers=4).failures == again.failures == ()
    assert ordinary.tables() == local.tables()
    assert ordinary.autograded() == local.autograded()
