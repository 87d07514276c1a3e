"""The page docs/evidence.md: made from ``results.json`` beside this file, never by hand."""

from __future__ import annotations

import json
import subprocess
from collections import Counter
from collections.abc import Mapping, Sequence
from datetime import date
from importlib.metadata import PackageNotFoundError
from importlib.metadata import version as installed
from pathlib import Path
from typing import Any

from evidence_mutants import TELLS, Outcome

HERE = Path(__file__).parent
RESULTS = HERE / "results.json"
PAGE = HERE.parents[1] / "docs" / "evidence.md"
TOLD = ("named", *TELLS, "neither")

INTRODUCTION = """\
# Evidence

What was done to find out whether the judge is right: whether it names what it claims to name, refuses no right answer, and
passes no wrong one. This page is written by the script that did it (`python tests/evidence/campaign.py ... --write`), and a
test compares it with the kept numbers; the tables behind the totals are printed by the same commands. Small versions of all
three run with the other tests, under `tests/evidence`.
"""

SECTIONS = {
    "mistakes": """\
## Every exercise, every listed mistake

For each exercise the reference must get full marks and the untouched stub none, and each known wrong formula must be named as
itself: on the data that learners see, and on data drawn from random seeds, as hidden data are. The mistakes that the syllabus
lists are kept in `tests/evidence/syllabus_mistakes.json`; the exercises hold all of them, and more.
""",
    "styles": """\
## No right answer is refused

Right answers as learners write them: loops over single points, whole arrays, recursion, matrices, complex numbers, another
formula for the same thing. Two count as different only if their syntax trees differ after all names, imports and error
messages are taken out. Each was judged under every seed, every fifth time as in grading: on hidden data with samples of their
own, and on the released data beside them.
""",
    "mutants": """\
## No wrong answer is passed

Small random changes to those right answers, one at a time: a sign, an operator, an index, a constant, exchanged arguments,
cos for sin, a term left out, u for w, another axis, < for <=, a range off by one, a length not divided by, degrees. Whether a
changed function is still right was decided without the judge, by a dense comparison with the reference under fresh seeds, at
scattered places, on edges and corners, at simple fractions, as vectors, as a mesh and as single numbers
(`evidence_oracle.py`). Each mutant ran in a process of its own with a limit of time and memory.

What a message tells is sorted by the sentences in it: *named*, a listed mistake, alone or with a second one; *gate*, why the
answer could not be compared (an error and its line, a shape, a place without a number, a case that must be refused);
*geometry*, relabelled, begun elsewhere, close, a part, more, moved; *rule*, one rule that explains all of it (a factor, a
sign, exchanged coordinates, rows in another order); *place*, which corners, edges, coordinates or data sets are right.
*Neither* says no more than how far off the answer is and where most.
""",
}

CLOSING = """\
## Notebooks

Not part of the campaign, but of every run of the tests: each notebook, solved, gets full points with every claim of its
self-checks true, and as released runs with no error but those of its stubs and checks, both in a kernel and in the sandbox of
grading (`tests/course/test_notebooks.py`). The sample class of `directrix demo`, right, mistaken, half-finished, broken and
cheating, earns what its honest content is worth (`tests/autograder/demo`).

## What was not shown

- Nothing here was tried on students. The styles and the changes are ours; learners make others.
- A wrong answer that differs at single places only (one value of u in a thousand) can pass: the judge samples, as the oracle
  does.
- The changes are single ones. Two slips at once are recognised where both are listed, and that was tried on listed pairs
  only.
- That a message *localises* says that it names a place, a rule or a reason, not that a learner finds the slip sooner by it.
- The campaign runs answers in this process, not in the sandbox; that both give the same marks is tested elsewhere, on the
  sample class.
"""


def table(command: str, rows: Sequence[Mapping[str, Any]]) -> str:
    """The table of a campaign, all its rows."""
    return TABLES[command](rows)


def _mistakes_table(rows: Sequence[Mapping[str, Any]]) -> str:
    lines = [_row("", "exercise", "reference", "stub 0", "in syllabus", "named, public", "named, every random seed")]
    lines.append(_rule(7))
    for r in rows:
        n = r["seeds"] + 1
        counts = f"{r['public']}/{r['mistakes']}", f"{r['random']}/{r['mistakes']}"
        lines.append(_row(r["assignment"], r["exercise"], f"{r['reference']}/{n}", f"{r['stub']}/{n}", r["listed"], *counts))
    return "\n".join(lines)


def _styles_table(rows: Sequence[Mapping[str, Any]]) -> str:
    lines = [_row("", "exercise", "styles", "different", "tools", "judged", "refused"), _rule(7)]
    lines += [
        _row(r["assignment"], r["exercise"], r["styles"], r["distinct"], ", ".join(r["traits"]), r["judged"], r["refused"])
        for r in rows
    ]
    return "\n".join(lines)


def _mutants_table(rows: Sequence[Mapping[str, Any]]) -> str:
    heads = "exercise", "mutants", "equivalent", "not decided", "wrong", "passed wrongly", "refused wrongly", *TOLD
    lines = [_row("", *heads), _rule(len(heads) + 1)]
    lines += [
        _row(r["assignment"], r["exercise"], *(r[head] for head in heads[1:7]), *(r["told"].get(told, 0) for told in TOLD))
        for r in rows
    ]
    return "\n".join(lines)


