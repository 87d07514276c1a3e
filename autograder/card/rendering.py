"""A card as HTML, which escapes all that came from outside, and as plain text, which says all that the HTML says."""

from __future__ import annotations

import html as _html
import re
from collections.abc import Iterable, Sequence
from typing import Any

from autograder.card.content import (
    COLUMNS,
    LONGEST,
    LONGEST_NOTE,
    OUTCOMES,
    Card,
    all_alike,
    by_name,
    clean,
    columns_of,
    of,
    printable,
    result_of,
    word_of,
    worst_of,
)
from autograder.messages import say
from autograder.result import Case, Verdict

STYLE_PROPERTIES = frozenset(
    {
        "background-color", "border-bottom", "border-collapse", "border-left", "border-radius", "color", "font-size",
        "font-weight", "line-height", "margin", "max-width", "overflow-x", "padding", "text-align", "vertical-align",
        "white-space",
    }
)  # fmt: skip
SHORT = 22  # characters of a cell of the table that stay on one line


def html(verdict: Verdict | Card) -> str:
    """The card as an HTML fragment. Everything that came from outside is escaped."""
    card = verdict if isinstance(verdict, Card) else of(verdict)
    sign, ground = OUTCOMES[card.outcome]
    badge = (
        f'<span style="background-color: {ground}; color: #ffffff; font-weight: bold; padding: 2px 9px; border-radius: 9px; '
        f'white-space: nowrap">{sign}&nbsp;{_escape(word_of(card.outcome))}</span>'
    )
    body = [
        f'<div style="margin: 0 0 6px 0">{badge}&nbsp; <b>{_escape(card.title)}</b></div>',
        *(_part(heading, text) for heading, text in card.parts),
        _table(card.cases),
        *(_note(heading, text) for heading, text in card.notes),
    ]
    return (
        f'<div style="border-left: 5px solid {ground}; background-color: rgba(128, 128, 128, 0.09); border-radius: 3px; '
        f'padding: 10px 14px; margin: 4px 0; max-width: 860px; line-height: 1.5; font-size: 14px">{"".join(body)}</div>'
    )


def text(verdict: Verdict | Card) -> str:
    """The card as plain text: all that the HTML says."""
    card = verdict if isinstance(verdict, Card) else of(verdict)
    sign, _ = OUTCOMES[card.outcome]
    lines = [f"[{sign} {word_of(card.outcome)}] {clean(card.title)}"]
    for heading, said in card.parts:
        shown = clean(said, LONGEST).replace("`", "")
        lines.append(f"{clean(heading)}: {shown}" if heading else shown)
    if alike := all_alike(card.cases):
        lines.append(f"{say('table.sets')}: {clean(alike, LONGEST)}")
    elif card.cases:
        lines.append(f"{say('table.sets')}:")
        lines += [
            f"  {sign} {': '.join(part for part in (name, said) if part)}" for sign, name, said in _rows_as_text(card.cases)
        ]
    for heading, said in card.notes:
        lines.append(f"{clean(heading)}:")
        lines += [f"    {line}" for line in clean(said, LONGEST_NOTE, lines=True).splitlines()]
    return "\n".join(lines)


def bundle(verdict: Verdict | Card) -> dict[str, Any]:
    """The card as a mime bundle."""
    return {"text/plain": text(verdict), "text/html": html(verdict)}


def _part(heading: str, text: str) -> str:
    label = f"<b>{_escape(heading)}:</b> " if heading else ""
    return f'<div style="margin: 3px 0">{label}{_marked_up(text)}</div>'


def _note(heading: str, text: str) -> str:
    ground = "background-color: rgba(128, 128, 128, 0.10); color: inherit"
    return (
        f'<div style="margin: 8px 0 0 0; font-size: 13px"><b>{_escape(heading)}:</b>'
        f'<pre style="margin: 2px 0 0 0; padding: 4px 8px; white-space: pre-wrap; font-size: 12px; {ground}">'
        f"{_escape(clean(text, LONGEST_NOTE, lines=True))}</pre></div>"
    )


def _table(cases: Sequence[Case]) -> str:
    if not cases:
        return ""
    if said := all_alike(cases):
        return f'<div style="margin: 3px 0"><b>{_escape(say("table.sets"))}:</b> {_escape(said)}</div>'
    columns = columns_of(cases)
    letters = {told["at"].rsplit(" = ", 1)[0] for case in cases if "at" in (told := worst_of(case))}
    at = letters.pop() if len(letters) == 1 else ""  # said once, in the head
    heads = [f"{say(f'table.{name}')}{f' {at}' if name == 'at' and at else ''}" for name in columns]
    head = "".join(_cell(text, "th") for text in heads)
    plain = '<tr style="background-color: transparent">'  # JupyterLab would stripe the rows
    rows = [f"{plain}{head}</tr>"]
    for name, case in by_name(cases):
        cells = {"data": name, "result": result_of(case), **worst_of(case)}
        cells["at"] = cells.get("at", "").removeprefix(f"{at} = ")
        rows.append(plain + "".join(_cell(cells.get(name, "")) for name in columns) + "</tr>")
    return (
        '<div style="overflow-x: auto; margin: 8px 0 0 0"><table style="border-collapse: collapse; font-size: 13px; '
        f'margin: 0">{"".join(rows)}</table></div>'
    )


def _cell(text: str, tag: str = "td") -> str:
    line = "border-bottom: 1px solid rgba(128, 128, 128, 0.35)"
    weight = "bold" if tag == "th" else "normal"
    wrap = "nowrap" if len(text) <= SHORT else "normal"
    style = (
        f"font-weight: {weight}; white-space: {wrap}; text-align: left; vertical-align: top; padding: 2px 10px 2px 0; {line}"
    )
    return f'<{tag} style="{style}">{_escape(text)}</{tag}>'


def _rows_as_text(cases: Sequence[Case]) -> Iterable[tuple[str, str, str]]:
    for name, case in by_name(cases):
        sign, said = result_of(case).split(" ", 1)
        told = worst_of(case)
        more = [f"{say(f'table.{column}')} {told[column]}" for column in COLUMNS if column in told]
        yield sign, clean(name), clean("; ".join([said, *more]))


def _escape(text: str) -> str:
    """Text as HTML. $ and \\ stand in elements of their own, so that no MathJax reads a formula into a learner's words."""
    return re.sub(r"([$\\])", r"<span>\1</span>", _html.escape(printable(text), quote=True))


def _marked_up(text: str) -> str:
    """Escaped text in which `code` is set as code, and a *word* with stress."""
    pieces = clean(text, LONGEST).split("`")
    if len(pieces) % 2 == 0:  # a backtick without its partner is only a backtick
        return _stressed("`".join(pieces))
    return "".join(f"<code>{_escape(piece)}</code>" if i % 2 else _stressed(piece) for i, piece in enumerate(pieces))


def _stressed(text: str) -> str:
    """Escaped text with *words* between asterisks in italics; a product such as 2*x*y stays what it is."""
    return re.sub(r"(?<![\w*)\]])\*(\w(?:[\w -]*\w)?)\*(?![\w*(\[])", r"<em>\1</em>", _escape(text))
