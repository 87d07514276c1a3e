"""Pictures of curves, surfaces and solids: of anything that can be called with its parameters.

``view(f)`` returns a plotly figure; ``view(f, against=g)`` compares two surfaces; ``walk(f, path)`` moves a marker over one.
``compare`` draws samplings that are at hand already and returns plain JSON. This package imports no surface and, until a figure
object is made, no plotly either.
"""

from __future__ import annotations

from directrix.plot.comparing import compare
from directrix.plot.viewing import view
from directrix.plot.walking import walk

__all__ = ["compare", "view", "walk"]
