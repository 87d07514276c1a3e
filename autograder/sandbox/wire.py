"""The protocol between the trusted side and a child: frames with a fixed header, values in a fixed binary form.

Nothing that arrives is executed or unpickled. Every size is checked against what has really arrived before anything is
allocated, so that a hostile frame costs a small multiple of its own length, and the length of a frame is bounded. The same
file runs on both sides.

    frame   kind (1 byte), length of the body (4), id of the exchange (16), body
    body    one value
    value   N | T | F | i int64 | d float64 | s length utf-8 | b length bytes | t count values | l count values
            | a dtype ndim shape data | c array array | p array | x s s
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from autograder.curvedata import CurveData, SurfaceData
from autograder.returned import DEPTH as DEPTH
from autograder.returned import DIMENSIONS, Foreign

Value: TypeAlias = (
    "bool | int | float | str | bytes | NDArray[Any] | CurveData | SurfaceData | Foreign | tuple[Value, ...] | Values | None"
)
Values: TypeAlias = "list[Value]"
Writer: TypeAlias = Callable[[Any, list[bytes], int], None]  # of a value, to these parts, nested so deep

HEADER = struct.Struct("<BI16s")
LINK_LOST = 71  # exit code of a child that finds its socket closed by the code it runs

START, CELL, CALLS, FILES, SERVE, APART = 1, 2, 3, 4, 5, 6  # asked of the child
DONE = 65  # its answer; one for each call of CALLS, which end with the first of these failures
FATAL = ("timeout", "memory", "missing")
KINDS = frozenset({START, CELL, CALLS, FILES, SERVE, APART, DONE})
PEER_CALL, NAME, END, REPLY = 97, 98, 99, 100  # between two notebooks' processes; never taken by the trusted side
PEER_KINDS = frozenset({PEER_CALL, NAME, END, REPLY})

ITEMS = 100_000
DTYPES = {"f4": "<f4", "f8": "<f8", "i4": "<i4", "i8": "<i8", "u1": "|u1", "b1": "|b1", "c8": "<c8", "c16": "<c16"}
CODES = {np.dtype(text): code for code, text in enumerate(DTYPES.values())}
BY_CODE = {code: dtype for dtype, code in CODES.items()}

INT, FLOAT, LENGTH, ARRAY = (struct.Struct(f"<c{code}") for code in ("q", "d", "I", "BB"))  # each with its letter
WHOLE, REAL, COUNT, DTYPE = (struct.Struct(f"<{code}") for code in ("q", "d", "I", "BB"))
DIMENSIONS_OF = [struct.Struct(f"<{number}q") for number in range(DIMENSIONS + 1)]


class WireError(ValueError):
    """What arrived does not follow the protocol, or what should be sent cannot be written in it."""


def frame(kind: int, exchange: bytes, body: bytes) -> bytes:
    """A whole frame."""
    return HEADER.pack(kind, len(body), exchange) + body


def header(data: bytes | bytearray, limit: int, kinds: frozenset[int] = KINDS) -> tuple[int, int, bytes]:
    """Kind, length of the body and id of the exchange, of data that begin with a header.

    Raises
    ------
    WireError
        On an unknown kind, or a body longer than the limit.
    """
    kind, length, exchange = HEADER.unpack_from(data)
    if kind not in kinds:
        raise WireError(f"unknown kind of frame: {kind}")
    if length > limit:
        raise WireError(f"a frame of {length} bytes; at most {limit} are taken")
    return kind, length, exchange


def count(value: Any) -> int:
    """How many values a value consists of, itself included; no more than :data:`ITEMS` are read."""
    return 1 + sum(map(count, value)) if isinstance(value, tuple | list) else 1


def encode(value: Any, *, depth: int = DEPTH) -> bytes:
    """A value in binary form.

    Raises
    ------
    WireError
        For what has no form here; the message names it.
    """
    parts: list[bytes] = []
    _write(value, parts, depth)
    return b"".join(parts)


def row(encoded: Sequence[bytes]) -> bytes:
    """The tuple of these values, which are in binary form already."""
    return LENGTH.pack(b"t", len(encoded)) + b"".join(encoded)


def decode(body: bytes, *, depth: int = DEPTH, items: int = ITEMS, raw: bool = False) -> Any:
    """The value in ``body``: arrays read-only and not writable again, text valid Unicode.

    ``depth`` bounds the nesting of tuples, ``items`` the number of values in all; ``raw`` allows bytes.

    Raises
    ------
    WireError
        If the body is anything else than one value.
    """
    reader = _Reader(body, items, raw)
    try:
        value = reader.value(depth)
    except (struct.error, ValueError, TypeError, OverflowError, MemoryError) as error:
        raise WireError(f"not a value: {error}") from None
    if reader.at != len(body):
        raise WireError(f"{len(body) - reader.at} bytes after the value")
    return value


def _write(value: Any, parts: list[bytes], depth: int) -> None:
    write = WRITERS.get(type(value)) or _writer(value)
    write(value, parts, depth)


def _writer(value: Any) -> Writer:
    """How a value is written whose class derives from a known one, as NumPy's float64 does from float."""
    for known, write in WRITERS.items():
        if isinstance(value, known):
            return write
    raise WireError(f"a value of type {type(value).__name__}")


