"""The protocol: what goes in comes out, and nothing hostile costs more than its own length."""

import contextlib
import struct
import tracemalloc

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from autograder.curvedata import CurveData, SurfaceData
from autograder.returned import KINDS, Foreign
from autograder.sandbox import wire
from autograder.sandbox.wire import WireError, decode, encode

DTYPES = [np.dtype(text) for text in wire.DTYPES.values()]
PLAIN = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-(2**63), 2**63 - 1),
    st.floats(allow_nan=False),
    st.text(st.characters(exclude_categories=("Cs",))),
)
ARRAYS = st.sampled_from(DTYPES).flatmap(
    lambda dtype: arrays.arrays(dtype, arrays.array_shapes(min_dims=0, max_dims=8, min_side=0, max_side=3))
)
FOREIGN = st.builds(Foreign, st.sampled_from(KINDS), st.text(st.characters(exclude_categories=("Cs",)), max_size=120))


def same(left, right):
    """Equal in type and value; arrays bit by bit."""
    if isinstance(left, np.ndarray):
        return left.dtype == right.dtype and left.shape == right.shape and left.tobytes() == right.tobytes()
    if isinstance(left, tuple | list):
        return type(right) is type(left) and len(left) == len(right) and all(map(same, left, right))
    return type(left) is type(right) and left == right


@settings(max_examples=150, deadline=None)
@given(
    st.recursive(
        PLAIN | ARRAYS | FOREIGN,
        lambda inner: st.lists(inner, max_size=4) | st.lists(inner, max_size=4).map(tuple),
        max_leaves=8,
    )
)
def test_every_value_comes_back_as_it_was(value):
    assert same(decode(encode(value, depth=20), depth=20), value)


def test_scalars_arrays_keep_their_zero_dimensions():
    """np.ascontiguousarray would make one dimension of them."""
    assert decode(encode(np.array(2.5))).shape == ()


def test_a_curve_comes_back_with_its_numbers():
    curve = CurveData([0, 0.5, 1], np.arange(12.0).reshape(2, 2, 3))
    assert decode(encode((curve, 1))) == (curve, 1)


def test_a_surface_comes_back_with_its_numbers():
    surface = SurfaceData(np.arange(18.0).reshape(2, 3, 3))
    assert decode(encode((surface, 1))) == (surface, 1)


@pytest.mark.parametrize(
    "body", [b"p" + encode(np.arange(3.0)), b"p" + encode(np.ones((2, 2, 3), dtype="i8")), b"p" + encode(1.0)]
)
def test_what_is_no_surface_is_a_wire_error(body):
    """Too few dimensions, whole numbers, no array."""
    with pytest.raises(WireError):
        decode(body)


@pytest.mark.parametrize("dtype", ["i1", "u2", ">f8", "f2", "longdouble", "uint8"])
def test_other_numbers_are_sent_in_the_nearest_dtype(dtype):
    there = decode(encode(np.array([1, 2, 3], dtype=dtype)))
    assert there.tolist() == [1, 2, 3]
    assert there.dtype in wire.CODES


def test_non_contiguous_arrays_are_sent_in_order():
    array = np.arange(12.0).reshape(3, 4)[::-1, ::2].T
    assert np.array_equal(decode(encode(array)), array)


def test_arrays_that_arrive_cannot_be_made_writable():
    array = decode(encode(np.arange(3.0)))
    with pytest.raises(ValueError, match="WRITEABLE"):
        array.flags.writeable = True


@pytest.mark.parametrize(
    ("value", "named"),
    [
        (2**63, "64 bits"),
        ({}, "dict"),
        (np.array([None]), "object"),
        (((((1,),),),), "nested"),
        (np.zeros((1,) * 33), "33 dim"),
        (np.array("x"), "U1"),
    ],
)
def test_what_has_no_form_is_refused_by_name(value, named):
    with pytest.raises(WireError, match=named):
        encode(value, depth=3)


def test_lone_surrogates_are_written_out():
    assert decode(encode("a\ud800b")) == "a\\ud800b"


def array_frame(code=1, shape=(1,), data=bytes(8)):
    return b"a" + struct.pack("<BB", code, len(shape)) + b"".join(struct.pack("<q", n) for n in shape) + data


