"""A student in JupyterLab: types a mistake into a notebook, reads the card, sees both surfaces, corrects it, passes."""

import pytest

from autograder import authoring
from tests.browser.lab import Lab
from tests.browser.pixels import colours

pytestmark = pytest.mark.browser

MISTAKE = """def cylinder(u, w, r, h):
    x = r * np.cos(u)
    y = r * np.sin(u)
    return np.stack(np.broadcast_arrays(x, y, h * w), axis=-1)"""
SLIP = "def cylinder(u, w, r, h):\n    return (r *"


@pytest.fixture(scope="module")
def workbook(tmp_path_factory):
    folder = tmp_path_factory.mktemp("workbook")
    authoring.workbook(folder)
    return folder


def test_a_student_types_a_mistake_sees_it_named_and_drawn_and_corrects_it(workbook, offline_page, tmp_path):
    """The main job at the learner's end, in the real thing and without a network."""
    with Lab(workbook, tmp_path, offline_page) as lab:
        lab.open("A1/known-forms.ipynb")
        lab.run_all_before("cylinder")
        lab.type_into("cylinder", MISTAKE)
        lab.run("cylinder")
        lab.run("check_cylinder")
        card = lab.output("check_cylinder")
        assert "angle" in card.inner_text(), card.inner_text()
        canvas = lab.canvas("check_cylinder")
        picture = lab.shot(canvas, "mistake-figure")
        assert colours(picture) > 200, "the comparison is blank"
        lab.shot(card, "mistake-card")
        assert lab.drag_and_read_cameras(canvas) == {"moved": True, "linked": True}

        lab.type_into(
            "cylinder", MISTAKE.replace("np.cos(u)", "np.cos(2 * np.pi * u)").replace("np.sin(u)", "np.sin(2 * np.pi * u)")
        )
        lab.run("cylinder")
        lab.run("check_cylinder")
        lab.wait_for_text("check_cylinder", lab.points_of("check_cylinder"))
        lab.shot(lab.output("check_cylinder"), "right-card")
        assert offline_page.strays == []


def test_a_syntax_slip_gets_a_card_of_its_own(workbook, offline_page, tmp_path):
    """The function does not exist when the check runs: the card says why, without a bare traceback."""
    with Lab(workbook, tmp_path, offline_page) as lab:
        lab.open("A1/known-forms.ipynb")
        lab.run_all_before("cylinder")
        lab.type_into("cylinder", SLIP)
        lab.run("cylinder")
        lab.run("check_cylinder")
        text = lab.output("check_cylinder").inner_text()
        assert "NameError" not in text
        assert "cylinder" in text
        lab.shot(lab.output("check_cylinder"), "syntax-card")