def _write_int(value: int, parts: list[bytes], depth: int) -> None:
    if not -(2**63) <= value < 2**63:
        raise WireError("an integer beyond 64 bits")
    parts.append(INT.pack(b"i", value))


def _write_text(value: str, parts: list[bytes], depth: int) -> None:
    text = value.encode("utf-8", "backslashreplace")
    parts += [LENGTH.pack(b"s", len(text)), text]


def _write_array(value: NDArray[Any], parts: list[bytes], depth: int = 0) -> None:
    array = np.asarray(value)
    code = CODES.get(array.dtype)
    if code is None:
        wider = {"b": "<i8", "i": "<i8", "u": "<i8", "f": "<f8", "c": "<c16"}.get(array.dtype.kind)
        if wider is None:
            raise WireError(f"an array of dtype {array.dtype}")
        swapped = array.dtype.newbyteorder("<")
        array = array.astype(swapped if swapped in CODES else wider)
        code = CODES[array.dtype]
    if array.ndim > DIMENSIONS:
        raise WireError(f"an array of {array.ndim} dimensions; at most {DIMENSIONS} can be sent")
    parts += [ARRAY.pack(b"a", code, array.ndim), DIMENSIONS_OF[array.ndim].pack(*array.shape), array.tobytes()]


def _write_curve(curve: CurveData, parts: list[bytes], depth: int) -> None:
    parts.append(b"c")
    _write_array(curve.breaks, parts)
    _write_array(curve.coefficients, parts)


def _write_surface(surface: SurfaceData, parts: list[bytes], depth: int) -> None:
    parts.append(b"p")
    _write_array(surface.coefficients, parts)


def _write_foreign(value: Foreign, parts: list[bytes], depth: int) -> None:
    parts.append(b"x")
    _write_text(value.kind, parts, depth)
    _write_text(value.text, parts, depth)


def _write_items(tag: bytes) -> Writer:
    def write(value: Sequence[Any], parts: list[bytes], depth: int) -> None:
        if depth < 1:
            raise WireError("tuples nested too deeply")
        parts.append(LENGTH.pack(tag, len(value)))
        for item in value:
            _write(item, parts, depth - 1)

    return write


WRITERS: dict[type, Writer] = {  # a class after those that derive from it
    type(None): lambda value, parts, depth: parts.append(b"N"),
    bool: lambda value, parts, depth: parts.append(b"T" if value else b"F"),
    int: _write_int,
    float: lambda value, parts, depth: parts.append(FLOAT.pack(b"d", value)),
    str: _write_text,
    bytes: lambda value, parts, depth: parts.extend((LENGTH.pack(b"b", len(value)), value)),
    np.ndarray: _write_array,
    CurveData: _write_curve,
    SurfaceData: _write_surface,
    Foreign: _write_foreign,
    tuple: _write_items(b"t"),
    list: _write_items(b"l"),
}


