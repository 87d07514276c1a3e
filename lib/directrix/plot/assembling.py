"""A plotly figure from plain dictionaries that are known to be right.

plotly makes an object for every trace by asking each of its 75 or so properties whether it was given, and copies what it finds
twice; for a picture of a surface that is more than half of all work. But a trace in a figure holds nothing itself: its
properties are in a dictionary of the figure. So here the dictionaries are handed to the figure, and the objects, which are all
alike, are copies of one that plotly has made. Where a trial shows that another version of plotly keeps its figures in another
way, it makes them itself.
"""

from __future__ import annotations

import copy
import functools
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from plotly.graph_objects import Figure

Part = dict[str, Any]
CONTAINERS = (dict, list, set)


def figure_of(traces: list[Part], layout: Part) -> Figure:
    """The figure of valid traces, each of which tells its type, and of a valid layout, which tells its template.

    The arrays in them become the figure's own. What is changed in the figure later is checked as ever.
    """
    make = _put_together if _keeps_dictionaries() else _by_plotly
    return make(traces, layout)


def _by_plotly(traces: list[Part], layout: Part) -> Figure:
    import plotly.graph_objects as go

    figure = go.Figure(traces, layout, _validate=False)
    for part in (figure, figure.layout, *figure.data):
        part._validate = True
    return figure


def _put_together(traces: list[Part], layout: Part) -> Figure:
    figure = _like(_empty())
    about = figure._layout_obj = _like(figure._layout_obj, _parent=figure)
    numbered = {name: _ordered(part) for name, part in layout.items() if name[-1].isdigit()}
    figure._layout = _sorted(layout, numbered) | numbered
    for name in numbered:  # such as scene2: a layout knows those that it has, and has an object of each
        about._valid_props.add(name)
        about._subplotid_props.add(name)
        about[name]
    figure._data = [_sorted(trace, {"type"}) | {"type": trace["type"]} for trace in traces]
    figure._data_defaults = [{} for _ in traces]
    figure._data_objs = [_like(_bare(trace["type"]), _parent=figure, _trace_ind=at) for at, trace in enumerate(traces)]
    return figure


def _like(part: Any, **changed: Any) -> Any:
    """A part of its own with all that this one keeps: plotly makes the same of the same each time, at ten times the cost."""
    own = object.__new__(type(part))
    vars(own).update(
        {name: copy.copy(one) if isinstance(one, CONTAINERS) else one for name, one in vars(part).items()}, **changed
    )
    return own


@functools.cache
def _empty() -> Any:
    import plotly.graph_objects as go

    figure: Any = go.Figure(layout={"template": {}}, _validate=False)
    figure._validate = figure._layout_obj._validate = True
    return figure


@functools.cache
def _bare(kind: str) -> Any:
    """A trace whose properties are kept by its figure."""
    return _empty()._data_validator.get_trace_class(kind)(_parent=_empty())


def _sorted(part: Part, without: Any) -> Part:
    """A copy in the order in which plotly keeps the properties, down to the arrays; palettes are shared by many pictures."""
    return {name: _copied(part[name]) for name in sorted(part) if name not in without and part[name] is not None}


def _copied(value: Any) -> Any:
    if type(value) is dict:
        return {name: _copied(one) for name, one in value.items()}
    if type(value) is list:
        return [_copied(one) for one in value]
    return value


def _ordered(value: Any) -> Any:
    """A copy in that order throughout, as plotly keeps what it has made objects of."""
    return {name: _ordered(one) for name, one in sorted(value.items())} if type(value) is dict else _copied(value)


@functools.cache
def _keeps_dictionaries() -> bool:
    """Whether a figure that is put together has in it what plotly's own has."""
    traces = [{"type": kind, "name": "a", "x": [0.0, 1.0], "hoverinfo": "skip"} for kind in ("scatter3d", "scatter", "surface")]
    axis = {"range": [0, 1], "title": {"text": "x"}}
    layout = {
        "template": {},
        "paper_bgcolor": "red",
        "height": 300,
        "xaxis": axis,
        "scene2": {"yaxis": axis, "bgcolor": "red"},
        "meta": {"a": 1},
    }
    try:
        ours, theirs = (make(traces, layout) for make in (_put_together, _by_plotly))
        return _inside(ours) == _inside(theirs)
    except Exception:  # whatever it is that has gone from plotly
        return False


def _inside(figure: Any) -> Any:
    """All that a figure and its parts keep, in order; of an object only its type."""
    parts = (figure, figure.layout, *figure.data)
    for trace, properties in zip(figure.data, figure._data, strict=True):
        if trace.parent is not figure or trace._props is not properties:
            raise TypeError("a trace does not take its properties from the figure")
    return [[(name, _told(value)) for name, value in sorted(vars(part).items())] for part in parts]


def _told(value: Any) -> Any:
    if isinstance(value, dict):
        return type(value), [(name, _told(one)) for name, one in value.items()]
    if isinstance(value, list | tuple):
        return type(value), [_told(one) for one in value]
    return value if value is None or isinstance(value, str | int | float | set) else type(value)
