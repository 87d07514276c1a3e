"""Where the course secret lies, how it is changed, and that nobody else gets to see it."""

import os
import stat
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from autograder.errors import CourseError
from autograder.notebook import secret


def test_the_secret_is_made_once_for_its_owner_only(tmp_path):
    """Mode 0600 in a folder of mode 0700, whatever the umask is; the second asking gives the same."""
    old = os.umask(0)
    try:
        first = secret.course_secret(tmp_path)
    finally:
        os.umask(old)
    path = tmp_path / ".directrix" / "secret"
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
    assert stat.S_IMODE(path.parent.stat().st_mode) == 0o700
    assert secret.course_secret(tmp_path) == first
    assert len(first) == secret.LENGTH
    assert [found.name for found in path.parent.iterdir()] == ["secret"]


def test_removing_the_secret_makes_another_and_other_hidden_data(tmp_path):
    """So it is rotated, as docs/security.md says: new seeds for everybody, a new public word, mode 0600 again."""
    path = tmp_path / ".directrix" / "secret"
    first = secret.course_secret(tmp_path)
    path.unlink()
    second = secret.course_secret(tmp_path)
    assert first != second
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
    who = ("ada", "cylinder", "digest")
    assert secret.hidden_seed(first, *who) != secret.hidden_seed(second, *who)
    assert secret.public_salt(first) != secret.public_salt(second)
    assert secret.public_salt(first) not in first.hex()


@pytest.mark.parametrize("text", ["", "zz" * 32, "ab" * 31, "ab" * 32 + "\ud83d"])
def test_a_broken_secret_is_an_error_that_does_not_tell_it(text, tmp_path):
    """Nothing is graded on half a secret, and no message shows what is there."""
    path = tmp_path / ".directrix" / "secret"
    path.parent.mkdir()
    path.write_bytes(text.encode("utf-8", "surrogatepass"))
    with pytest.raises(CourseError, match="remove it") as raised:
        secret.course_secret(tmp_path)
    assert not text or text[:6] not in str(raised.value)


class Watch(threading.Thread):
    """Reads arguments and environment of every process again and again: who ever had a text there, and how many were seen."""

    def __init__(self, text):
        super().__init__(daemon=True)
        self.text, self.over, self.seen, self.holders = text.encode(), threading.Event(), set(), set()

    def run(self):
        while not self.over.wait(0.01):
            for place in Path("/proc").glob("[0-9]*"):
                for name in ("cmdline", "environ"):
                    try:
                        found = (place / name).read_bytes()
                    except OSError:
                        continue
                    if name == "cmdline" and b"autograder" in found:
                        self.seen.add(place.name)
                    if self.text in found:
                        self.holders.add((place.name, name))

    def __enter__(self):
        self.start()
        return self

    def __exit__(self, *_):
        self.over.set()
        self.join()


@pytest.mark.skipif(not Path("/proc/self/cmdline").exists(), reason="/proc is Linux's")
def test_no_argument_environment_or_log_ever_shows_the_secret(surfaces):
    """While a class is graded, all processes are watched; the watch itself is shown to see what it looks for."""
    text = secret.course_secret(surfaces.folder).hex()
    with Watch(text) as control:
        subprocess.run([sys.executable, "-c", "import time; time.sleep(0.5)", text], check=True)
        subprocess.run([sys.executable, "-c", "import time; time.sleep(0.5)"], env={**os.environ, "X": text}, check=True)
    assert {name for _, name in control.holders} == {"cmdline", "environ"}
    right = "def cylinder(u, w, r, h):\n    u, w = np.broadcast_arrays(u, w)\n    a = 2 * np.pi * u\n"
    right += "    return np.stack([r * np.cos(a), r * np.sin(a), h * w], axis=-1)"
    surfaces.hand_in("ada", {"known-forms": {"cylinder": right}})
    surfaces.hand_in("bob", {"known-forms": {"cylinder": "def cylinder(u, w, r, h):\n    raise RuntimeError(str(vars()))"}})
    with Watch(text) as watch:
        command = [sys.executable, "-m", "autograder", "grade", "A1", "--json", "--workers", "2"]
        ran = subprocess.run(command, cwd=surfaces.folder, capture_output=True, text=True, timeout=300)
    assert ran.returncode == 0, ran.stderr
    assert '"score": 4.0' in ran.stdout
    assert len(watch.seen) > 1  # the command and the processes it starts
    assert watch.holders == set()
    assert text not in ran.stdout + ran.stderr
