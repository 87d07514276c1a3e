"""Every limit holds, says what it is, and spares what keeps within it."""

import re
import time

import numpy as np
import pytest

from autograder.errors import CallFailed, SandboxError
from autograder.sandbox import Limits

MiB = 2**20
STUBBORN = """
import signal
for s in (signal.SIGPROF, signal.SIGALRM, signal.SIGXCPU, signal.SIGTERM):
    signal.signal(s, signal.SIG_IGN)
def g():
    while True: sum(range(10))
def f():
    while True:
        try:
            g()  # an endless loop here would now and then be left: its first step stands outside the try
        except BaseException:
            pass
"""


def wait_for(happened):
    """Until something is so, which takes the longer the busier the machine is."""
    deadline = time.monotonic() + 60
    while not happened():
        assert time.monotonic() < deadline
        time.sleep(0.1)


def text(result):
    return "".join(output.get("text", "") for output in result.outputs)


def test_a_loop_is_interrupted_at_its_line_and_the_notebook_goes_on(session):
    result = session.run_cell("kept = 1\nwhile True:\n    kept += 1")
    assert result.status == "timeout"
    assert result.note == "this cell was stopped: it may compute for 1 s and had not finished. Is there a loop that never ends?"
    assert (result.note.key, result.note.facts["what"].key) == ("cpu_time", "cell")  # for another language
    assert result.outputs[-1]["ename"] == "TimeLimitExceeded"
    assert "kept += 1" in re.sub(r"\x1b\[[0-9;]*m", "", "".join(result.outputs[-1]["traceback"]))
    assert session.out_of_time.limit == "cpu"
    assert session.run_cell("kept > 1").outputs[0]["data"] == {"text/plain": "True"}


def test_what_was_printed_before_the_time_was_up_is_kept(session):
    assert text(session.run_cell("print('begun')\nwhile True: pass")) == "begun\n"


def test_except_exception_does_not_swallow_the_interruption(session):
    result = session.run_cell("while True:\n    try:\n        while True: pass\n    except Exception:\n        pass")
    assert result.status == "timeout"
    assert session.alive


def test_a_call_is_interrupted_at_its_line(session):
    session.run_cell("def f():\n    i = 0\n    while True: i += 1\ndef g(): return 1")
    with pytest.raises(CallFailed) as caught:
        session.call("f", [])
    assert caught.value.kind == "timeout"
    assert caught.value.line == 3
    assert "this call of your function was stopped: it may compute for 1 s" in caught.value.message
    assert session.call("g", []) == 1


def test_a_loop_that_catches_everything_is_ended_from_outside(session):
    session.run_cell(STUBBORN)
    began = time.monotonic()
    with pytest.raises(CallFailed) as caught:
        session.call("f", [])
    assert caught.value.kind == "timeout"
    assert time.monotonic() - began < 60
    assert not session.alive
    assert session.ended.limit == "cpu"
    assert session.run_cell("1").status == "died"
    with pytest.raises(CallFailed, match="may compute for 1 s") as later:
        session.call("f", [])
    assert later.value.kind == "died"


def test_a_hang_inside_c_is_ended_from_outside(session):
    result = session.run_cell("sum(range(10**11))")
    assert result.status == "timeout"
    assert not session.alive


def test_sleeping_is_stopped_by_the_clock(sandbox):
    with sandbox.open(limits=Limits(cell_cpu=0.1, patience=0.3)) as session:
        result = session.run_cell("import time; time.sleep(100)")
        assert result.status == "timeout"
        assert result.note == "this cell was stopped after 0.6 s by the clock. Is it waiting for something?"
        assert session.out_of_time.limit == "wall"
        assert session.run_cell("1").status == "ok"


def test_sleeping_with_signals_ignored_is_ended_by_the_clock(sandbox):
    with sandbox.open(limits=Limits(cell_cpu=0.1, patience=0.3)) as session:
        result = session.run_cell("import signal, time\nsignal.signal(signal.SIGALRM, signal.SIG_IGN)\ntime.sleep(100)")
        assert (result.status, session.ended.limit) == ("timeout", "wall")


def test_sleep_costs_no_computing_time(session):
    session.run_cell("import time; time.sleep(1.2)")
    assert session.usage.wall_seconds > 1.2
    assert session.usage.cpu_seconds < 1


