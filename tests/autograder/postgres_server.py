"""A PostgreSQL of the tests' own: run by an ordinary user in a scratch folder, reached by a socket in it, gone afterwards."""

import contextlib
import os
import pwd
import shutil
import signal
import subprocess
import tempfile
import time
from pathlib import Path

# Nothing here has to outlive a power cut, and the machine is shared.
SETTINGS = {
    "listen_addresses": "", "fsync": "off", "full_page_writes": "off", "shared_buffers": "16MB",
    "max_connections": "40", "autovacuum": "off",
}  # fmt: skip
SECONDS = 60


def programs():
    """The newest PostgreSQL's folder of programs (Debian keeps them off the path), or None."""
    found = sorted(Path("/usr/lib/postgresql").glob("*/bin/initdb"), key=lambda path: int(path.parts[-3]))
    on_path = shutil.which("initdb")
    return found[-1].parent if found else Path(on_path).parent if on_path else None


class Server:
    """One running server. PostgreSQL refuses to run as root, so root gives it to the user ``nobody``."""

    def __init__(self):
        self.folder = Path(tempfile.mkdtemp(prefix="directrix-postgres-", dir="/tmp"))  # a socket's path is at most 107 bytes
        self.options = {"cwd": self.folder, "stdin": subprocess.DEVNULL}
        if os.geteuid() == 0:
            nobody = pwd.getpwnam("nobody")
            os.chown(self.folder, nobody.pw_uid, nobody.pw_gid)
            self.options |= {"user": nobody.pw_uid, "group": nobody.pw_gid, "extra_groups": []}
        self.count = 0
        try:
            make = ["-D", self.folder / "data", "-U", "grader", "-A", "trust", "--no-sync", "-E", "UTF8", "--locale=C"]
            subprocess.run([programs() / "initdb", *make], check=True, capture_output=True, **self.options)
            self.start()
        except BaseException:
            shutil.rmtree(self.folder, ignore_errors=True)
            raise

    def start(self):
        settings = [word for name, value in SETTINGS.items() for word in ("-c", f"{name}={value}")]
        with (self.folder / "log").open("ab") as log:
            self.process = subprocess.Popen(
                [programs() / "postgres", "-D", self.folder / "data", "-k", self.folder, *settings],
                stdout=log, stderr=log, **self.options,
            )  # fmt: skip
        deadline = time.monotonic() + SECONDS
        while True:
            with contextlib.suppress(Exception):
                self.sql("select 1")
                return
            assert self.process.poll() is None, (self.folder / "log").read_text()
            assert time.monotonic() < deadline, "PostgreSQL does not answer"
            time.sleep(0.05)

    def stop(self):
        """At once, as in a crash: the log is replayed at the next start."""
        self.process.send_signal(signal.SIGQUIT)
        self.process.wait(SECONDS)

    def close(self):
        self.stop()
        shutil.rmtree(self.folder, ignore_errors=True)

    def url(self, database):
        return f"postgresql+psycopg://grader@/{database}?host={self.folder}"

    def connect(self, database="postgres"):
        import psycopg

        return psycopg.connect(host=str(self.folder), user="grader", dbname=database, autocommit=True)

    def sql(self, statement, database="postgres"):
        with self.connect(database) as connection:
            done = connection.execute(statement)
            return done.fetchall() if done.description else []

    def create(self, template="template1"):
        """A new database, or a copy of one that nobody is using; its name."""
        self.count += 1
        name = f"course{self.count}"
        self.sql(f"create database {name} template {template} strategy file_copy")
        return name