TABLES = {"mistakes": _mistakes_table, "styles": _styles_table, "mutants": _mutants_table}


def _row(*cells: object) -> str:
    return "| " + " | ".join(map(str, cells)) + " |"


def _rule(columns: int) -> str:
    return "|" + "---|" * columns


def counted(found: Sequence[Outcome]) -> list[dict[str, Any]]:
    """The outcomes of mutants, counted by exercise."""
    from evidence_tables import _assignment

    rows = []
    for id in sorted({outcome.exercise for outcome in found}, key=lambda id: (_assignment(id), id)):
        mine = [outcome for outcome in found if outcome.exercise == id]
        wrong = [outcome for outcome in mine if outcome.opinion in ("differs", "endless")]
        rows.append({
            "assignment": _assignment(id), "exercise": id, "mutants": len(mine),
            "equivalent": sum(outcome.opinion == "equal" for outcome in mine),
            "not decided": sum(outcome.opinion == "borderline" for outcome in mine),
            "wrong": len(wrong),
            "passed wrongly": sum(outcome.passed_wrongly for outcome in mine),
            "refused wrongly": sum(outcome.refused_wrongly for outcome in mine),
            "told": dict(Counter(outcome.told for outcome in wrong if not outcome.passed)),
        })  # fmt: skip
    return rows


def groups(neither: Sequence[Outcome]) -> str:
    """Mutants whose message neither names nor localises, by exercise and by kind of change, the largest groups first."""
    by_group: dict[tuple[str, str], list[Outcome]] = {}
    for outcome in neither:
        by_group.setdefault((outcome.exercise, outcome.kind), []).append(outcome)
    lines = []
    for (exercise, kind), mine in sorted(by_group.items(), key=lambda item: -len(item[1])):
        lines.append(f"{len(mine):4d}  {exercise}, {kind}")
        lines += [f"        {o.style}, line {o.line}: {o.was[:70]} -> {o.now[:70]}" for o in mine]
    return "\n".join(lines)


def write(command: str, rows: Sequence[Mapping[str, Any]], said: str, version: str) -> None:
    """Keep the totals of a campaign and make the page anew. ``version``: of what was tried, taken when it began."""
    kept = json.loads(RESULTS.read_text("utf-8")) if RESULTS.exists() else {}
    kept[command] = {"command": said, "date": date.today().isoformat(), "version": version, "totals": totals(command, rows)}
    kept = {name: kept[name] for name in SECTIONS if name in kept}
    RESULTS.write_text(json.dumps(kept, indent=2) + "\n", "utf-8")
    PAGE.write_text(rendered(kept), "utf-8")


def rewrite() -> None:
    """Make the page anew from the kept totals."""
    PAGE.write_text(rendered(json.loads(RESULTS.read_text("utf-8"))), "utf-8")


def totals(command: str, rows: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """The sums of a table's columns."""

    def total(column: str) -> int:
        return sum(row[column] for row in rows)

    if command == "mistakes":
        full = total("reference"), total("stub")
        tried = sum(row["seeds"] + 1 for row in rows)
        return {
            "exercises": len(rows), "random seeds": max(row["seeds"] for row in rows),
            "reference: full marks": f"{full[0]} of {tried}", "stub: no marks": f"{full[1]} of {tried}",
            "mistakes of the syllabus": total("listed"), "mistakes in all": total("mistakes"),
            "named on the released data": total("public"), "named under every random seed": total("random"),
        }  # fmt: skip
    if command == "styles":
        return {
            "exercises": len(rows), "right answers": total("styles"), "of different form": total("distinct"),
            "fewest for one exercise": min(row["distinct"] for row in rows), "seeds": max(row["seeds"] for row in rows),
            "judgements": total("judged"), "refused": total("refused"),
        }  # fmt: skip
    told = sum((Counter(row["told"]) for row in rows), Counter())
    wrong = total("wrong")
    shares = {word: f"{told[word]} ({told[word] / max(wrong, 1):.1%})" for word in TOLD}
    return {
        "mutants": total("mutants"), "still right (equivalent)": total("equivalent"),
        "refused all the same": total("refused wrongly"),
        "within ten times of the tolerance (not decided)": total("not decided"), "wrong": wrong,
        "passed all the same": total("passed wrongly"), **shares,
    }  # fmt: skip


def rendered(kept: Mapping[str, Any]) -> str:
    """The whole page."""
    parts = [INTRODUCTION]
    for command, words in SECTIONS.items():
        if command in kept:
            one = kept[command]
            lines = [_row("", "count"), _rule(2), *(_row(name, value) for name, value in one["totals"].items())]
            said = f"`{one['command']}`, {one['date']}, {one['version']}:"
            parts.append("\n".join([words, said, "", *lines, ""]))
    return "\n".join([*parts, CLOSING])


def tried() -> str:
    """The version of the package and the commit of the checkout."""
    try:
        number = installed("directrix")
    except PackageNotFoundError:
        number = "not installed"
    run = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=HERE, capture_output=True, text=True, check=False)
    return f"version {number}" + (f" at {run.stdout.strip()}" if run.returncode == 0 else "")
