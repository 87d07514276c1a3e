"""The engine `jupyter`: a real kernel and its programs, in a sandbox of their own."""

import ast
import contextlib
import dataclasses
import importlib.util
import os
import socket
import sys
import time
from pathlib import Path

import pytest

from autograder.errors import IsolationError, SandboxError
from autograder.sandbox import Limits, Policy, kernel

MiB = 2**20
NUMPY = Policy(packages=("numpy",), preload=())
ANSWER = "import socket, subprocess, os, sys, time\n"


def texts(result):
    return "".join(
        output.get("text") or output.get("data", {}).get("text/plain") or output.get("evalue", "") for output in result.outputs
    )


@pytest.fixture(scope="module")
def secret(tmp_path_factory):
    """A file of the grader's that anybody may read, and a server on the machine's loopback."""
    place = tmp_path_factory.mktemp("grader")
    for folder in (place, *list(place.parents)[:3]):
        os.chmod(folder, 0o755) if folder.owner() == Path.home().owner() and str(folder) != "/tmp" else None
    (place / "gradebook.db").write_text("marks of everybody")
    os.chmod(place / "gradebook.db", 0o644)
    with socket.create_server(("127.0.0.1", 0)) as server:
        yield place / "gradebook.db", server.getsockname()[1]


@pytest.fixture(scope="module")
def ran(secret):
    """One notebook with what a kernel can do and what it must not; cells by name."""
    path, port = secret
    tried = "def tried(code):\n    try: return eval(code)\n    except Exception as error: return type(error).__name__\n"
    cells = {
        "setup": ANSWER + tried + "h = display('first', display_id='d')",
        "kernel": "get_ipython().kernel.__class__.__name__",
        "judged": None,
        "shell": "%%bash\necho from bash; id -u",
        "terminal": "!echo from a terminal",
        "widget": "from comm import create_comm\nc = create_comm(target_name='x'); c.close(); 'comm'",
        "loopback": (
            "import threading\ns = socket.create_server(('127.0.0.1', 0))\n"
            "threading.Thread(target=lambda: s.accept()[0].sendall(b'own')).start()\n"
            "socket.create_connection(s.getsockname()).recv(3)"
        ),
        "update": "h.update('second')",
        "image": (
            "import base64\nfrom IPython.display import Image\n"
            "Image(data=bytes.fromhex('89504e470d0a1a0a') + b'1', format='png', width=3, height=4)"
        ),
        "given": "open('data.txt').read()",
        "module": "import answers_of_nobody",
        "note": "open('kept.txt', 'w').write('kept')",
        "flood": "print('x' * 5_000_000)",
        "outside": (
            f"path = {str(path)!r}\n"
            "tried('open(path)'), tried('os.listdir(os.path.dirname(path))'), tried('os.listdir(\"/home\")')"
        ),
        "network": f"tried('socket.create_connection((\"127.0.0.1\", {port}), 2)')",
        "packet": "tried('socket.socket(socket.AF_PACKET, socket.SOCK_RAW)'), tried('socket.socket(socket.AF_VSOCK)')",
        "packages": 'tried(\'open(os.__file__, "a")\'), tried(\'open("/usr/bin/mine", "w")\'), tried(\'open("/mine", "w")\')',
        "grader": "tried('__import__(\"autograder.fleet\")'), tried('__import__(\"directrix.surfaces\")')",
        "namespaces": (
            "import ctypes\nlibc = ctypes.CDLL(None, use_errno=True)\n"
            "[libc.unshare(0x10000000), libc.syscall(319, b'm', 0), libc.syscall(425, 1, None), libc.ptrace(16, 1, 0, 0)]"
        ),
        "root": "os.getuid(), tried('os.setuid(0)'), open('/proc/self/status').read().split('CapEff:')[1].split()[0]",
        "command lines": (
            "shown = [open(f'/proc/{pid}/cmdline').read().split(chr(0)) for pid in os.listdir('/proc') if pid.isdigit()]\n"
            "files = [os.readlink(f'/proc/1/fd/{name}') for name in os.listdir('/proc/1/fd')]\nshown, files"
        ),
        "namespace": "os.readlink('/proc/self/ns/pid')",
        "processes": "[name for name in os.listdir('/proc') if name.isdigit()].__len__() < 12",
        "fork bomb": (
            "made = 0\nfor _ in range(300):\n    try: pid = os.fork()\n    except BlockingIOError: break\n"
            "    if not pid:\n        time.sleep(60); os._exit(0)\n    made += 1\n20 < made < 64, made"
        ),
        "scratch": 'tried(\'open("big", "wb").write(bytes(60_000_000)) and open("/tmp/big", "wb").write(bytes(60_000_000))\')',
    }
    limits = Limits(scratch=32 * MiB, output=100_000, notebook_cpu=60)
    files = {"data.txt": b"given"}
    run = kernel.run_notebook(list(cells.values()), files, policy=NUMPY, limits=limits)
    names = list(cells)
    return {names[number]: result for number, result in run.cells.items()}, run


