"""Files that nbformat refuses and we can read, and the reverse: the same marks by either command."""

import importlib.util
import json
from pathlib import Path

from autograder import fleet

spec = importlib.util.spec_from_file_location("stock_commands", Path(__file__).parent / "test_nbgrader.py")
stock = importlib.util.module_from_spec(spec)
spec.loader.exec_module(stock)


def test_odd_notebooks_get_the_same_marks_by_both_commands(ordinary, tmp_path, bridge_line):
    right = ordinary.released("two")
    for cell in right["cells"]:
        cell["source"] = stock.ADD.get(cell["metadata"].get("nbgrader", {}).get("grade_id"), cell["source"])
    text = json.dumps(right)
    written = {
        "bom": text.encode("utf-8-sig"),
        "utf16": text.encode("utf-16"),
        "minor": text.replace('"nbformat_minor": 5', '"nbformat_minor": 99').encode(),
        "words": text.replace('"nbformat_minor": 5', '"nbformat_minor": "five"').encode(),
        "none": text.replace('"nbformat_minor": 5, ', "").encode(),
        "true": text.replace('"nbformat": 4', '"nbformat": true').encode(),
        "latin": text.replace("return a + b", "return a + b  # ü").encode("latin-1").replace(b"\\u00fc", b"\xfc"),
    }
    for student, data in written.items():
        (ordinary.hand_in(student, {"one": stock.RIGHT}) / "two.ipynb").write_bytes(data)
    (ordinary.hand_in("folder", {"one": stock.RIGHT}) / "two.ipynb").mkdir()
    ordinary.configure(bridge_line)
    theirs = ordinary.copy(tmp_path / "theirs")
    done = stock.nbgrader(theirs.folder, "autograde", "ps1")
    graded = fleet.grade(ordinary.course(), "ps1")
    points = {
        who: {cell.points for cell in graded.student(who).cells if cell.name == "test_add"} for who in (*written, "folder")
    }
    read = {"bom", "utf16", "minor", "words", "none"}
    assert {who for who, given in points.items() if given == {1.0}} == read
    assert {who for who, given in points.items() if given == {None}} == {"true", "latin", "folder"}

    def marked(room):
        return [row for row in room.tables()["grades"] if row[0] in read]

    assert marked(ordinary) == marked(theirs), done.stderr[-3000:]
    graded_there = {name.split("/")[0] for name in theirs.autograded()}
    assert graded_there == read
