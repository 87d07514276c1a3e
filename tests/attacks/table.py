"""The table of attacks: every attack handed in to nbgrader, to otter and to Directrix, and what came of it.

    python tests/attacks/table.py [--graders nbgrader otter ours] [--attacks NAME ...] [--jobs 2] [--otter PYTHON]
                                   [--keep FILE] [--write]

One course is made by nbgrader itself; each attack is handed in to a copy of it. After the grading, marks, tests, files and
processes are compared with before, and it is looked whether a random word got out that the attacker should not know. Before
any attack, each grader must give an honest wrong answer nothing and a right one everything, or the table would mean nothing.

Ours grades all attackers as one class; if anything in that class was harmed, each is repeated alone, to see who did it. Run by
root, it does so twice: as root, and as an ordinary user. nbgrader and otter grade one attacker at a time, as whoever runs this:
they execute what they are handed in with that user's rights. The attacks are harmless by construction, and reach for decoys.

otter-grader is installed in a scratch environment (``--otter``: the Python of one that has otter-grader, geomdl and ipykernel);
where it cannot be had its column says so. Takes a quarter of an hour; with ``--keep`` each result goes into a file as it comes,
and a run that was stopped goes on from there. ``--write`` writes docs/attacks.md.
"""

from __future__ import annotations

import argparse
import importlib.util
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict
from importlib.metadata import version
from pathlib import Path
from typing import Any

from hostile_attacks import ATTACKS, RIGHT, TESTS, WRONG, Attack
from hostile_rooms import OtterRoom, Room, Seen, template

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "attacks.md"
HONEST = {"wrong": Attack("an honest wrong answer", WRONG), "right": Attack("a right answer", RIGHT)}
NAMES = {"nbgrader": "nbgrader", "otter": "otter run", "ours": "directrix", "ours as a user": "directrix, ordinary user"}
NOT_RUN = "not run"
INTRO = """# Attacks on a grader: what was tried, and what came of it

Written by `python tests/attacks/table.py --write` ({versions}). Each attack is a submission to the same small course: five
tests of one function, hidden tests among them, one point each. No attack computes the function: every point is one it took.
`no` means: no point, no secret seen, and the gradebook, the course's files and the processes of the machine as before. A dash:
the attack does not concern that grader (otter keeps no gradebook and grades one notebook). `directrix` was started by {who}.

A part of this runs with every test run: all attacks on Directrix, and some on nbgrader that have to succeed, so that it is
known that success would be seen. How isolation itself is attacked is another list: `directrix doctor`.

"""


def as_user(command: list[str], **options: Any) -> subprocess.CompletedProcess[str]:
    """Run a command as an ordinary user, who is given the folder that it works in."""
    place = Path(options["cwd"]).parent
    spec = importlib.util.spec_from_file_location("sandbox_users", ROOT / "tests/autograder/sandbox/conftest.py")
    assert spec is not None
    assert spec.loader is not None
    users = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(users)
    for path in [place, *place.rglob("*")]:
        os.chown(path, users.ORDINARY_UID, users.ORDINARY_UID, follow_symlinks=False)
    for parent in (place.parent, *place.parent.parents):
        if not parent.stat().st_mode & 1 and Path(tempfile.gettempdir()) in parent.parents:
            parent.chmod(0o755)
    trees = [sys.base_prefix, str(ROOT), *([] if ROOT in Path(sys.prefix).parents else [sys.prefix])]
    become = [
        sys.executable,
        "-I",
        "-S",
        "-c",
        users.BECOME,
        str(ROOT),
        str(users.ORDINARY_UID),
        ":".join(dict.fromkeys(trees)),
    ]
    paths = {"HOME": str(place), "TMPDIR": str(place), "PYTHONPATH": f"{ROOT / 'lib'}:{ROOT}"}
    return subprocess.run([*become, *command], **{**options, "env": {**options["env"], **paths}})


class Table:
    """Runs attacks against graders, in rooms below one folder."""

    def __init__(self, folder: Path, otter: Path | None = None, keep: Path | None = None) -> None:
        self.folder, self.otter, self.keep = folder, otter, keep
        lines = keep.read_text("utf-8").splitlines() if keep is not None and keep.exists() else []
        self.known = {
            (one["grader"], one["attack"]): Seen(one["points"], one["told"], one["harm"]) for one in map(json.loads, lines)
        }
        self.made = template(folder / "template")
        self.rooms = 0

    def room(
        self, grader: str, attacks: Mapping[str, Attack], zoe: Mapping[str, float] | None = None
    ) -> tuple[list[Seen], Room]:
        """Grade these attacks in a room of their own."""
        self.rooms += 1
        place = self.folder / f"room{self.rooms}"
        place.mkdir()
        room = (OtterRoom if grader == "otter" else Room)(self.made, place, attacks)
        if isinstance(room, OtterRoom):
            assert self.otter is not None
            room.python = self.otter
        around = as_user if grader == "ours as a user" else subprocess.run
        return list(room.grade(grader.removesuffix(" as a user"), around, zoe).values()), room

    def honest(self, grader: str) -> dict[str, float] | None:
        """The marks that zoe should get.

        Raises
        ------
        RuntimeError
            If the grader does not tell a right answer from a wrong one.
        """
        (wrong, right), room = self.room(grader, HONEST)
        if wrong.won or right.points != len(TESTS) or right.told or right.harm:
            raise RuntimeError(
                f"{grader}: a wrong answer gets {wrong}, a right one {right}; attacks would show nothing\n{room.said}"
            )
        return room.marks("zoe")

    def column(self, grader: str, attacks: Mapping[str, Attack], jobs: int = 1) -> dict[str, Seen]:
        """What came of each attack against one grader that it concerns."""
        chosen = {name: attack for name, attack in attacks.items() if grader.split()[0] in attack.only}
        found = {name: self.known[grader, name] for name in chosen if (grader, name) in self.known}
        if len(found) == len(chosen):
            return found
        zoe = self.honest(grader)
        if grader.startswith("ours"):
            together = {name: attack for name, attack in chosen.items() if not attack.options and name not in found}
            if together:
                seen = dict(zip(together, self.room(grader, together, zoe)[0], strict=True))
                if not any(one.harm for one in seen.values()):
                    found |= {name: self.kept(grader, name, one) for name, one in seen.items()}
        alone = [name for name in chosen if name not in found]

        def one(name: str) -> Seen:
            (seen,), _ = self.room(grader, {name: chosen[name]}, zoe)
            print(f"  {grader}: {name}: {seen}", file=sys.stderr)
            return self.kept(grader, name, seen)

        with ThreadPoolExecutor(jobs) as pool:
            found |= dict(zip(alone, pool.map(one, alone), strict=True))
        return {name: found[name] for name in chosen}

    def kept(self, grader: str, name: str, seen: Seen) -> Seen:
        """Write a result down, if that was asked for."""
        if self.keep is not None:
            with self.keep.open("a", encoding="utf-8") as file:
                file.write(json.dumps({"grader": grader, "attack": name, **asdict(seen)}) + "\n")
        return seen


