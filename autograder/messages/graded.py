"""What grading writes into a learner's notebook: why a cell has no mark, what was stopped, what was cut.

Keys that begin with ``sandbox`` are the words of ``autograder.sandbox.messages``, which
``autograder.notebook.told`` says again from here.
"""

from __future__ import annotations

GRADED: dict[str, str] = {
    # --- a mark that a person gives, or should look at
    "graded.not_executed": "This cell was not executed.",
    "graded.not_judged": "This exercise was not judged.",
    "graded.could_not_judge": "This exercise could not be judged.",
    "graded.no_text": "The test returned something without a text; please look at it.",
    "graded.no_number": "The test returned {shown}, which is no number: full points, as in nbgrader.",
    "graded.no_points": "The test returned {shown}; with the solution it returns a number of points: 0 points for now; please "
    "look at it.",
    "graded.nothing": "nothing",
    "graded.nan": "The test returned not a number: 0 points for now; please look at it.",
    "graded.outside": "The test returned {value}, outside 0 to {points}: 0 points for now; please look at it.",
    "graded.could_not_cross": "A value could not go to the test, and may be right: 0 points for now; please look at it.",
    "graded.no_response": "No response.",
    # --- cells that are not there, or there twice
    "graded.missing": "The cell is missing from the submission: no mark, please look at it.",
    "graded.twice": "The cell is there more than once; the last one counts.",
    "graded.put_back": "This cell (id:{cell_id}) was missing from the submission. It was added back by nbgrader.",
    # --- what ended a cell
    "graded.ended.timeout": "this cell was stopped: it took longer than the time limit",
    "graded.ended.memory": "this cell was stopped: it took more memory than the limit",
    "graded.ended.died": "this cell ended the Python process",
    "graded.ended.refused": "this cell was not run: the sandbox refused it",
    "graded.error": "this cell raised an error",
    # --- what was not run, or has no mark for what came before it
    "graded.hurried": (
        "Stopped by the clock before its computing time was used up: no mark, since a busy machine can do that; please look."
    ),
    "graded.after": "An earlier cell was stopped by the clock before its computing time was used up: no mark; please look.",
    "graded.faulty": "An earlier cell could not be run, which is not this notebook's fault: no mark; it is graded again.",
    "graded.late": "Not run to its end: the time for this notebook was used up.",
    "graded.restarts": "Not run: this notebook ended its process more than {count} times before.",
    "graded.unknown": "No exercise is called {name}, so this cell could not be judged.",
    "graded.no_sandbox": "The sandbox was not available: not run.",
    "graded.no_sandbox_judge": "The sandbox was not available, so this could not be judged.",
    "graded.judge": "The judge itself failed, so this could not be judged.",
    "graded.fault_cell": "a cell could not be run: {error}",
    "graded.fault_judge": "{name}: the judge failed ({exception}: {message})",
    # --- shown by a real kernel
    "graded.forgeable": (
        "This test ran in the learner's own kernel, where its outcome can be forged: no mark; please look. "
        "Exercise cells and tests that run apart are marked with this engine too."
    ),
    "graded.kernel_lost": "Not run to its end in the kernel: {why}",
    "graded.kernel_silent": "Not run in the kernel: an earlier cell ended it.",
    # --- what was cut
    "graded.cut.lines": "... Output truncated ...",
    "graded.cut.traceback": "... Traceback truncated ...",
    "graded.cut.text": "... cut here: the output was too long ...",
    "graded.cut.notebook": "... left out: this notebook shows more than can be kept ...",
    # --- the sandbox: what it speaks of, and why it stopped that
    "sandbox.cell": "this cell",
    "sandbox.call": "this call of your function",
    "sandbox.files": "saving the files",
    "sandbox.start": "starting",
    "sandbox.test": "this test",
    "sandbox.cpu_time": (
        "{what} was stopped: it may compute for {seconds} s and had not finished. Is there a loop that never ends?"
    ),
    "sandbox.wall_time": "{what} was stopped after {seconds} s by the clock. Is it waiting for something?",
    "sandbox.notebook_time": (
        "the notebook has used the {seconds} s of computing that all its cells may take together; the rest was not run"
    ),
    "sandbox.memory": "{what} asked for more memory than the {size} MiB it may have. Is an array far larger than meant?",
    "sandbox.signal": "{what} ended the notebook's process: {how}. What comes after it could not be run",
    "sandbox.exit": (
        "{what} ended the notebook's own process (os._exit or the like, code {code}). What comes after it could not be run"
    ),
    "sandbox.closed": (
        "{what} closed a connection that it did not open (os.close or the like), and the notebook was stopped. "
        "What comes after it could not be run"
    ),
    "sandbox.protocol": (
        "the notebook's process sent something that is no answer ({error}); it was stopped. Does the code write to open files?"
    ),
    "sandbox.crash_segmentation": "a crash in compiled code (segmentation fault)",
    "sandbox.crash_abort": "a crash in compiled code (abort)",
    "sandbox.crash_bus": "a crash in compiled code (bus error), perhaps of a full scratch folder",
    "sandbox.crash_arithmetic": "a crash in compiled code (arithmetic)",
    "sandbox.crash_instruction": "a crash in compiled code (illegal instruction)",
    "sandbox.forbidden": "a system call that is not allowed",
    "sandbox.killed": "it was killed",
    "sandbox.number": "signal {number}",
    "sandbox.not_shown": "[this output cannot be shown here: {kinds}]",
    "sandbox.nothing": "nothing",
    # --- a notebook's own process: what it writes among the outputs, and what stops a call or a test
    "guest.more": "... the output of this cell is cut here: it shows more than {size} kB.",
    "guest.many": "... the output of this cell is cut here: it shows more than {count} things.",
    "guest.unshown": "(its message cannot be shown)",
    "guest.computing": "stopped after {seconds} s of computing; is there a loop that never ends?",
    "guest.clock": "stopped after {seconds} s by the clock; is it waiting for something?",
    "guest.asks": "{name}() has nobody to ask while the grader runs the notebook; use a variable instead",
    "guest.judging": "The grader is judging {name}; its verdict stands at the graded cell.",
    "guest.this_function": "this function",
    "guest.only_check": (
        "{name} is not there while the grader runs a notebook: only autograder.check and autograder.personal are"
    ),
    "guest.only_plot": (
        "{name} is not there while the grader runs a notebook: the exercise is to write it yourself. "
        "directrix.plot may be used."
    ),
    "guest.missing": "the notebook defines no function called {name}",
    "guest.no_function": "{name} is not a function in the notebook but of type {type}",
    "guest.parts": "the answer has {count} parts; at most {most} are taken",
    "guest.bytes": "the answer has {count} bytes; at most {most} are taken",
    "guest.hands_over": "the test hands over {what}, which cannot go to the learner's process",
    "guest.answers_with": "the learner's process answers with {what}",
    "guest.unsent": "the answer cannot be sent: {error}",
    "guest.cannot_leave": "{name} is {what}, which cannot leave the notebook for this test",
    "guest.answer": "the answer",
    "guest.has_now": "an argument has {what} in it now, which cannot leave the notebook for this test",
    "guest.to_and_fro": "more than {most} calls to and fro between a test and the code it tests",
    "guest.raised": "the function raised {exception}",
    "guest.stays": "{name} of {function} stays in the learner's process",
    "guest.nonsense": "the learner's process answers nonsense",
    "guest.ended": "the learner's process has ended",
    "guest.protocol": "the learner's process does not keep to the protocol: {error}",
    "guest.never_handed": "a function that was never handed over",
    "guest.deep": "lists, tuples or dictionaries more than {most} deep",
    "guest.object": "an object of type {type}",
    "guest.dtype": "an array of dtype {dtype}",
    "guest.no_value": "something that is not a value ({exception})",
    "guest.no_plain": "a plain value that is none",
    "guest.no_array": "an array that is none",
    "guest.no_text": "an array of text that is none",
}
