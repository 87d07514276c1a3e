"""plotly's figures in a notebook, shown as plotly itself shows them, in a third of the time.

By itself plotly copies a figure, writes it as JSON and reads that again, and the shell writes it once more, each time with all
its arrays. Here it is written once. Whatever is not plainly a stock figure under the stock renderer goes plotly's own way, and
so does every figure where a trial shows that another version of plotly writes something else.
"""

from __future__ import annotations

import binascii
import contextlib
import copy
import functools
import importlib
import importlib.metadata
import json
import re
import sys
import types
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from autograder.sandbox.guest.shell import Shell

MIME = "application/vnd.plotly.v1+json"
RENDERER = "plotly_mimetype"
PLAIN = frozenset({str, int, float, bool, type(None), np.float64})
TYPED = {"f": "f4", "d": "f8"}  # single and double precision; other arrays are plotly's to write
BLANK = "\\ue000"  # a character that means nothing to anybody, as JSON writes it: the place of an array
IN_DICTIONARY = re.compile(r': \{"dtype": "f[48]", "bdata": "\\ue000"')  # plotly writes other arrays as lists, and so those in
NOT_CONVERTED = re.compile(r'"(?:geojson|layers?|range)": (?!\[[^][{}]*\]|[^][{}])')  # these, whatever is around them


class Other(Exception):
    """Something that plotly itself must write."""


def ask_nbformat_for_its_version_only() -> None:
    """plotly asks nbformat for nothing else, but loads it, and with it jsonschema and forty grammars of addresses: that takes
    longer than all that notebooks need. Whoever imports nbformat in a notebook gets all of it.
    """
    with contextlib.suppress(ImportError):  # PackageNotFoundError is one: plotly says what is missing
        nbformat: Any = types.ModuleType("nbformat")
        nbformat.__version__ = importlib.metadata.version("nbformat")
        if sys.modules.setdefault("nbformat", nbformat) is nbformat:
            try:
                importlib.import_module("plotly.io._renderers")
            finally:
                del sys.modules["nbformat"]


def take_arrays_as_they_are() -> None:
    """plotly asks narwhals of every array whether it is a table of pandas, polars or the like, which takes longer than
    to copy it. What is exactly an array of numpy is none, and narwhals would hand it back as it came.
    """
    try:  # by itself plotly loads it with the first figure only
        validators: Any = importlib.import_module("_plotly_utils.basevalidators")
    except ImportError:
        return
    narwhals = getattr(validators, "nw", None)
    ask = getattr(narwhals, "from_native", None)
    if narwhals is None or ask is None:  # another version of plotly
        return

    def from_native(value: Any, **options: Any) -> Any:
        return value if type(value) is np.ndarray and options.get("pass_through") else ask(value, **options)

    own = types.ModuleType(narwhals.__name__)
    own.__dict__.update(narwhals.__dict__, from_native=from_native)
    validators.nw = own


def find_validators_quickly() -> None:
    """plotly imports the store of its validators anew for every look into it, a fifth of the time that a figure takes."""
    with contextlib.suppress(ImportError, AttributeError):
        kind: Any = importlib.import_module("plotly.basedatatypes").BasePlotlyType
        store: Any = importlib.import_module("plotly.validator_cache").ValidatorCache
        known, find = store._cache, kind._get_validator
        layout: Any = importlib.import_module("plotly.graph_objects").Layout()
        if type(known) is not dict or find(layout, "title") is not known.get((layout._path_str, "title")):
            return  # another version of plotly

        @functools.wraps(find)
        def _get_validator(self: Any, prop: Any) -> Any:
            found = known.get((self._path_str, prop))
            return find(self, prop) if found is None else found

        kind._get_validator = _get_validator


def copy_quickly() -> None:
    """plotly copies what a figure consists of at every step, and Python's way to do that is made for graphs of objects."""
    with contextlib.suppress(ImportError):
        figures: Any = importlib.import_module("plotly.basedatatypes")
        if getattr(figures, "deepcopy", None) is copy.deepcopy:
            figures.deepcopy = copied


def copied(value: Any) -> Any:
    """``copy.deepcopy`` of plain dictionaries and lists with anything in them."""
    try:
        return _copied(value)
    except RecursionError:  # it holds itself
        return copy.deepcopy(value)


def _copied(value: Any) -> Any:
    kind = type(value)
    if kind is dict:
        return {key if type(key) is str else copy.deepcopy(key): _copied(item) for key, item in value.items()}
    if kind is list:
        return [_copied(item) for item in value]
    return value if kind in PLAIN else copy.deepcopy(value)