def test_the_whole_notebook_has_a_limit_of_its_own(sandbox):
    with sandbox.open(limits=Limits(cell_cpu=1, notebook_cpu=1, patience=1)) as session:
        first = session.run_cell("import time; t = time.process_time()\nwhile time.process_time() < t + 0.7: pass")
        assert first.status == "ok"
        assert session.run_cell("while True: pass").status == "timeout"
        last = session.run_cell("while True: pass")
        assert (
            last.note == "the notebook has used the 1 s of computing that all its cells may take together; the rest was not run"
        )
        assert (session.ended or session.out_of_time).limit == "notebook"  # ended, or interrupted and alive


def test_threads_at_work_between_cells_count(sandbox):
    """CPU time is measured outside, over all threads."""
    with sandbox.open(limits=Limits(cell_cpu=5, notebook_cpu=0.6)) as session:
        session.run_cell(
            "import threading\ndef burn():\n    while True: pass\nthreading.Thread(target=burn, daemon=True).start()"
        )
        wait_for(lambda: session.run_cell("1").status == "died")


def test_memory_for_a_cell_and_for_a_call(session):
    result = session.run_cell("import numpy as np\nnp.ones(10**9)")
    assert result.status == "memory"
    assert result.note == "this cell asked for more memory than the 512 MiB it may have. Is an array far larger than meant?"
    session.run_cell("def f(): return np.ones(10**9).sum()")
    with pytest.raises(CallFailed, match="this call of your function asked for more memory than the 512 MiB") as caught:
        session.call("f", [])
    assert caught.value.kind == "memory"
    assert caught.value.line == 1


def test_memory_within_the_limit_is_given(session):
    assert session.run_cell("import numpy as np\nnp.ones(30 * 2**20).sum()").outputs[0]["data"] == {
        "text/plain": "np.float64(31457280.0)"
    }
    session.close()
    assert session.usage.max_rss > 240 * MiB


def test_many_small_pieces_of_memory_are_limited_too(session):
    result = session.run_cell("kept = []\nwhile True: kept.append(bytes(10**6))")
    assert result.status == "memory"


def test_long_output_is_cut_with_a_note(sandbox):
    with sandbox.open(limits=Limits(output=10_000)) as session:
        result = session.run_cell("for i in range(100_000): print('x' * 80)\n'last'")
        assert result.status == "ok"
        assert text(result).endswith("... the output of this cell is cut here: it shows more than 10 kB.\n")
        assert len(text(result)) < 11_000
        assert text(session.run_cell("print('next cell')")) == "next cell\n"


def test_an_endless_flood_of_output_costs_nobody_memory(sandbox):
    with sandbox.open(limits=Limits(output=10_000, cell_cpu=1)) as session:
        result = session.run_cell("while True: print('x' * 1000)")
        assert result.status == "timeout"
        assert len(text(result)) < 11_000
        session.close()
        assert session.usage.max_rss < 300 * MiB


def test_a_flood_past_python_is_cut_as_well(sandbox):
    with sandbox.open(limits=Limits(output=10_000, file=MiB)) as session:
        result = session.run_cell(
            "import os\ntry:\n    while True: os.write(1, b'y' * 65536)\nexcept OSError as error: print(error)"
        )
        assert len(text(result)) < 11_000


def test_one_large_display_and_many_small_ones_are_cut(sandbox):
    with sandbox.open(limits=Limits(output=10_000, outputs=20)) as session:
        large = session.run_cell("from IPython.display import HTML\nprint('before')\nHTML('x' * 20_000)")
        assert [output["output_type"] for output in large.outputs] == ["stream", "stream"]
        many = session.run_cell("for i in range(1000): display(i)")
        assert len(many.outputs) == 21
        assert "more than 20 things" in many.outputs[-1]["text"]


def test_updates_of_a_display_do_not_add_up(sandbox):
    with sandbox.open(limits=Limits(output=10_000, outputs=20)) as session:
        result = session.run_cell("h = display(0, display_id=True)\nfor i in range(5000): h.update(i)")
        assert [output["data"] for output in result.outputs] == [{"text/plain": "4999"}]
        flood = session.run_cell("for i in range(1000): display('x' * 9000, display_id=str(i), update=True)")
        assert flood.status == "ok"
        assert "cut here" in text(flood)


@pytest.mark.parametrize("flood", ["print('x' * 5000)", "for i in range(300): display(i)"])
def test_a_result_is_shown_even_after_too_much_output(sandbox, flood):
    """It may be a number of points, and a cell without one would have them all."""
    with sandbox.open(limits=Limits(output=1000)) as session:
        result = session.run_cell(f"{flood}\n0.5")
        assert result.outputs[-1]["data"] == {"text/plain": "0.5"}
        called = session.run_cell(f"{flood}\nfor i in range(1000): get_ipython().displayhook(i)")
        assert len(called.outputs) < 220