def scratch_otter(folder: Path) -> Path | None:
    """An environment with otter-grader, made for this run; None where it cannot be had."""
    python = folder / "otter" / "bin" / "python"
    wanted = ["otter-grader", "numpy", "ipykernel", "geomdl"]
    commands = [["uv", "venv", "-q", str(folder / "otter")], ["uv", "pip", "install", "-q", "--python", str(python), *wanted]]
    try:
        for command in commands:
            subprocess.run(command, check=True, capture_output=True, timeout=900)
    except (OSError, subprocess.SubprocessError) as error:
        print(f"otter-grader cannot be installed here, so it is not run ({type(error).__name__})", file=sys.stderr)
        return None
    return python


def markdown(columns: Mapping[str, Mapping[str, Seen] | None], attacks: Mapping[str, Attack]) -> str:
    """The table, and the totals below it."""
    heads = ["attack", *(NAMES[grader] for grader in columns)]
    lines = ["| " + " | ".join(heads) + " |", "|---" * len(heads) + "|"]
    for name, attack in attacks.items():
        lines.append("| " + " | ".join([attack.tries, *(_said(found, name) for found in columns.values())]) + " |")
    totals = []
    for grader, found in columns.items():
        if found is None:
            totals.append(f"{NAMES[grader]}: {NOT_RUN}")
        else:
            totals.append(f"{NAMES[grader]}: {sum(seen.won for seen in found.values())} of {len(found)} attacks won something")
    return "\n".join([*lines, "", *(f"- {total}" for total in totals), ""])


def _said(found: Mapping[str, Seen] | None, name: str) -> str:
    if found is None:
        return NOT_RUN
    if name not in found:
        return "–"
    return f"**{found[name]}**" if found[name].won else "no"


def versions(graders: Iterable[str], otter: Path | None) -> str:
    """What was attacked."""
    said = [f"nbgrader {version('nbgrader')}", f"directrix {version('directrix')}"]
    if otter is not None and "otter" in graders:
        asked = [str(otter), "-c", "from importlib.metadata import version; print(version('otter-grader'))"]
        said.insert(1, f"otter-grader {subprocess.run(asked, capture_output=True, text=True, check=True).stdout.strip()}")
    return ", ".join(said)


def main() -> int:
    """The command; exit code 1 if any attack on ours won something."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--graders", nargs="+", choices=["nbgrader", "otter", "ours"], default=["nbgrader", "otter", "ours"])
    parser.add_argument("--attacks", nargs="+", choices=ATTACKS, default=list(ATTACKS), metavar="NAME")
    parser.add_argument("--jobs", type=int, default=2, help="rooms at a time")
    parser.add_argument("--otter", type=Path, help="Python of an environment with otter-grader; default: make one")
    parser.add_argument("--keep", type=Path, help="file of results; those in it are not asked for again")
    parser.add_argument("--write", action="store_true", help="write docs/attacks.md")
    options = parser.parse_args()
    attacks = {name: ATTACKS[name] for name in options.attacks}
    with tempfile.TemporaryDirectory(prefix="attacks-") as scratch:
        otter = (options.otter or scratch_otter(Path(scratch))) if "otter" in options.graders else None
        table = Table(Path(scratch), otter, options.keep)
        columns: dict[str, dict[str, Seen] | None] = {}
        for grader in options.graders:
            columns[grader] = None if grader == "otter" and otter is None else table.column(grader, attacks, options.jobs)
            if grader == "ours" and os.geteuid() == 0:
                columns["ours as a user"] = table.column("ours as a user", attacks, options.jobs)
        said = versions(columns, otter)
    shown = markdown(columns, attacks)
    print(shown)
    if options.write:
        who = "root in one column, by an ordinary user in the other" if "ours as a user" in columns else "an ordinary user"
        PAGE.write_text(INTRO.format(versions=said, who=who) + shown, "utf-8")
    ours = [seen for grader, found in columns.items() if grader.startswith("ours") for seen in (found or {}).values()]
    return int(any(seen.won for seen in ours))


if __name__ == "__main__":
    sys.exit(main())
