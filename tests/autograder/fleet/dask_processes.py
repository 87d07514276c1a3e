"""A Dask cluster of the tests' own: a scheduler and workers as processes on the loopback interface, with TLS or without."""

import contextlib
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import distributed

SECONDS = 90
QUIET = {
    "DASK_DISTRIBUTED__DASHBOARD__LINK": "", "DASK_DISTRIBUTED__LOGGING__DISTRIBUTED": "warning", "OPENBLAS_NUM_THREADS": "1",
}  # fmt: skip


def certificates(folder):
    """A certificate of this cluster's own for all roles, and Dask's configuration that names it, as environment variables."""
    security = distributed.Security.temporary()
    folder.mkdir()
    (folder / "ca.pem").write_text(security.tls_ca_file)
    (folder / "key.pem").write_text(security.tls_client_key)
    names = {"CA_FILE": "ca.pem"}
    for role in ("SCHEDULER", "WORKER", "CLIENT"):
        names |= {f"{role}__CERT": "ca.pem", f"{role}__KEY": "key.pem"}
    (folder / "key.pem").chmod(0o600)
    return {f"DASK_DISTRIBUTED__COMM__TLS__{name}": str(folder / file) for name, file in names.items()}


class Processes:
    """A scheduler and its workers, each with a nanny that starts it again, one thread each."""

    def __init__(self, folder, workers, *, tls=True):
        self.folder = folder
        folder.mkdir(parents=True)
        self.certificates = certificates(folder / "tls") if tls else {}
        self.environment = {**os.environ, **QUIET, **self.certificates, "PYTHONPATH": os.pathsep.join(sys.path)}
        self.started = []
        protocol = "tls" if tls else "tcp"
        common = ["--protocol", protocol, "--no-dashboard", "--scheduler-file", str(folder / "scheduler.json")]
        try:
            scheduler = ["--host", f"{protocol}://127.0.0.1:0"]
            self._start("scheduler", [*scheduler, *common[2:]])
            self.address = self._when(lambda: self._said(folder / "scheduler.json"))
            for number in range(workers):
                place = ["--local-directory", str(folder / f"w{number}"), "--nthreads", "1", "--no-dashboard"]
                self._start(
                    "worker", [self.address, "--host", f"{protocol}://127.0.0.1", *place, "--death-timeout", str(SECONDS)]
                )
        except BaseException:
            self.close()
            raise

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        self.close()

    def _start(self, role, options):
        with (self.folder / f"{role}{len(self.started)}.log").open("wb") as log:
            command = [sys.executable, "-m", f"distributed.cli.dask_{role}", *options]
            self.started.append(subprocess.Popen(command, env=self.environment, stdout=log, stderr=log, cwd=self.folder))

    def _said(self, file):
        import json

        with contextlib.suppress(OSError, ValueError):
            return json.loads(file.read_text())["address"]

    def _when(self, ask):
        deadline = time.monotonic() + SECONDS
        while (found := ask()) is None:
            assert time.monotonic() < deadline, self.logs()
            assert all(process.poll() is None for process in self.started), self.logs()
            time.sleep(0.05)
        return found

    def logs(self):
        return "\n".join(f"{path.name}:\n{path.read_text()[-3000:]}" for path in sorted(self.folder.glob("*.log")))

    def workers(self):
        """Process ids of the workers themselves: their nannies' children."""
        found = []
        for nanny in self.started[1:]:
            for child in _children(nanny.pid):
                with contextlib.suppress(OSError):
                    if b"spawn_main" in Path(f"/proc/{child}/cmdline").read_bytes():
                        found.append(child)
        return found

    def sandboxes(self):
        """Process ids of the zygotes' bubblewraps below the workers."""
        return [child for worker in self.workers() for child in _children(worker) if _command(child) in ("bwrap", "python")]

    def close(self):
        for process in reversed(self.started):
            process.send_signal(signal.SIGTERM)
        for process in self.started:
            try:
                process.wait(10)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()


def _children(pid):
    found = []
    with contextlib.suppress(OSError):
        for task in Path(f"/proc/{pid}/task").iterdir():  # a sandbox is started by a thread of its own
            found += [int(name) for name in (task / "children").read_text().split()]
    return found


def _command(pid):
    with contextlib.suppress(OSError):
        return Path(f"/proc/{pid}/comm").read_text().strip()


IN_THIS_PROCESS = []


@contextlib.contextmanager
def in_this_process(at, workers, /, **options):
    """A scheduler without certificates; unless there are options, its workers are told nothing of where to listen."""
    quiet = {"dashboard": False, "dashboard_address": "127.0.0.1:0"}
    scheduler = {"cls": distributed.Scheduler, "options": {"host": at, **quiet}}
    worker = {"cls": distributed.Worker, "options": {"nthreads": 1, "dashboard": False, **options}}
    with distributed.SpecCluster(workers=dict.fromkeys(range(workers), worker), scheduler=scheduler, silence_logs=50) as here:
        IN_THIS_PROCESS.append(here)
        yield f"tcp://127.0.0.1:{here.scheduler.port}"
        IN_THIS_PROCESS.pop()
