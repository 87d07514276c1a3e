"""A course of two small chapters, and its site: built once."""

import sys
from pathlib import Path

import pytest

from autograder import site as sites

sys.path.insert(0, str(Path(__file__).parent))

FIRST = """# %% [markdown]
# # Lines & planes <i>
#
# **How many points make a line?**
#
# You will need $n < 3$ of them.

# %% fold=true
def reveal(guess, answer):
    print("First guess." if guess is None else f"You said {guess}; it is {answer}.")

# %% [markdown]
# ## 1 · Two
#
# $$x = \\\\frac{a}{b}$$

# %%
points = None  # "one", "two" or <three>

# %%
print("counting <b>")
reveal(points, "two & no more")
surface = {"type": "surface", "z": [[0, 1], [1, 0]], "showscale": False}
left, right = {"domain": {"x": [0, 0.455], "y": [0, 1]}}, {"domain": {"x": [0.465, 0.92], "y": [0, 1]}}
layout = {"height": 300, "scene": left, "scene2": right, "meta": {"alt": "A saddle."}}
kind = "application/vnd.plotly.v1+json"
display({kind: {"data": [surface], "layout": layout, "frames": [{"name": "f", "data": []}]}}, raw=True)

# %%
def double(x):
    ### BEGIN SOLUTION
    return 2 * x
    ### END SOLUTION

# %%
print("doubled:", double(21))
marker = {"type": "scatter", "name": "a walk", "x": [0], "y": [0]}
at_once = {"mode": "immediate", "frame": {"duration": 0, "redraw": True}, "transition": {"duration": 0}}
steps = [{"label": f"step {i}", "method": "animate", "args": [[str(i)], at_once]} for i in range(4)]
layout = {"height": 300, "margin": {"b": 96}, "sliders": [{"steps": steps, "currentvalue": {"prefix": "at "}}]}
frames = [{"name": str(i), "data": [{"type": "scatter", "x": [i], "y": [i]}], "traces": [0]} for i in range(4)]
display({kind: {"data": [marker], "layout": layout, "frames": frames}}, raw=True)

# %% [markdown]
# ## Where to go
#
# On to [planes](02-planes.ipynb) and [A1](../A1/known-forms.ipynb).
"""
SECOND = "# %% [markdown]\n# # Planes\n#\n# **And a plane?**\n\n# %%\nnothing = None\n\n# %%\nprint('plain')\n"


@pytest.fixture(scope="session")
def chapters(tmp_path_factory):
    """The folder with the two texts."""
    folder = tmp_path_factory.mktemp("chapters")
    (folder / "01-lines.py").write_text(FIRST.replace("\\\\", "\\"), "utf-8")
    (folder / "02-planes.py").write_text(SECOND, "utf-8")
    return folder


@pytest.fixture(scope="session")
def built(chapters, tmp_path_factory):
    """Their site."""
    return sites.build(tmp_path_factory.mktemp("out") / "site", chapters)