def test_many_updates_of_one_display_cost_as_much_as_the_last(sandbox):
    """A recorder that was tampered with tells of 9000 updates, and each would go to all places of that display."""
    tampered = "R = get_ipython().recorder\n"
    with sandbox.open() as session:
        for _ in range(20):
            shown = session.run_cell(tampered + "R.outputs += [['display_data', [('text/plain', 'a')], (), 'n']] * 390")
        began = time.process_time()
        session.run_cell(tampered + "R.updates = {i: ['', [('text/plain', f'{i}')], (), 'n'] for i in range(9000)}")
        assert time.process_time() - began < 3.0
    assert {output["data"]["text/plain"] for output in shown.outputs} == {"8999"}


def test_an_error_is_shown_even_after_too_much_output(sandbox):
    with sandbox.open(limits=Limits(output=1000)) as session:
        result = session.run_cell("print('x' * 5000)\n1 / 0")
        assert result.outputs[-1]["ename"] == "ZeroDivisionError"


def test_the_text_of_errors_is_bounded(session):
    result = session.run_cell("raise ValueError('x' * 10**7)")
    assert sum(len(line) for line in result.outputs[-1]["traceback"]) < 300_000


def test_one_file_and_all_files_together(sandbox):
    with sandbox.open(limits=Limits(file=MiB, scratch=4 * MiB, files=50)) as session:
        assert "File too large" in session.run_cell("open('big', 'wb').write(bytes(2 * 2**20))").outputs[-1]["evalue"]
        full = session.run_cell("for i in range(10): open(str(i), 'wb').write(bytes(2**19 + 2**18))")
        assert "No space left" in full.outputs[-1]["evalue"]
        many = session.run_cell(
            "import os\nfor name in os.listdir(): os.remove(name)\nfor i in range(9999): open(f'f{i}', 'w')"
        )
        assert "No space left" in many.outputs[-1]["evalue"]
        assert len(session.files()) <= 50


def test_a_deep_tree_of_folders_does_not_disturb(sandbox):
    with sandbox.open(limits=Limits(files=2000)) as session:
        session.run_cell("import os\nopen('here', 'w').write('x')\nfor i in range(1500):\n    os.mkdir('d'); os.chdir('d')")
        assert session.files() == {"here": b"x"}


def test_threads_are_allowed_up_to_the_limit(session):
    few = session.run_cell(
        "import concurrent.futures as c\nwith c.ThreadPoolExecutor(8) as pool: print(sum(pool.map(abs, range(-9, 0))))"
    )
    assert text(few) == "45\n"
    source = "import threading\nevent = threading.Event()\nstarted = 0\ntry:\n    while started < 500:\n"
    source += "        threading.Thread(target=event.wait, daemon=True).start(); started += 1\n"
    many = session.run_cell(source + "except RuntimeError as error: print(error)\nevent.set(); print(started < 100)")
    assert text(many) == "can't start new thread\nTrue\n"


@pytest.mark.parametrize(
    ("source", "said"),
    [
        ("import os; os._exit(3)", "this cell ended the notebook's own process (os._exit or the like, code 3)"),
        ("import ctypes; ctypes.string_at(0)", "segmentation fault"),
        ("import os; os.abort()", "ended the notebook's process"),
        ("import os; os.close(3)", "closed a connection"),
    ],
)
def test_an_ended_process_says_how_it_ended(session, source, said):
    result = session.run_cell(source)
    assert result.status == "died"
    assert said in result.note
    assert result.note.endswith("What comes after it could not be run")
    assert session.run_cell("1").note == result.note


def test_killing_oneself_does_nothing(session):
    """The first process of a pid namespace gets no signal that it does not handle."""
    assert session.run_cell("import os, signal; os.kill(os.getpid(), signal.SIGKILL); 'alive'").status == "ok"


def test_files_that_do_not_fit_are_refused_before(sandbox):
    with pytest.raises(SandboxError, match="do not fit"):
        sandbox.open({"big": bytes(2 * MiB)}, Limits(file=MiB))


def test_a_large_answer_within_the_limit_is_taken(session):
    session.run_cell("import numpy as np\ndef f(n): return np.arange(float(n))")
    assert np.array_equal(session.call("f", [10**6]), np.arange(1e6))
