"""A figure that is put together is the figure that plotly makes of the same dictionaries, whatever one does with it."""

from __future__ import annotations

import copy
import pickle

import directrix as dx
import numpy as np
import plotly.graph_objects as go
import pytest
from directrix.plot import assembling, view, viewing

PICTURES = {
    "surface": lambda: view(dx.Sphere(2), square=True, mark=(0.5, 0.25), normals=True, title="a sphere"),
    "comparison": lambda: view(dx.Sphere(2), against=dx.Sphere(2.1)),
    "net": lambda: view(dx.BezierPatch(np.ones((3, 3, 3))), net=True),
    "curve": lambda: view(dx.Circle((0, 0, 0), 2, (0, 0, 1)), curves={"c": np.eye(3)}),
    "points": lambda: view(dx.Plane(*np.eye(3)), points=np.eye(3), deviations=[0.1, 0.0, -0.2]),
    "curvature": lambda: view(dx.Torus(3, 1), colour="gaussian", height=300),
    "solid": lambda: view(lambda u, v, w: np.stack(np.broadcast_arrays(u, v, w), axis=-1)),
}


@pytest.fixture(params=PICTURES)
def both(request, monkeypatch):
    """The same picture put together and made by plotly."""
    ours = PICTURES[request.param]()
    monkeypatch.setattr(viewing, "figure_of", assembling._by_plotly)
    return ours, PICTURES[request.param]()


def test_this_plotly_keeps_its_figures_as_expected():
    assert assembling._keeps_dictionaries()


def test_it_has_in_it_what_plotly_puts_there(both):
    ours, theirs = both
    assert assembling._inside(ours) == assembling._inside(theirs)
    assert ours.to_json() == theirs.to_json()
    assert ours == theirs


def test_whatever_is_done_with_it_comes_out_the_same(both):
    ours, theirs = both
    for figure in both:
        figure.update_traces(line={"width": 7}, selector={"type": "scatter3d"})
        figure.data[0].x[0] = 5.0
        figure.data[0].update(opacity=0.5, hoverlabel_font_size=9)
        figure.add_scatter3d(x=[0], y=[0], z=[0]).add_annotation(text="b", x=0, y=0)
        figure.update_layout(scene_camera_eye_x=2, title="c", scene2={"xaxis": {"title": "d"}})
        figure.layout.annotations[0].text += "e"
        figure.data = figure.data[1:]
    assert ours.to_json() == theirs.to_json()
    for way in (
        copy.copy,
        copy.deepcopy,
        go.Figure,
        lambda one: pickle.loads(pickle.dumps(one)),
        lambda one: go.Figure(one.data),
    ):
        assert way(ours).to_json() == way(theirs).to_json()
    assert repr(ours) == repr(theirs)
    for nonsense in (lambda one: one.data[0].update(nonsense=1), lambda one: one.update_layout(scene_nonsense=1)):
        said = []
        for figure in both:
            with pytest.raises(ValueError, match="nonsense") as caught:
                nonsense(figure)
            said.append(str(caught.value))
        assert said[0] == said[1]


def test_two_figures_share_nothing_that_may_change():
    one, other = (view(dx.Sphere(2), against=dx.Sphere(2.1)) for _ in range(2))
    for mine, yours in zip((one, one.layout, *one.data), (other, other.layout, *other.data), strict=True):
        for name, value in vars(mine).items():
            assert not isinstance(value, dict | list | set) or value is not vars(yours)[name], name
    assert one.data[1] is not one.data[2]
    assert all(part.figure is one for part in (one.layout, one.layout.scene2, *one.data))


def test_what_is_changed_in_one_figure_stays_in_it():
    before = view(dx.Sphere(2), title="a").to_json()
    changed = view(dx.Sphere(2), title="a")
    changed.update_traces(line_width=9, selector={"type": "scatter3d"}).update_layout(scene_camera_up_x=3)
    changed.data[0].lighting.ambient = 0.1
    changed._data[0]["colorscale"][0][1] = "red"
    assert view(dx.Sphere(2), title="a").to_json() == before


@pytest.mark.parametrize("name", ["_data", "_layout"])
def test_another_plotly_makes_its_figures_itself(name, monkeypatch):
    """One that keeps something else besides, or that keeps its dictionaries elsewhere."""
    stock = go.Figure.__init__

    def otherwise(figure, data=None, layout=None, **options):
        stock(figure, data, layout, **options)
        object.__setattr__(figure, "_also", list(data or ()))

    monkeypatch.setattr(go.Figure, "__init__", otherwise)
    assert not assembling._keeps_dictionaries.__wrapped__()
    monkeypatch.setattr(go.Figure, "__init__", stock)
    monkeypatch.setattr(go.Figure, name, property(lambda _: [], lambda *_: None), raising=False)
    assert not assembling._keeps_dictionaries.__wrapped__()
