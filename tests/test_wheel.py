"""The built wheel, installed into an empty environment and used from another folder, is the whole product."""

import json
import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
UV = os.environ.get("UV") or shutil.which("uv")


def run(*command, cwd, **options):
    clean = {key: value for key, value in os.environ.items() if key not in ("PYTHONPATH", "VIRTUAL_ENV", "CI")}
    result = subprocess.run([str(part) for part in command], cwd=cwd, capture_output=True, text=True, env=clean, **options)
    assert result.returncode == 0, f"{command}\n{result.stdout[-2000:]}\n{result.stderr[-3000:]}"
    return result.stdout


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    if UV is None:
        pytest.skip("uv is not on the path: run the tests with `uv run pytest`")
    folder = tmp_path_factory.mktemp("dist")
    run(UV, "build", "--wheel", "--out-dir", folder, ROOT, cwd=folder)
    (built,) = folder.glob("*.whl")
    return built


def test_the_wheel_carries_every_assignment_and_chapter_and_no_solved_notebook(wheel):
    """Exercises and notebook sources are there; between the solution markers stands the stub."""
    with zipfile.ZipFile(wheel) as archive:
        names = set(archive.namelist())
        for room in ("assignments", "course"):
            wanted = [path for path in (ROOT / room).rglob("*.py") if "__pycache__" not in path.parts]
            assert wanted
            for path in wanted:
                assert f"autograder/shipped/{path.relative_to(ROOT).as_posix()}" in names
        assert not [name for name in names if name.endswith(".ipynb")]
        shipped = {name: archive.read(name).decode() for name in names if name.endswith("/notebook.py")}
    assert len(shipped) >= 3
    for name, text in shipped.items():
        original = (ROOT / name.removeprefix("autograder/shipped/")).read_text("utf-8")
        solved = regions(original)
        assert len(solved) >= 4
        assert len(regions(text)) == len(solved)
        for body in solved:
            assert len(body) > 20
            assert body not in text


def regions(text):
    """What stands between each pair of solution markers."""
    return [part.split("### END SOLUTION")[0].strip(" #\n") for part in text.split("### BEGIN SOLUTION")[1:]]


@pytest.fixture(scope="module")
def python(wheel, tmp_path_factory):
    """An empty environment with the wheel in it."""
    place = tmp_path_factory.mktemp("environment") / "venv"
    run(UV, "venv", "--python", sys.executable, place, cwd=place.parent)
    interpreter = place / "bin" / "python"
    run(UV, "pip", "install", "--python", interpreter, wheel, cwd=place.parent)
    return interpreter


def test_an_installed_wheel_judges_and_grades_from_another_folder(python, tmp_path):
    """Make a course, release it, hand in the sample class's first two notebooks, grade them in the sandbox."""
    where = run(python, "-c", "import autograder, directrix; print(autograder.__file__, directrix.__file__)", cwd=tmp_path)
    assert f"{ROOT}/" not in where
    verdict = run(
        python, "-c",
        "import numpy as np; from autograder import judge_function\n"
        "f = lambda u, w, r, h: np.stack(np.broadcast_arrays(r*np.cos(u), r*np.sin(u), h*w), -1)\n"
        "print(judge_function('cylinder', f).mistake)",
        cwd=tmp_path,
    )  # fmt: skip
    assert verdict.strip() == "no_2pi"
    directrix = python.with_name("directrix")
    run(directrix, "new", "course", "--assignment", "A1", cwd=tmp_path)
    run(directrix, "release", "A1", "--course", "course", cwd=tmp_path)
    run(
        python, "-c",
        "from pathlib import Path; from autograder import demo; from autograder.fleet import Course\n"
        "for member in demo.cohort('A1')[:2]:\n"
        "    demo.submit_one(member, Path('course/release/A1/known-forms.ipynb'), Course(Path('course')), 'A1')",
        cwd=tmp_path,
    )  # fmt: skip
    graded = json.loads(run(directrix, "grade", "A1", "--course", "course", "--json", cwd=tmp_path))
    assert graded["level"] == "A"
    for student in graded["students"]:  # both are right: all points but those of the written answer, which waits for a person
        assert [cell["points"] for cell in student["cells"] if cell["exercise"]] == [4.0, 5.0, 5.0, 6.0, 4.0]
    pages = json.loads(run(directrix, "feedback", "A1", "--course", "course", "--json", cwd=tmp_path))
    assert len(pages) == 2