def show_at_once(shell: Shell) -> None:
    """Have the shell show stock figures by :class:`Shower`, if that writes what plotly writes."""
    with contextlib.suppress(Exception):
        shower = Shower(shell)
        if shower.is_faithful():
            formatter: Any = shell.display_formatter
            formatter.ipython_display_formatter.for_type(shower.kind, shower.show)


class Shower:
    """Shows a figure; holds what of plotly it stands for, to tell whether that is still in its place."""

    def __init__(self, shell: Shell) -> None:
        self.shell = shell
        self.kind: Any = importlib.import_module("plotly.graph_objects").Figure
        self.io: Any = importlib.import_module("plotly.io")
        self.publisher = type(shell.display_pub)
        self.renderer = type(self.io.renderers[RENDERER])
        self.writing: Any = importlib.import_module("plotly.io._base_renderers")
        self.stock = self._methods()

    def show(self, figure: Any) -> None:
        """What IPython calls for a figure that a cell ends with or hands to ``display``."""
        text = None
        if self._is_stock(figure):
            with contextlib.suppress(Exception):  # plotly's own way tells it
                text = self.text(figure)
        if text is None:
            figure._ipython_display_()
        else:
            self.shell.recorder.show("display_data", [(MIME, text)])

    def text(self, figure: Any) -> str:
        """The figure as JSON, as the recorder writes what plotly's renderer hands to it."""
        arrays: list[str] = []

        def put_by(value: Any) -> dict[str, str]:
            """An array as plotly writes it, but for what is in it."""
            name = TYPED.get(value.dtype.char) if type(value) is np.ndarray else None
            if name is None or not value.size or not value.ndim or not value.dtype.isnative:
                raise Other
            arrays.append(binascii.b2a_base64(np.ascontiguousarray(value).data, newline=False).decode("ascii"))
            written = {"dtype": name, "bdata": "\ue000"}
            if value.ndim > 1:
                written["shape"] = str(value.shape)[1:-1]
            return written

        whole = {"data": figure._data, "layout": figure._layout}
        if frames := [frame._props for frame in figure._frame_objs]:
            whole["frames"] = frames
        if config := self.writing._get_jconfig(self.io.renderers[RENDERER].config):
            whole["config"] = config
        return _filled(json.dumps(whole, allow_nan=False, default=put_by), arrays)

    def is_faithful(self) -> bool:
        """Whether a figure with a bit of everything is written as plotly writes it."""
        grid = np.linspace(0, 1, 12).reshape(3, 4)
        traces = [
            {"type": "surface", "z": grid.T, "x": grid.astype("f4"), "showscale": False, "customdata": np.dstack([grid] * 2)},
            {
                "type": "scatter",
                "x": [1, 2.5, 1e-7],
                "y": np.arange(3.0),
                "text": ["<a>", "\u00e9/", "NaN"],
                "line": {"width": 1},
            },
        ]
        layout = {
            "title": {"text": "a"},
            "annotations": [{"text": "b", "x": 0}],
            "xaxis": {"range": [0, 1]},
            "meta": {"a": [1]},
        }
        figure = self.kind(traces, layout)
        bundle = self.io.renderers._build_mime_bundle(figure.to_dict(), RENDERER)
        return list(bundle) == [MIME] and json.dumps(bundle[MIME], allow_nan=False) == self.text(figure)

    def _is_stock(self, figure: Any) -> bool:
        renderers = self.io.renderers
        return (
            type(figure) is self.kind
            and type(self.shell.display_pub) is self.publisher
            and type(renderers[RENDERER]) is self.renderer
            and renderers.default == RENDERER
            and bool(renderers.render_on_display)
            and self._methods() == self.stock
        )

    def _methods(self) -> tuple[Any, ...]:
        """What a notebook could have put something else for."""
        figure, renderer = self.kind, self.renderer
        return figure._ipython_display_, figure.to_dict, renderer.to_mimebundle, self.io.show, self.writing.to_json


def _filled(text: str, arrays: list[str]) -> str:
    """The JSON with the base64 of the arrays in their places: nothing in it is to be escaped, and to look takes longer than
    all the rest.
    """
    between = text.split(BLANK)
    if not len(between) - 1 == len(arrays) == len(IN_DICTIONARY.findall(text)) or NOT_CONVERTED.search(text):
        raise Other
    pieces = [piece for pair in zip(between, arrays, strict=False) for piece in pair]
    return "".join([*pieces, between[-1]])
