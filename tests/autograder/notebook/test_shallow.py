"""HTML that costs its reader more than its length: nested ten thousand deep, or so that the parser makes elements again."""

import re

import pytest

from autograder.notebook.safe import clean_html, escape_markdown
from autograder.notebook.shallow import DEEPEST, shallow

KNOWN = {"a", "b", "br", "div", "img", "li", "p", "span", "table", "td", "tr", "ul"}


def deepest(html):
    """Elements in each other, in HTML that is well formed."""
    depth = most = 0
    for end, name in re.findall(r"<(/?)([a-z]+)", html):
        depth += 0 if name in ("br", "img") else -1 if end else 1
        most = max(most, depth)
    assert depth == 0
    return most


@pytest.mark.parametrize(
    "html",
    [
        "",
        "a &lt; b",
        '<p>a</p><ul><li>b</li></ul><img src="x"><br>',
        '<table border="1"><tr><td>1</td></tr></table>',
        '<a href="https://a.b?c=1&amp;d=2" title="a > b">c</a>',
    ],
)
def test_what_is_well_formed_stays_as_it_is(html):
    assert shallow(html, KNOWN) == html


@pytest.mark.parametrize(
    ("html", "made"),
    [
        ("<ul><li>a<li>b</ul>", "<ul><li>a</li><li>b</li></ul>"),
        ("<p>a<p>b<div>c", "<p>a</p><p>b</p><div>c</div>"),
        ("<table><tr><td>1<td>2<tr><td>3</table>", "<table><tr><td>1</td><td>2</td></tr><tr><td>3</td></tr></table>"),
        ("<b><p></b>x</p></span>", "<b><p></p></b>x"),
        ("a < b, <3 and <b", "a &lt; b, &lt;3 and &lt;b"),
        ("<B TITLE=x>y</B\n>", "<b TITLE=x>y</b>"),
        ("<font><b/>x</font>", "<b>x</b>"),
        ("<script>'<b>'</script>a<!-- <b> -->b<!c>d<script>", "abd"),
        ("<svg><p>a<textarea></svg><script>b<script>c", "bc"),
        ("<svg><p>a<svg></p>", "<p>a</p>"),
        ("a<!-- b", "a"),
        ('<div title="</div>"><div title=\'></div>', '<div title="</div>">&lt;div title=\'></div>'),
    ],
)
def test_everything_else_is_made_so(html, made):
    assert shallow(html, KNOWN) == made


@pytest.mark.parametrize("unit", ["<div>", "<ul><li>", "<div></p>", "<p><b id={}>", "<table><tr><td>", "<span><a href={}>"])
def test_nothing_nests_deeper_than_it_may(unit):
    html = "".join(unit.format(number) for number in range(3000))
    assert deepest(shallow(html, KNOWN)) <= DEEPEST


def test_what_is_shown_grows_with_what_was_written_and_not_with_its_square():
    """The parser mends each of these paragraphs by making all the bold elements before it again."""
    shown = [len(clean_html("".join(f"<p><b id={number}>" for number in range(count)))) for count in (1000, 2000)]
    assert shown[1] < 2.5 * shown[0]


def test_code_among_backticks_is_found_in_one_pass():
    runs = " ".join("`" * count for count in range(1, 1500))
    assert escape_markdown(f"{runs} <b>") == f"{runs} &lt;b>"
    assert escape_markdown("<a `<b` ``<c` ` `` <d `") == "&lt;a `<b` ``<c` ` `` &lt;d `"
