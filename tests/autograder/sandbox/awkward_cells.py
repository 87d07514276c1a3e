"""Cells at the edges of what a Jupyter kernel does: the table that our engine is held to, with where it differs and why.

Each group is one notebook: its cells share a kernel (or a session of ours) and run in this order.
"""

PLAIN = {
    "line magic with a value": "%precision 3\n3.14159",
    "%time of an expression": "%time sum(range(10))",
    "%time of a statement": "%time timed = 1",
    "%%time": "%%time\nvalue = 1\nvalue",
    "%timeit": "%timeit -n 3 -r 2 pass",
    "%%timeit with set-up": "%%timeit -n 2 -r 2 held = 1\nheld + 1",
    "%%capture": "%%capture held\nprint('held'); 5",
    "what %%capture held": "held.stdout, len(held.outputs)",
    "unknown line magic": "%unknown_magic",
    "unknown cell magic": "%%unknown_magic\nx = 1",
    "%%writefile": "%%writefile helper_of_mine.py\nanswer = 42\nprint('read')",
    "%run": "%run helper_of_mine.py\nanswer",
    "%load": "%load helper_of_mine.py",
    "%who": "%who_ls str",
    "%pinfo and ?": "import math\nmath.sin?",
    "assigned magic": "where = %pwd\nisinstance(where, str)",
    "result, then display, then text": "display({'a': 1}); print('text')\n'result'",
    "display_id, updated in its own cell": "h = display('first', display_id='one'); print('between'); h.update('second')",
    "display_id, updated from a later cell": "h.update('third')\nprint('elsewhere')",
    "display_id, shown twice": "h.display('fourth'); h.update('fifth')",
    "clear_output": "from IPython.display import clear_output\nprint('gone'); clear_output(); print('stays')",
    "clear_output(wait=True)": "print('gone'); clear_output(wait=True); display(1)",
    "clear_output(wait=True), nothing follows": "print('stays'); clear_output(wait=True)",
    "semicolon": "5;",
    "semicolon in a comment": "5  # not hidden;",
    "last expression after a def": "def f(): pass\n(f.__name__, 1)",
    "_, __, Out and In": "_, Out[max(Out)] == _, In[1][:9]",
    "_ of a cell without a value": "x = 3",
    "_ after it": "_",
    "only a comment": "# nothing",
    "empty": "",
    "indented cell": "    indented = 1\n    indented",
    "rich reprs of every kind": (
        "class Rich:\n"
        "    def _repr_html_(self): return '<i>r</i>'\n"
        "    def _repr_latex_(self): return '$x$'\n"
        "    def _repr_markdown_(self): return '*r*'\n"
        "    def _repr_svg_(self): return '<svg/>'\n"
        "    def _repr_png_(self): return bytes.fromhex('89504e470d0a1a0a') + b'123'\n"
        "    def _repr_json_(self): return {'a': [1, None]}\n"
        "    def __repr__(self): return 'rich'\n"
        "Rich()"
    ),
    "_repr_mimebundle_": (
        "class Bundle:\n"
        "    def _repr_mimebundle_(self, include=None, exclude=None):\n"
        "        return {'text/plain': 'p', 'text/html': '<b>h</b>'}, {'text/html': {'isolated': True}}\n"
        "Bundle()"
    ),
    "image with a size": (
        "from IPython.display import Image, HTML, Math, JSON, SVG, Latex, Pretty\n"
        "Image(data=bytes.fromhex('89504e470d0a1a0a') + b'123', format='png', width=3, height=4)"
    ),
    "displays of IPython": "display(HTML('<b>x</b>'), Math('x^2'), Latex('$y$'), Pretty('p'))",
    "publish_display_data": (
        "from IPython.display import publish_display_data\npublish_display_data({'text/plain': 'a', 'text/html': '<p>a'})"
    ),
    "bad __repr__": "class Bad:\n    def __repr__(self): raise ValueError('bad repr')\nBad()",
    "bad _repr_html_": (
        "class Half:\n    def _repr_html_(self): raise ValueError('bad html')\n    def __repr__(self): return 'half'\nHalf()"
    ),
    "__repr__ that is no text": "class Odd:\n    def __repr__(self): return 3\nOdd()",
    "lone surrogate printed": "print('a\\ud800b')",
    "lone surrogate as a value": "'a\\ud800b'",
    "NaN in JSON": "JSON({'x': float('nan'), 'y': [float('inf')]})",
    "huge value": "list(range(100_000))",
    "generator": "(i for i in range(3))",
    "nested generators printed": "def g():\n    yield 1\n    yield from (2, 3)\nprint(*g()); list(g())",
}
ERRORS = {
    "traceback through cells": "def broken():\n    return 1 / 0\n\nbroken()",
    "chained exceptions": "try:\n    broken()\nexcept ZeroDivisionError as error:\n    raise KeyError('inner') from error",
    "raised while handling": "try:\n    broken()\nexcept ZeroDivisionError:\n    raise KeyError('while')",
    "from None": "try:\n    broken()\nexcept ZeroDivisionError:\n    raise KeyError('alone') from None",
    "exception group": "raise ExceptionGroup('many', [ValueError('a'), TypeError('b')])",
    "note of an exception": "error = ValueError('noted'); error.add_note('look here'); raise error",
    "SyntaxError": "for i in range(3)\n    pass",
    "IndentationError": "if True:\npass",
    "SyntaxError of exec": "exec('1 +')",
    "SystemExit": "raise SystemExit(3)",
    "sys.exit in a function": "import sys\ndef leave(): sys.exit('left')\nleave()",
    "KeyboardInterrupt": "raise KeyboardInterrupt",
    "recursion": "def deep(n): return deep(n + 1)\ndeep(0)",
    "exception whose __str__ fails": "class Mute(Exception):\n    def __str__(self): raise ValueError('no')\nraise Mute",
    "exception in __del__": (
        "class Last:\n    def __del__(self): raise ValueError('in del')\nlast = Last()\ndel last\nprint('after')"
    ),
    "text before an error": "print('before')\ndisplay('shown')\nraise LookupError('after')",
    "missing module": "import nothing_of_that_name",
    "warning": "import warnings\nwarnings.warn('careful')",
    "warning again in the next cell": "def careful(): warnings.warn('once a cell')\ncareful(); careful()",
    "numpy's warning": "import numpy as np\nnp.array([1.0]) / 0",
    "logging": "import logging\nlogging.warning('logged'); logging.info('not shown')",
    "stderr": "import sys\nsys.stderr.write('oops\\n'); None",
    "print to stderr, then a value": "print('e', file=sys.stderr)\n1",
    "stdout and stderr in turn": "print('1'); print('2', file=sys.stderr); print('3'); print('4', file=sys.stderr)",
    "C-level print": "import os, time\nos.write(1, b'past Python\\n'); time.sleep(0.5)",
    "C-level print to stderr": "os.write(2, b'past Python\\n'); time.sleep(0.5)",
    "carriage returns": "for i in range(3): print(f'\\r{i}', end='')",
    "flush and isatty": "print('f', flush=True); sys.stdout.isatty(), sys.stdout.encoding",
    "print to the original stdout": "sys.stdout.buffer.write(b'raw\\n') if hasattr(sys.stdout, 'buffer') else 'no buffer'",
    "contextlib.redirect_stdout": (
        "import contextlib, io\nheld = io.StringIO()\nwith contextlib.redirect_stdout(held): print('inside')\nheld.getvalue()"
    ),
    "input()": "input('name? ')",
    "getpass()": "import getpass\ngetpass.getpass()",
    "!command": "!echo hello",
    "%%bash": "%%bash\necho hello",
    "thread that prints, joined": (
        "import threading\nt = threading.Thread(target=lambda: print('from a thread')); t.start(); t.join(); print('joined')"
    ),
    "exception in a thread": "t = threading.Thread(target=lambda: 1 / 0); t.start(); t.join(); print('goes on')",
    "__name__, __file__ and argv": "__name__, '__file__' in globals()",
    "execution count": "get_ipython().execution_count == len(In) - 1",
}
ASYNC = {
    "await": "import asyncio\nawait asyncio.sleep(0)\n'awaited'",
    "async function": "async def f(): return 7\nawait f()",
    "async for and with": (
        "class C:\n    async def __aenter__(self): return 'in'\n    async def __aexit__(self, *a): print('out')\n"
        "async with C() as c: print(c)\n[i async for i in (i for i in ())] if False else c"
    ),
    "create_task": "task = asyncio.get_running_loop().create_task(f())\nawait task",
    "task over two cells": "late = asyncio.get_running_loop().create_task(f())",
    "its result": "await late",
    "gather": "await asyncio.gather(f(), asyncio.sleep(0, 'slept'))",
    "error after await": "async def g():\n    await asyncio.sleep(0)\n    raise ValueError('late')\nawait g()",
    "asyncio.run": "kept = f()  # or a warning appears in whichever later cell it is collected\nasyncio.run(kept)",
    "await outside async": "def h(): await f()",
    "asyncio timeout": "await asyncio.wait_for(asyncio.sleep(9), 0.01)",
}
FIGURES = {
    "matplotlib, shown after the cell": (
        "%matplotlib inline\nimport matplotlib.pyplot as plt\nfig, ax = plt.subplots(figsize=(1, 1), dpi=30); print('drawn')"
    ),
    "plt.show in the middle": "plt.figure(figsize=(1, 1), dpi=30); plt.show(); print('after')",
    "a figure as the value": "fig",
    "two figures": "for _ in range(2): plt.figure(figsize=(1, 1), dpi=30)",
    "plt.close": "plt.figure(figsize=(1, 1)); plt.close(); 'nothing'",
    "figure before an error": "plt.figure(figsize=(1, 1), dpi=30)\nraise ValueError('after the figure')",
    "matplotlib's list of artists": "plt.figure(figsize=(1, 1), dpi=30)\nplt.plot([1, 2])",
    "%matplotlib --list": "%matplotlib --list",
    "plotly value": "import plotly.graph_objects as go\ngo.Figure(go.Scatter(y=[1, 2]))",
    "plotly show": "go.Figure(go.Scatter(y=[1, 2])).show(); print('after')",
    "ipywidgets": "import ipywidgets\nipywidgets.IntSlider(value=3)",
    "Output widget": "out = ipywidgets.Output()\nwith out: print('inside')\ndisplay('after')",
    "interact": "ipywidgets.interact(lambda n: print(n), n=3)",
    "comm": "from comm import create_comm\nc = create_comm(target_name='x', data={'a': 1}); c.send({'b': 2}); c.close()",
    "kernel": "get_ipython().kernel is not None",
}
GROUPS = {"plain": PLAIN, "errors": ERRORS, "async": ASYNC, "figures": FIGURES}

