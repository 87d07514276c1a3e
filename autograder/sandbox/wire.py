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
from collections.abc import Sequence
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

INT, FLOAT, LENGTH, ARRAY, DIMENSION = (struct.Struct(f"<{code}") for code in ("q", "d", "I", "BB", "q"))


class WireError(ValueError):
    """What arrived does not follow the protocol, or what should be sent cannot be written in it."""


def frame(kind: int, exchange: bytes, body: bytes) -> bytes:
    """A whole frame."""
    return HEADER.pack(kind, len(body), exchange) + body


def header(data: bytes, limit: int, kinds: frozenset[int] = KINDS) -> tuple[int, int, bytes]:
    """Kind, length of the body and id of the exchange.

    Raises
    ------
    WireError
        On an unknown kind, or a body longer than the limit.
    """
    kind, length, exchange = HEADER.unpack(data)
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
    if value is None or value is True or value is False:
        parts.append({None: b"N", True: b"T", False: b"F"}[value])
    elif isinstance(value, int):
        if not -(2**63) <= value < 2**63:
            raise WireError("an integer beyond 64 bits")
        parts.append(b"i" + INT.pack(value))
    elif isinstance(value, float):
        parts.append(b"d" + FLOAT.pack(value))
    elif isinstance(value, str):
        text = value.encode("utf-8", "backslashreplace")
        parts += [b"s", LENGTH.pack(len(text)), text]
    elif isinstance(value, bytes):
        parts += [b"b", LENGTH.pack(len(value)), value]
    elif isinstance(value, np.ndarray):
        _write_array(value, parts)
    elif isinstance(value, CurveData):
        parts.append(b"c")
        _write_array(value.breaks, parts)
        _write_array(value.coefficients, parts)
    elif isinstance(value, SurfaceData):
        parts.append(b"p")
        _write_array(value.coefficients, parts)
    elif isinstance(value, Foreign):
        parts.append(b"x")
        _write(value.kind, parts, depth)
        _write(value.text, parts, depth)
    elif isinstance(value, tuple | list):
        if depth < 1:
            raise WireError("tuples nested too deeply")
        parts += [b"t" if isinstance(value, tuple) else b"l", LENGTH.pack(len(value))]
        for item in value:
            _write(item, parts, depth - 1)
    else:
        raise WireError(f"a value of type {type(value).__name__}")


def _write_array(array: NDArray[Any], parts: list[bytes]) -> None:
    plain = np.asarray(array, order="C")
    plain = plain.astype(plain.dtype.newbyteorder("<"), copy=False)
    if plain.dtype not in CODES:
        wider = {"b": "<i8", "i": "<i8", "u": "<i8", "f": "<f8", "c": "<c16"}.get(plain.dtype.kind)
        if wider is None:
            raise WireError(f"an array of dtype {plain.dtype}")
        plain = plain.astype(wider)
    if plain.ndim > DIMENSIONS:
        raise WireError(f"an array of {plain.ndim} dimensions; at most {DIMENSIONS} can be sent")
    parts += [b"a", ARRAY.pack(CODES[plain.dtype], plain.ndim), *map(DIMENSION.pack, plain.shape), plain.tobytes()]


class _Reader:
    """Reads values out of a body and never beyond it."""

    def __init__(self, body: bytes, items: int, raw: bool) -> None:
        self.body, self.at, self.items, self.raw = body, 0, items, raw

    def take(self, count: int) -> bytes:
        if count < 0 or count > len(self.body) - self.at:
            raise WireError(f"{count} bytes announced, {len(self.body) - self.at} there")
        self.at += count
        return self.body[self.at - count : self.at]

    def value(self, depth: int) -> Any:
        self.items -= 1
        if self.items < 0:
            raise WireError("too many values")
        tag = self.take(1)
        if tag in b"NTF":
            return {b"N": None, b"T": True, b"F": False}[tag]
        if tag == b"i":
            return INT.unpack(self.take(INT.size))[0]
        if tag == b"d":
            return FLOAT.unpack(self.take(FLOAT.size))[0]
        if tag == b"s":
            return self.block().decode("utf-8", "replace")
        if tag == b"b" and self.raw:
            return self.block()
        if tag == b"a":
            return self.array()
        if tag == b"c":
            return CurveData(self.member(), self.member())
        if tag == b"p":
            return SurfaceData(self.member())
        if tag == b"t":
            return tuple(self.members(depth))
        if tag == b"l":
            return self.members(depth)
        if tag == b"x":
            return Foreign(self.text(), self.text())
        raise WireError(f"unknown kind of value: {tag!r}")

    def block(self) -> bytes:
        return self.take(LENGTH.unpack(self.take(LENGTH.size))[0])

    def member(self) -> NDArray[Any]:
        if self.take(1) != b"a":
            raise WireError("a curve consists of two arrays, a surface of one")
        array = self.array()
        if array.dtype != np.float64:
            raise WireError("curves and surfaces consist of float64 arrays")
        return array

    def text(self) -> str:
        if self.take(1) != b"s":
            raise WireError("what cannot cross is told by two texts")
        return self.block().decode("utf-8", "replace")

    def members(self, depth: int) -> list[Any]:
        count = LENGTH.unpack(self.take(LENGTH.size))[0]
        if depth < 1 or count > len(self.body) - self.at:  # every value takes at least one byte
            raise WireError("tuples nested too deeply, or more values announced than there are bytes")
        return [self.value(depth - 1) for _ in range(count)]

    def array(self) -> NDArray[Any]:
        code, dimensions = ARRAY.unpack(self.take(ARRAY.size))
        if code not in BY_CODE or dimensions > DIMENSIONS:
            raise WireError(f"an array of dtype code {code} and {dimensions} dimensions")
        shape = [DIMENSION.unpack(self.take(DIMENSION.size))[0] for _ in range(dimensions)]
        if any(length < 0 or length > 2**31 for length in shape):
            raise WireError(f"an array of shape {shape}")
        dtype, count = BY_CODE[code], _product(shape)
        data = self.take(count * dtype.itemsize)
        if dtype.kind == "b" and count and max(data) > 1:
            raise WireError("a boolean that is neither 0 nor 1")
        return np.frombuffer(data, dtype, count).reshape(shape)


def _product(shape: Sequence[int]) -> int:
    count = 1
    for length in shape:
        count *= length
    return count