HOSTILE = {
    "nothing": b"",
    "unknown tag": b"\x80",
    "a pickle": b"\x80\x04\x95\x00.",
    "bytes where none are allowed": b"b\x00\x00\x00\x00",
    "text announced longer than it is": b"s\xff\xff\xff\xffabc",
    "integer cut short": b"i\x00\x00",
    "something after the value": b"NN",
    "tuple of four billion": b"t\xff\xff\xff\xff",
    "tuples nested past the limit": b"t\x01\x00\x00\x00" * 30 + b"N",
    "tuples nested past the recursion limit": b"t\x01\x00\x00\x00" * 50_000 + b"N",
    "negative shape": array_frame(shape=(-1,)),
    "two negative lengths whose product is right": array_frame(shape=(-1, -1)),
    "shape whose product overflows": array_frame(shape=(2**31, 2**31, 2**31)),
    "shape of the largest integers": array_frame(shape=(2**63 - 1, 2)),
    "more than the body holds": array_frame(shape=(10**9,)),
    "33 dimensions": array_frame(shape=(1,) * 33),
    "a kind of thing that there is not": b"x" + encode("forged") + encode("dict"),
    "a thing told by a number": b"x" + encode("object") + encode(1),
    "255 dimensions": b"a\x01\xff",
    "unknown dtype": array_frame(code=99),
    "boolean 2": array_frame(code=5, shape=(1,), data=b"\x02"),
    "curve of scalars": b"cdd",
    "curve of the wrong shapes": b"c" + array_frame() + array_frame(),
    "curve whose breaks are one number": b"c" + array_frame(shape=()) + array_frame(shape=(1, 1, 1)),
    "curve of integers": b"c" + array_frame(code=3, shape=(2,), data=bytes(16)) + array_frame(),
    "a million empty tuples": b"t" + struct.pack("<I", 10**6) + b"t\0\0\0\0" * 10**6,
}


@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_bodies_are_refused(name):
    with pytest.raises(WireError):
        decode(HOSTILE[name])


def test_empty_dimensions_beside_huge_ones_are_harmless():
    """A product of 0 needs no data; the array must still be safe to use."""
    array = decode(array_frame(shape=(0, 2**31, 7), data=b""))
    assert array.size == 0
    assert array.sum() == 0


@settings(max_examples=300, deadline=None)
@given(
    st.binary(max_size=200)
    | st.lists(st.sampled_from([b"t\x02\x00\x00\x00", b"a\x01\x02", b"N", b"c", b"\xff", b"i", bytes(8)])).map(b"".join)
)
def test_any_bytes_are_a_value_or_a_wire_error(body):
    with contextlib.suppress(WireError):
        decode(body, raw=True)


@settings(max_examples=100, deadline=None)
@given(st.data())
def test_a_damaged_frame_never_escapes(data):
    """One byte of a true value changed: still a value or a WireError, never another exception."""
    values = (
        1,
        "text",
        np.arange(6.0).reshape(2, 3),
        CurveData([0, 1], np.ones((1, 2, 3))),
        SurfaceData(np.ones((2, 2, 3))),
        (None, True),
    )
    body = bytearray(encode(values))
    body[data.draw(st.integers(0, len(body) - 1))] = data.draw(st.integers(0, 255))
    with contextlib.suppress(WireError):
        decode(bytes(body))


@pytest.mark.parametrize(
    "body", [array_frame(shape=(10**9,)), b"t\xff\xff\xff\xff", b"s\xff\xff\xff\xff", array_frame(shape=(2**31, 2**31))]
)
def test_announced_sizes_cost_no_memory(body):
    tracemalloc.start()
    with pytest.raises(WireError):
        decode(body)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 100_000


def test_a_body_costs_a_small_multiple_of_its_length():
    """The dearest values per byte: short numbers in tuples. 100000 values are the bound in any case."""
    body = b"t" + struct.pack("<I", 90_000) + (b"i" + bytes(8)) * 90_000
    tracemalloc.start()
    decode(body)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 8 * len(body)


@pytest.mark.parametrize(
    "head", [struct.pack("<BI16s", 99, 0, bytes(16)), struct.pack("<BI16s", wire.DONE, 2**32 - 1, bytes(16))]
)
def test_headers_of_unknown_kind_or_too_long_a_body_are_refused(head):
    with pytest.raises(WireError):
        wire.header(head, 1000)


def test_a_good_header_is_taken():
    assert wire.header(wire.frame(wire.DONE, b"x" * 16, b"abc")[: wire.HEADER.size], 1000) == (wire.DONE, 3, b"x" * 16)