READ = (
    "a kernel's cells are files that IPython cannot read, so it shows a frame at the line where it stands, not where it failed"
)
STREAMS = "a kernel joins what came to stdout, then what came to stderr; ours keep the order in which they came"
WIDGETS = "a widget lives in a kernel that is gone when the notebook is read; its text stays"
PROCESSES = "no processes (the engine `jupyter` allows a few)"
SURE = "a kernel shows its own frames and its own failure; ours name the learner's"
ASKING = "the message says what to do instead"

# The same error, the same frames; other lines of source around them, or another line number.
OTHER_LINES = {
    "bad __repr__": READ,
    "bad _repr_html_": READ,
    "traceback through cells": READ,
    "chained exceptions": READ,
    "raised while handling": READ,
    "from None": READ,
    "error after await": READ,
}
DIFFERENT = {
    "rich reprs of every kind": "an SVG may carry a script: it is left out where there is another picture or text",
    "lone surrogate printed": "a kernel cannot send it and prints its own failure; ours prints the escape",
    "NaN in JSON": "a kernel sends the words nan and inf and warns on stderr, which costs the cell its points; ours is null",
    "recursion": "IPython shortens repeated frames where it can read them, which for a kernel's cells it cannot",
    "exception whose __str__ fails": SURE,
    "stdout and stderr in turn": STREAMS,
    "input()": ASKING,
    "getpass()": ASKING,
    "!command": PROCESSES,
    "%%bash": PROCESSES,
    "ipywidgets": WIDGETS,
    "Output widget": WIDGETS + "; what it caught is printed",
    "interact": WIDGETS + "; what it caught is printed",
    "kernel": "there is none; the engine `jupyter` has one",
}
