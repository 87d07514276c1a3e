"""What a child says a cell shows: taken only in the forms, types and bounds that a true child keeps to."""

import contextlib
import json
import time

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from autograder.sandbox import outputs
from autograder.sandbox.wire import WireError


def shown(*items):
    return [output for output, _ in outputs.outputs(items, 10_000, 10)]


def display(data, metadata=()):
    return shown(("display_data", tuple(data.items()), metadata, ""))[0]


def test_the_four_kinds_become_nbformat_outputs():
    items = (
        ("stream", "stdout", "hello"),
        ("error", "ValueError", "no", ("line 1", "line 2")),
        ("display_data", (("text/plain", "x"),), (), "id"),
        ("execute_result", (("text/plain", "6"),), (), ""),
    )
    assert outputs.outputs(items, 1000, 10) == [
        ({"output_type": "stream", "name": "stdout", "text": "hello"}, ""),
        ({"output_type": "error", "ename": "ValueError", "evalue": "no", "traceback": ["line 1", "line 2"]}, ""),
        ({"output_type": "display_data", "data": {"text/plain": "x"}, "metadata": {}}, "id"),
        ({"output_type": "execute_result", "data": {"text/plain": "6"}, "metadata": {}, "execution_count": None}, ""),
    ]


@pytest.mark.parametrize(
    "value",
    [
        None,
        "text",
        7,
        (7,),
        ((),),
        (("stream", "stdin", "x"),),
        (("stream", "stdout", 5),),
        (("update", (), (), ""),),
        (("error", "a", "b", "c"),),
        (("error", "a", "b", (5,)),),
        (("display_data", "x", (), ""),),
        (("display_data", (("text/plain",),), (), ""),),
        (("display_data", (("text/plain", 5),), (), ""),),
        (("display_data", (), (), None),),
        (("stream", "stdout", "x", "y"),),
    ],
)
def test_other_forms_are_a_breach_of_the_protocol(value):
    with pytest.raises(WireError):
        outputs.outputs(value, 1000, 10)


def test_more_than_a_cell_may_show_is_a_breach():
    with pytest.raises(WireError, match="more outputs"):
        outputs.outputs((("stream", "stdout", "x"),) * 1000, 10, 10)
    with pytest.raises(WireError, match="longer outputs"):
        outputs.outputs((("stream", "stdout", "x" * 2_000_000),), 10, 10)


@pytest.mark.parametrize(
    "mime", ["application/javascript", "image/svg+xml", "application/vnd.jupyter.widget-view+json", "text/x-unknown", "../x"]
)
def test_types_that_are_not_on_the_list_are_dropped(mime):
    assert display({mime: "alert(1)", "text/plain": "x"})["data"] == {"text/plain": "x"}
    assert "cannot be shown" in display({mime: "alert(1)"})["data"]["text/plain"]


def test_html_passes_as_data_for_the_writer_to_sanitise():
    assert display({"text/html": "<script>"})["data"] == {"text/html": "<script>"}
    assert "text/html" in outputs.ACTIVE


@pytest.mark.parametrize("content", ['x" onerror="alert(1)', "<svg>", "data:", "AAAA=A", "é"])
def test_images_are_base64_and_nothing_else(content):
    """A page writes them into an attribute."""
    assert "image/png" not in display({"image/png": content})["data"]


def test_true_images_pass():
    assert display({"image/png": "iVBORw0K\nGgo=\n"})["data"] == {"image/png": "iVBORw0K\nGgo=\n"}


def test_a_long_false_image_is_refused_in_linear_time():
    began = time.perf_counter()
    assert "image/png" not in display({"image/png": " " * 900_000 + "<"})["data"]
    assert time.perf_counter() - began < 20  # quadratic: minutes


@pytest.mark.parametrize(
    "text",
    [
        "NaN",
        "[NaN]",
        '{"a": Infinity}',
        "[1e999]",
        "[" * 100_000,
        '{"a":' * 1000,
        "[" + "1," * 400_000 + "1]",
        "7",
        '"x"',
        "",
        "[9" + "9" * 5000 + "]",
        "[1" + "0" * 400 + "]",
        "{",
        "null",
        "[-1e999]",
    ],
)
def test_json_that_is_not_plain_finite_and_bounded_is_dropped(text):
    assert outputs.strict_json(text) is None


def test_a_figure_passes():
    figure = {"data": [{"type": "surface", "z": [[1, 2.5], [None, 4]]}], "layout": {"title": "é"}}
    assert outputs.strict_json(json.dumps(figure)) == figure


def test_lone_surrogates_become_the_replacement_character():
    assert outputs.strict_json('{"\\ud800": ["\\udfff"]}') == {"\ufffd": ["\ufffd"]}
    json.dumps(outputs.strict_json('["\\ud83d\\ude00"]'), ensure_ascii=False).encode("utf-8")


def test_only_sensible_image_sizes_stay_of_the_metadata():
    sizes = (
        ("image/png", 30, 40),
        ("image/jpeg", 10**9, 1),
        ("text/html", 1, 1),
        ("image/gif", True, 1),
        "x",
        ("image/gif", "1", "2"),
    )
    assert display({"text/plain": "x"}, sizes)["metadata"] == {"image/png": {"width": 30, "height": 40}}


def test_plain_text_has_no_terminal_escapes_and_keeps_its_lines():
    assert outputs.plain("a\x1b[31mb\n\tc\u202ed\x9be", 100) == "a\ufffd[31mb\n\tc\ufffdd\ufffde"
    assert outputs.plain("äπ→", 2) == "äπ"


VALUES = st.recursive(
    st.none()
    | st.integers()
    | st.text(max_size=5)
    | st.sampled_from(["stream", "stdout", "error", "display_data", "text/plain"]),
    lambda inner: st.lists(inner, max_size=5).map(tuple),
    max_leaves=20,
)


@settings(max_examples=300, deadline=None)
@given(VALUES)
def test_any_value_is_outputs_or_a_wire_error(value):
    for check in (lambda: outputs.outputs(value, 1000, 10), lambda: outputs.updates(value)):
        with contextlib.suppress(WireError):
            check()


def test_a_figure_drawn_again_is_not_read_again():
    text = json.dumps({"data": [{"type": "scatter", "y": [1, 2]}], "layout": {"title": "a"}})
    figure = outputs.drawn(text)
    assert figure == json.loads(text)
    assert outputs.drawn(text) is figure
    assert outputs.drawn(text.replace("1", "3")) == json.loads(text.replace("1", "3"))
    for broken in ("[1]", "7", "{", '{"data": NaN}', '{"data": 1e400}'):
        assert outputs.drawn(broken) == outputs.strict_json(broken)


def test_what_is_remembered_of_figures_is_bounded():
    kept = outputs._Kept()
    for number in range(40):
        text = json.dumps({"data": [], "layout": {"title": f"{number}" * (outputs.KEPT // 20)}})
        kept.put(text, outputs.Drawn({}))
        kept.put(text, outputs.Drawn({}))
        assert kept.size == sum(map(len, kept.figures)) <= outputs.KEPT
    assert 0 < len(kept.figures) < 20
    assert outputs.drawn(json.dumps({"data": [0] * (outputs.KEPT_ITEMS + 1)})) is not outputs.drawn(
        json.dumps({"data": [0] * (outputs.KEPT_ITEMS + 1)})
    )