def test_what_only_a_real_kernel_does(ran):
    cells, run = ran
    assert run.ended is None
    assert texts(cells["kernel"]) == "'IPythonKernel'"
    assert texts(cells["shell"]) == "from bash\n1000\n"
    assert texts(cells["terminal"]).strip() == "from a terminal"
    assert texts(cells["widget"]) == "'comm'"
    assert texts(cells["loopback"]) == "b'own'"
    assert texts(cells["given"]) == "'given'"
    assert texts(cells["setup"]) == "'second'"  # a later cell has updated it
    assert cells["image"].outputs[0]["metadata"] == {"image/png": {"width": 3, "height": 4}}
    assert "judged" not in cells
    assert (cells["module"].status, cells["kernel"].status) == ("error", "ok")
    assert run.files["kept.txt"] == b"kept"


@pytest.mark.parametrize(
    ("cell", "answer"),
    [
        ("outside", "('FileNotFoundError', 'FileNotFoundError', 'FileNotFoundError')"),
        ("network", "'ConnectionRefusedError'"),
        ("packet", "('OSError', 'OSError')"),
        ("packages", "('PermissionError', 'OSError', 'OSError')"),
        ("grader", "('ModuleNotFoundError', 'ImportError')"),
        ("namespaces", "[-1, -1, -1, -1]"),
        ("root", "(1000, 'PermissionError', '0000000000000000')"),
        ("processes", "True"),
        ("scratch", "'OSError'"),
    ],
)
def test_what_is_stopped(ran, cell, answer):
    assert texts(ran[0][cell]) == answer


def test_command_lines_tell_nothing_of_the_machine(ran):
    """The first process in the sandbox is bubblewrap's: its options, with every folder that is shown, are not there to read."""
    shown, files = ast.literal_eval(texts(ran[0]["command lines"]))
    first = next(words for words in shown if words[0].endswith("bwrap"))
    assert (first[1], first[3], first[4]) == ("--args", "--", f"/python/bin/{Path(os.path.realpath(sys.executable)).name}")
    said = " ".join(word for words in shown for word in words) + " ".join(files)
    ours = {sys.prefix, sys.base_prefix, str(Path(kernel.__file__).parents[2])} - {"/usr", "/usr/local"}
    assert ours
    assert [path for path in ours if path in said] == []
    assert "memfd" not in said


def in_namespace(name):
    """Processes of this machine in that pid namespace; others may be grading here too."""
    found = []
    for pid in filter(str.isdigit, os.listdir("/proc")):
        with contextlib.suppress(OSError):
            if os.readlink(f"/proc/{pid}/ns/pid") == name:
                found.append(pid)
    return found