class _Reader:
    """Reads values out of a body and never beyond it."""

    def __init__(self, body: bytes, items: int, raw: bool) -> None:
        self.body, self.at, self.items, self.raw = body, 0, items, raw

    def take(self, count: int) -> bytes:
        """The next so many bytes."""
        at, end = self.at, self.at + count
        if count < 0 or end > len(self.body):
            raise WireError(f"{count} bytes announced, {len(self.body) - at} there")
        self.at = end
        return self.body[at:end]

    def unpack(self, form: struct.Struct) -> tuple[Any, ...]:
        """What the next bytes hold; ``struct.error`` where they are too few."""
        found = form.unpack_from(self.body, self.at)
        self.at += form.size
        return found

    def value(self, depth: int) -> Any:
        """One value."""
        self.items -= 1
        if self.items < 0:
            raise WireError("too many values")
        tag = self.take(1)
        read = READERS.get(tag)
        if read is None or (tag == b"b" and not self.raw):
            raise WireError(f"unknown kind of value: {tag!r}")
        return read(self, depth)

    def block(self, depth: int = 0) -> bytes:
        """Bytes of an announced length."""
        return self.take(self.unpack(COUNT)[0])

    def text(self, depth: int = 0) -> str:
        """Text: a block."""
        return self.block().decode("utf-8", "replace")

    def members(self, depth: int) -> list[Any]:
        """As many values as are announced."""
        count = self.unpack(COUNT)[0]
        if depth < 1 or count > len(self.body) - self.at:  # every value takes at least one byte
            raise WireError("tuples nested too deeply, or more values announced than there are bytes")
        return [self.value(depth - 1) for _ in range(count)]

    def array(self, depth: int = 0) -> NDArray[Any]:
        """An array: its dtype, its shape, its numbers."""
        code, dimensions = self.unpack(DTYPE)
        if code not in BY_CODE or dimensions > DIMENSIONS:
            raise WireError(f"an array of dtype code {code} and {dimensions} dimensions")
        shape = self.unpack(DIMENSIONS_OF[dimensions])
        count = 1
        for length in shape:
            if not 0 <= length <= 2**31:
                raise WireError(f"an array of shape {shape}")
            count *= length
        dtype = BY_CODE[code]
        data = self.take(count * dtype.itemsize)
        if dtype.kind == "b" and count and max(data) > 1:
            raise WireError("a boolean that is neither 0 nor 1")
        return np.frombuffer(data, dtype, count).reshape(shape)

    def curve(self, depth: int) -> CurveData:
        """A curve: its breaks and its coefficients."""
        return CurveData(self.member(), self.member())

    def surface(self, depth: int) -> SurfaceData:
        """A surface: its coefficients."""
        return SurfaceData(self.member())

    def foreign(self, depth: int) -> Foreign:
        """What cannot cross: two texts."""
        return Foreign(self.said(), self.said())

    def member(self) -> NDArray[Any]:
        """An array that a curve or a surface consists of."""
        if self.take(1) != b"a":
            raise WireError("a curve consists of two arrays, a surface of one")
        array = self.array()
        if array.dtype != np.float64:
            raise WireError("curves and surfaces consist of float64 arrays")
        return array

    def said(self) -> str:
        """A text that tells what cannot cross."""
        if self.take(1) != b"s":
            raise WireError("what cannot cross is told by two texts")
        return self.text()


READERS: dict[bytes, Callable[[_Reader, int], Any]] = {
    b"N": lambda reader, depth: None,
    b"T": lambda reader, depth: True,
    b"F": lambda reader, depth: False,
    b"i": lambda reader, depth: reader.unpack(WHOLE)[0],
    b"d": lambda reader, depth: reader.unpack(REAL)[0],
    b"s": _Reader.text,
    b"b": _Reader.block,
    b"a": _Reader.array,
    b"c": _Reader.curve,
    b"p": _Reader.surface,
    b"t": lambda reader, depth: tuple(reader.members(depth)),
    b"l": _Reader.members,
    b"x": _Reader.foreign,
}
