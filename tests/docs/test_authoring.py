"""The page "Write your own exercise", followed to the letter in an empty folder."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

PAGE = Path(__file__).resolve().parents[2] / "docs" / "authoring.md"
BLOCK = re.compile(r"^```(\w+)(?: (\w+)=(\S+))?\n(.*?)^```$", re.DOTALL | re.MULTILINE)


@pytest.fixture(scope="module")
def followed(tmp_path_factory):
    """The course folder after every block of the page, and what each command said."""
    place = tmp_path_factory.mktemp("empty")
    tools = str(Path(sys.executable).parent)
    environment = {**os.environ, "PATH": os.pathsep.join([tools, os.environ["PATH"]])}
    said = {}
    for language, how, where, text in BLOCK.findall(PAGE.read_text("utf-8")):
        if how in ("file", "append"):
            path = place / where
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text((path.read_text("utf-8") if how == "append" else "") + text, "utf-8")
        elif how == "run":
            (place / where).write_text(text, "utf-8")
            subprocess.run([sys.executable, where], cwd=place, env=environment, check=True, timeout=60)
        elif language == "sh":
            for line in text.splitlines():
                if line.startswith("cd "):
                    place /= line[3:]
                    continue
                ran = subprocess.run(line.split(), cwd=place, env=environment, capture_output=True, text=True, timeout=300)
                assert ran.returncode == 0, f"{line}\n{ran.stdout}\n{ran.stderr}"
                said[line] = ran.stdout
        else:
            assert language == "toml", "a block that nobody follows"
    return place, said


def test_the_template_keeps_every_rule_at_once(followed):
    """As written, and after the page's change, with the notebook run."""
    _, said = followed
    assert "1 exercise, 5 points: every rule holds" in said["directrix author check assignments/20-roofs"]
    changed = said["directrix author check assignments/20-roofs --run"]
    assert "every rule holds and the notebook runs" in changed
    assert all(name in changed for name in ("no_rise", "from_the_edge", "wide_and_low", "one_high"))


def test_the_finer_points_keep_every_rule_too(followed):
    """Weights, spans, an exercise built on another: the roofs twice over with their notebook, the gutter by itself."""
    _, said = followed
    roofs = said["directrix author check assignments/20-roofs --run"]
    assert "2 exercises, 7 points" in roofs
    assert all(name in roofs for name in ("steep", "some_ridge", "from_the_back"))
    gutters = said["directrix author check assignments/22-gutters"]
    assert "1 exercise, 3 points: every rule holds" in gutters


def test_release_says_what_learners_do_not_have_until_they_have_it(followed):
    """Only the exercises go along, not the notebook source with its solutions."""
    place, said = followed
    assert "does not know barrel_roof" in " ".join(said["directrix release A20"].split())
    assert "does not know" not in said["directrix release A20 --with-exercises"]
    beside = place / "release" / "A20" / "directrix-exercises"
    assert [path.name for path in beside.rglob("*") if path.is_file()] == ["exercises.py"]
    assert "(u - 0.5)" not in (place / "release" / "A20" / "roofs.ipynb").read_text()


def test_feedback_names_the_authors_mistake(followed):
    """Right is full marks; the mistake earns its credit, and its page has the author's words."""
    place, said = followed
    rows = {line.split()[1]: line for line in said["directrix grade A20"].splitlines() if re.search(r"\b(ada|bob)\b", line)}
    assert re.search(r"\b5\b", rows["ada"])
    assert re.search(r"\b2\.5\b", rows["bob"])
    page = (place / "feedback" / "bob" / "A20" / "roofs.html").read_text()
    assert "The right roof in the wrong place: yours begins at x = 0" in page
    assert "wrong place" not in (place / "feedback" / "ada" / "A20" / "roofs.html").read_text()


def test_learners_check_finds_what_lies_beside_the_notebook(followed, tmp_path):
    """A learner's folder, far from the course: the released files are all there is."""
    place, _ = followed
    code = (
        "import numpy as np\nfrom autograder import check\n"
        "def barrel_roof(u, w, width, length, rise):\n"
        "    u, w = np.broadcast_arrays(u, w)\n"
        "    return np.stack([width * u, length * w, 4 * rise * u * (1 - u)], axis=-1)\n"
        "print(check(barrel_roof))\n"
    )
    there = subprocess.run(
        [sys.executable, "-c", code], cwd=place / "release" / "A20", capture_output=True, text=True, timeout=120, check=True
    )
    assert "yours begins at x = 0" in there.stdout
    assert there.stdout.splitlines()[-1] == "2.5"
    elsewhere = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert elsewhere.returncode == 1
    assert "There is no exercise called barrel_roof" in elsewhere.stdout
    assert "ask whoever gave you the notebook" in elsewhere.stdout


def test_release_writes_the_public_word_and_not_the_secret(followed):
    """Each released notebook says of which course it is."""
    place, _ = followed
    released = (place / "release" / "A21" / "own-arch.ipynb").read_text()
    found = re.findall(r'personal\.course\(\\"(\w+)\\"\)', released)
    assert len(found) == 1
    assert re.fullmatch(r"[0-9a-f]{16}", found[0])
    assert (place / ".directrix" / "secret").read_text().strip() not in released
    source = json.loads((place / "source" / "A21" / "own-arch.ipynb").read_text())
    assert any('personal.course("workbook")' in "".join(cell["source"]) for cell in source["cells"])


def test_the_translation_fits_the_catalogue(followed, monkeypatch):
    """Every key and every name in braces that the page shows."""
    from autograder import messages, translation

    place, _ = followed
    monkeypatch.setattr(messages, "TEXT", dict(messages.ENGLISH))
    messages.use(translation.read(place / "german.json"))
    assert messages.say("right.sets", data=messages.say("data.one", names="steep")) == "Richtig auf dem Datensatz steep."