def test_a_fork_bomb_is_bounded_and_nothing_outlives_the_notebook(ran):
    cells, _ = ran
    assert "(True, " in texts(cells["fork bomb"])  # since Python 3.12 after a warning of threads
    theirs = ast.literal_eval(texts(cells["namespace"]))
    assert in_namespace(os.readlink("/proc/self/ns/pid"))
    deadline = time.monotonic() + 10  # the kernel ends what was in it, soon after its first process
    while in_namespace(theirs):
        assert time.monotonic() < deadline
        time.sleep(0.05)


def test_a_flood_is_cut(ran):
    assert "the output of this cell is cut here" in texts(ran[0]["flood"])
    assert len(texts(ran[0]["flood"])) < 200_000


def run(*sources, **limits):
    return kernel.run_notebook(sources, policy=NUMPY, limits=Limits(**limits))


def test_memory_is_summed_over_processes():
    """Eight processes, each within the limit of one."""
    eight = (
        "import os, time\nfor _ in range(8):\n    if not os.fork():\n        held = bytearray(150_000_000); time.sleep(60)\n"
        "time.sleep(60)"
    )
    began = time.monotonic()
    result = run("'before'", eight, "'after'", memory=256 * MiB)
    assert result.ended.kind == "memory"
    assert texts(result.cells[0]) == "'before'"
    assert 2 not in result.cells
    assert time.monotonic() - began < 40


def test_memory_that_is_shared_counts_once_and_that_of_ended_processes_not_at_all():
    """A notebook's processes may end between two looks at them, all together."""
    (mine,) = [seen for seen in kernel.tree(os.getpid()) if seen.pid == os.getpid()]
    assert 0 < kernel.proportional(mine) <= mine.rss
    ended = os.posix_spawn("/bin/true", ["true"], {})
    while "(true) Z" not in Path(f"/proc/{ended}/stat").read_text():
        time.sleep(0.01)
    assert kernel.proportional(dataclasses.replace(mine, pid=ended)) == 0  # not yet collected
    os.waitpid(ended, 0)
    assert kernel.proportional(dataclasses.replace(mine, pid=ended)) == 0


def test_computing_time_is_summed_over_processes():
    burn = "import os\nfor _ in range(3): os.fork()\nwhile True: pass"
    result = run(burn, notebook_cpu=8)
    assert (result.ended.kind, result.ended.limit) == ("timeout", "notebook")


def test_a_dead_kernel_costs_what_comes_after_it():
    result = run("'before'", "import os; os._exit(1)", "'after'")
    assert texts(result.cells[0]) == "'before'"
    assert result.cells[1].status == "died"
    assert 2 not in result.cells


def test_forged_frames_are_refused():
    """The learner's code finds the runner's socket; what it writes there is checked like everything else."""
    forge = (
        "import os\nrunner = os.getppid()\n"
        "open(f'/proc/{runner}/fd/3', 'wb').write(b'x' * 1000) if os.path.exists(f'/proc/{runner}/fd/3') else None"
    )
    result = run("1", forge, "2")
    assert result.ended is None or result.ended.kind in ("refused", "died")


def test_withheld_modules_are_not_there():
    result = kernel.run_notebook(
        ["import numpy, comm", "import yaml; yaml.safe_load('1')"], policy=Policy(packages="all"), withhold=("yaml",)
    )
    assert [result.cells[number].status for number in (0, 1)] == ["ok", "error"]
    assert importlib.util.find_spec("yaml") is not None


def test_what_is_missing_is_named(monkeypatch):
    found = importlib.util.find_spec
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None if name == "ipykernel" else found(name))
    with pytest.raises(IsolationError, match=r"missing: ipykernel.*pip install ipykernel"):
        run("1")


def test_an_engine_that_does_not_start_says_why(monkeypatch):
    monkeypatch.setattr(kernel, "START", "raise RuntimeError('no luck today')")
    with pytest.raises(SandboxError, match="no luck today"):
        run("1")
