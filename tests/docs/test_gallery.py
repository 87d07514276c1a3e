"""The gallery: every form once, drawn by a browser."""

import sys
from pathlib import Path

import directrix as dx
import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "docs"))
import gallery
import pictures
from PIL import Image

FORMS = ("Curve", "Patch", "Sweep", "Hyperpatch")


@pytest.fixture(scope="module")
def every():
    return pictures.pictures()


def test_titles_differ(every):
    """Their words are the names of their files."""
    assert len({one.slug for one in every}) == len(every)


def test_every_form_has_its_picture(every, monkeypatch):
    """Each curve, surface and solid that can be made by name is drawn at least once, or is the part of one that is."""
    drawn = set()

    def noted(form, **options):
        drawn.update(type(one).__name__ for one in (form, *options.get("also", ()), *(options.get("curves") or {}).values()))

    monkeypatch.setattr(pictures, "view", noted)
    monkeypatch.setattr(pictures, "walk", lambda form, path: noted(form))
    for one in every:
        one.figure()
    forms = {
        name for name in dx.__all__
        if isinstance(getattr(dx, name), type) and not issubclass(getattr(dx, name), Exception)
    }  # fmt: skip
    assert forms - drawn <= {"Curve", "Surface", "Transform", "Quadric"}


def test_every_figure_is_finite(every):
    """No hole in any surface of the gallery, and words for who cannot see it."""
    for one in every:
        figure = one.figure()
        for trace in figure.data:
            if trace.type == "surface":
                assert np.isfinite(np.stack([trace.x, trace.y, trace.z])).all(), one.title
        assert figure.layout.meta["alt"], one.title


@pytest.mark.browser
@pytest.mark.usefixtures("chromium")
def test_pictures_are_made(tmp_path):
    """Two pictures and their sheet: of the size of the figure, and neither blank nor of one colour."""
    assert gallery.main(["--to", str(tmp_path), "ring", "torus as"]) == 0
    made = {path.name for path in tmp_path.glob("*.png")}
    assert made == {"ring-torus.png", "torus-as-nurbs.png", "sheet-known-forms.png", "sheet-freeform-patches.png"}
    image = np.asarray(Image.open(tmp_path / "ring-torus.png").convert("RGB"))
    assert image.shape == (460, 720, 3)
    inked = (image != 255).any(axis=-1)
    assert 0.05 < inked.mean() < 0.6
    colours = {tuple(colour) for colour in image.reshape(-1, 3)[::7]}
    assert len(colours) > 50


def test_words_that_fit_nothing_are_an_error(capsys):
    """Exit 2 with the words repeated."""
    with pytest.raises(SystemExit) as stopped:
        gallery.main(["klein"])
    assert stopped.value.code == 2
    assert "klein" in capsys.readouterr().err
