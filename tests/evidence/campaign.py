"""The evidence that the judge is right, at full length: prints the tables, and writes them into docs/evidence.md.

    python tests/evidence/campaign.py mistakes --seeds 50        every reference, stub and listed mistake
    python tests/evidence/campaign.py styles --seeds 200         right answers in many styles are never refused
    python tests/evidence/campaign.py mutants --count 3000       small changes of right answers are never passed
    python tests/evidence/campaign.py page                       only makes docs/evidence.md anew from the kept totals
    ... --write          puts the totals into docs/evidence.md
    ... --only cylinder  one exercise (also several)
    ... --jobs 2         processes
    ... --keep FILE      all outcomes of the mutants, one JSON a line

Exit status 1 where anything was not as it must be. The same with small numbers runs under pytest (test_*.py beside this file).
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import os
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict
from pathlib import Path
from typing import Any

os.environ["OPENBLAS_NUM_THREADS"] = "1"  # children are forks: no threads, and no more processors than --jobs says
sys.path.insert(0, str(Path(__file__).parent))

import evidence_page as page
from evidence_mutants import Outcome, drawn, outcomes
from evidence_tables import Mistakes, Styles, mistakes_of, styles_of

from autograder.catalogue import shipped


def main(arguments: Sequence[str] | None = None) -> int:
    options = _options(arguments)
    if options.command == "page":
        page.rewrite()
        return 0
    ids = options.only or [exercise.id for exercise in shipped()]
    for id in ids:
        shipped().find(id)
    started, version = time.monotonic(), page.tried()
    rows, failures = COMMANDS[options.command](options, ids)
    print(page.table(options.command, rows))
    for failure in failures:
        print(failure)
    print(f"{time.monotonic() - started:.0f} s")
    if options.write:
        page.write(options.command, rows, _said(options), version)
    return 1 if failures else 0


def _mistakes(options: argparse.Namespace, ids: Sequence[str]) -> tuple[list[dict[str, Any]], list[str]]:
    rows: list[Mistakes] = list(_each(mistakes_of, [(id, options.seeds) for id in ids], options.jobs))
    return [asdict(row) for row in rows], [f"{row.exercise}: {text}" for row in rows for text in row.failures]


def _styles(options: argparse.Namespace, ids: Sequence[str]) -> tuple[list[dict[str, Any]], list[str]]:
    rows: list[Styles] = list(_each(styles_of, [(id, options.seeds) for id in ids], options.jobs))
    return [asdict(row) for row in rows], [f"{row.exercise}: {text}" for row in rows for text in row.failures]


def _mutants(options: argparse.Namespace, ids: Sequence[str]) -> tuple[list[dict[str, Any]], list[str]]:
    work = drawn(options.count, options.seed, ids if options.only else ())
    by_exercise: dict[str, list[Any]] = {}
    for pair in work:
        by_exercise.setdefault(pair[0].exercise, []).append(pair)
    # The longest first, so that no process waits at the end for another.
    piles = sorted(by_exercise.values(), key=len, reverse=True)
    found: list[Outcome] = [
        outcome for pile in _each(_mutants_of, [(pile,) for pile in piles], options.jobs) for outcome in pile
    ]
    if options.keep:
        Path(options.keep).write_text("".join(json.dumps(asdict(outcome)) + "\n" for outcome in found), "utf-8")
    wrong = [outcome for outcome in found if outcome.passed_wrongly or outcome.refused_wrongly]
    if options.list:
        print(page.groups([outcome for outcome in found if outcome.told == "neither"]))
    return page.counted(found), [_told(outcome) for outcome in wrong]


def _mutants_of(pile: Sequence[Any]) -> list[Outcome]:
    return list(outcomes(pile))


def _told(outcome: Outcome) -> str:
    what = "passed, though it is not right" if outcome.passed else f"refused ({outcome.tier}), though it is right"
    return (
        f"{outcome.exercise}-{outcome.style}, line {outcome.line}: {outcome.was} -> {outcome.now}: {what}; "
        f"{outcome.deviation:.3g} tolerances at {outcome.place or 'most'}. {outcome.message}"
    )


COMMANDS: dict[str, Callable[..., tuple[list[dict[str, Any]], list[str]]]] = {
    "mistakes": _mistakes,
    "styles": _styles,
    "mutants": _mutants,
}


def _each(work: Callable[..., Any], items: Sequence[tuple[Any, ...]], jobs: int) -> Iterator[Any]:
    """``work(*item)`` for each item, in order, in so many processes."""
    if jobs <= 1:
        yield from (work(*item) for item in items)
        return
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(jobs, mp_context=context) as pool:
        for number, future in enumerate([pool.submit(work, *item) for item in items], 1):
            yield future.result()
            print(f"{number} of {len(items)}", end="\r", file=sys.stderr, flush=True)


def _said(options: argparse.Namespace) -> str:
    size = f"--count {options.count} --seed {options.seed}" if options.command == "mutants" else f"--seeds {options.seeds}"
    return f"python tests/evidence/campaign.py {options.command} {size}" + "".join(f" --only {id}" for id in options.only)


def _options(arguments: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command", choices=[*COMMANDS, "page"])
    parser.add_argument("--seeds", type=int, default=None, help="random seeds (50 for mistakes, 200 for styles)")
    parser.add_argument("--count", type=int, default=3000, help="mutants")
    parser.add_argument("--seed", type=int, default=1, help="of the choice of mutants")
    parser.add_argument("--only", action="append", default=[], metavar="EXERCISE")
    parser.add_argument("--jobs", "-j", type=int, default=2)
    parser.add_argument("--write", action="store_true", help="put the totals into docs/evidence.md")
    parser.add_argument("--list", action="store_true", help="of the mutants: those whose message neither names nor localises")
    parser.add_argument("--keep", metavar="FILE", help="of the mutants: write every outcome, one JSON a line")
    options = parser.parse_args(arguments)
    if options.seeds is None:
        options.seeds = 200 if options.command == "styles" else 50
    return options


if __name__ == "__main__":
    sys.exit(main())
