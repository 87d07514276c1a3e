"""A walk moves the same place in the square and on the surface."""

import numpy as np
import pytest
from directrix import plot
from directrix.errors import GeometryError, ShapeError


def helix_sheet(u, w):
    """A tube of radius 1: a diagonal of the square becomes a helix."""
    u, w = np.broadcast_arrays(u, w)
    return np.stack([np.cos(2 * np.pi * u), np.sin(2 * np.pi * u), w], axis=-1)


def test_each_frame_puts_both_markers_at_one_place():
    """The point in space of every frame is the surface at the (u, w) of the same frame."""
    figure = plot.walk(helix_sheet, [[0, 0], [1, 1]], steps=9)
    assert len(figure.frames) == 9
    for frame in figure.frames:
        in_space, in_square = frame.data
        expected = helix_sheet(in_square.x[0], in_square.y[0])
        np.testing.assert_allclose([in_space.x[0], in_space.y[0], in_space.z[0]], expected, atol=1e-12)


def test_frames_move_the_two_markers_and_nothing_else():
    """The traces that a frame replaces are the diamonds, one in the scene and one in the square."""
    figure = plot.walk(helix_sheet, [[0, 0], [1, 1]], steps=3)
    moved = [figure.data[i] for i in figure.frames[1].traces]
    assert [trace.type for trace in moved] == ["scatter3d", "scatter"]
    assert all(trace.marker.symbol == "diamond" for trace in moved)


def test_polygon_is_walked_evenly_round_its_corners():
    """Half of the way along an L of two equal legs is its corner."""
    figure = plot.walk(helix_sheet, [[0, 0], [1, 0], [1, 1]], steps=5)
    assert (figure.frames[2].data[1].x[0], figure.frames[2].data[1].y[0]) == (1.0, 0.0)


def test_slider_has_a_step_for_every_frame_and_tells_the_place():
    """What the slider says is where the marker is."""
    figure = plot.walk(helix_sheet, lambda t: np.stack([t, t**2], axis=-1), steps=3)
    assert [step.label for step in figure.layout.sliders[0].steps] == ["(0.00, 0.00)", "(0.50, 0.25)", "(1.00, 1.00)"]
    assert [step.args[0][0] for step in figure.layout.sliders[0].steps] == [frame.name for frame in figure.frames]


@pytest.mark.parametrize(
    ("path", "error", "said"),
    [
        ([[0, 0], [2, 0]], GeometryError, "stay in the unit square"),
        ([[0.5, 0.5]], ShapeError, "at least two corners"),
        ([[0.5, 0.5], [0.5, 0.5]], GeometryError, "lead somewhere"),
        (lambda t: t, ShapeError, r"path\(t\) must give places"),
    ],
)
def test_bad_path_is_refused(path, error, said):
    """A path is places (u, w) of the square."""
    with pytest.raises(error, match=said):
        plot.walk(helix_sheet, path)
