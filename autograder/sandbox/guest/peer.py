"""Two notebooks' processes that call each other: test cells in one, the learner's code in the other.

Both ends speak frames of :mod:`autograder.sandbox.wire` over one socket that only they hold. Who waits for an answer serves
the calls that come meanwhile, so a test may hand a function over and have it called back. The learner's end may say anything
at any time: the other end takes only the answer to its own question, of a bounded size, as values.

    CALL   number of a function, arguments, keywords    REPLY  how, what, printed to stdout, printed to stderr, changed
    NAME   a name of the notebook                       END    nothing more is asked for now

``how`` is VALUE, RAISED (an exception, raised again here) or LOST (a sentence: there is a value, but it cannot cross, or the
time is up). What is lost breaks the test off past every ``except Exception``, since a test that expects an error must not
pass for want of an answer.

Arguments are copies; where the function has changed them (sorted a list, written into an array), ``changed`` is what they are
now, and the caller's own get that content: a test that says "leaves its argument alone" must see it.
"""

from __future__ import annotations

import contextlib
import secrets
import socket
import sys
from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import Any

from autograder.sandbox import wire
from autograder.sandbox.guest import crossing
from autograder.sandbox.guest.answers import TimeLimitExceeded
from autograder.sandbox.guest.crossing import CannotCross
from autograder.sandbox.guest.words import say

MOST = 64 * 2**20  # bytes of one message
NESTED = 50  # calls within calls, to and fro
VALUE, RAISED, LOST = "value", "raised", "lost"
# Raised in the midst of all(map(f, ...)) or a loop over it, these end it as if there were no more to test.
ENDS_A_LOOP = (StopIteration, StopAsyncIteration, GeneratorExit)
Printed = Callable[[], tuple[str, str]]


class NoAnswer(BaseException):
    """No answer can be had from the other process: it has ended, its time is up, or what it has cannot cross."""


class Ended(Exception):
    """The other side asks for nothing more."""


class Peer:
    """One end.

    Parameters
    ----------
    link : socket
        Shared with the other process alone.
    find : callable
        The value of a name of this notebook; raises KeyError.
    printed : callable
        What was printed to stdout and stderr since it was last asked.
    timed : callable
        A context manager within which a call for the other side runs; ends it when its time is up.
    """

    def __init__(
        self,
        link: socket.socket,
        find: Callable[[str], Any],
        printed: Printed = lambda: ("", ""),
        timed: Callable[[], AbstractContextManager[None]] = contextlib.nullcontext,
    ) -> None:
        self.link, self.find, self.printed, self.timed = link, find, printed, timed
        self.functions = crossing.Functions(self.call, self._lose)
        self.nested = 0
        self.lost: list[str] = []  # what could not be had since this was last emptied

    def value(self, name: str) -> Any:
        """The other notebook's value of a name.

        Raises
        ------
        KeyError
            If it has no such name.
        NoAnswer
            If its value cannot come here.
        """
        return self._ask(wire.NAME, (name,))

    def call(self, number: int, arguments: tuple[Any, ...], keywords: dict[str, Any]) -> Any:
        """Call a function of the other side; raises what it raised."""
        try:
            forms = crossing.pack(arguments, self.functions), crossing.pack(keywords, self.functions)
        except CannotCross as error:
            raise self._lose(say("hands_over", what=error)) from None
        return self._ask(wire.PEER_CALL, (number, *forms), (arguments, keywords))

    def end(self) -> None:
        """Tell the other side that nothing more is asked for now."""
        with contextlib.suppress(NoAnswer):  # it may have ended
            self._send(wire.END, bytes(16), ())

    def serve(self) -> None:
        """Answer calls until the other side ends."""
        with contextlib.suppress(Ended):
            while True:
                self._serve_one(*self._receive())

    def _ask(self, kind: int, request: tuple[Any, ...], handed: tuple[Any, ...] = ()) -> Any:
        exchange = secrets.token_bytes(16)
        if self.nested >= NESTED:
            raise RecursionError(say("to_and_fro", most=NESTED))
        self.nested += 1
        try:
            self._send(kind, exchange, request)
            while True:
                answered, name, body = self._receive()
                if answered == wire.REPLY and name == exchange:
                    return self._value(body, handed)
                if answered in (wire.PEER_CALL, wire.NAME):
                    self._serve_one(answered, name, body)
        finally:
            self.nested -= 1

    def _value(self, body: Any, handed: tuple[Any, ...]) -> Any:
        if not (isinstance(body, tuple) and len(body) == 5 and isinstance(body[2], str) and isinstance(body[3], str)):
            raise self._lose(say("nonsense"))
        how, form, out, err, changed = body
        sys.stdout.write(out)
        sys.stderr.write(err)
        try:
            value = crossing.unpack(form, self.functions)
            after = None if changed is None else crossing.unpack(changed, self.functions)
        except CannotCross as error:
            raise self._lose(say("answers_with", what=error)) from None
        if after is not None:
            crossing.restore(handed, after)
        if how == VALUE:
            return value
        if how == RAISED and isinstance(value, ENDS_A_LOOP):
            raise RuntimeError(say("raised", exception=type(value).__name__)) from value
        if how == RAISED and isinstance(value, BaseException):
            raise value
        raise self._lose(str(value)[: crossing.MESSAGE])

    def _lose(self, why: str) -> NoAnswer:
        self.lost.append(why)
        return NoAnswer(why)

    def _serve_one(self, kind: int, exchange: bytes, request: Any) -> None:
        if kind == wire.END:
            raise Ended
        if kind == wire.REPLY:
            return  # an answer that nobody waits for any more
        self.printed()
        how, form, changed = self._answer(kind, request)
        try:
            self._send(wire.REPLY, exchange, (how, form, *self.printed(), changed))
        except wire.WireError as error:
            self._send(wire.REPLY, exchange, (LOST, ("=", say("unsent", error=error)), "", "", None))

    def _answer(self, kind: int, request: Any) -> tuple[str, crossing.Form, crossing.Form | None]:
        """Do what is asked, and pack what comes of it; with it what the arguments are now, if they have changed."""
        handed: list[Any] = []  # arguments and keywords, and their form before
        try:
            with self.timed():
                how, form = VALUE, crossing.pack(self._do(kind, request, handed), self.functions)
        except Ended:
            raise
        except (TimeLimitExceeded, NoAnswer) as error:
            return LOST, ("=", str(error)), None
        except CannotCross as error:
            name = str(request[0]) if kind == wire.NAME else say("answer")
            return LOST, ("=", say("cannot_leave", name=name, what=error)), None
        except BaseException as error:  # SystemExit too: it is the caller's to meet
            how, form = RAISED, crossing.pack_error(error, self.functions)
        try:
            return how, form, self._changed(*handed) if handed else None
        except (CannotCross, wire.WireError) as error:
            return LOST, ("=", say("has_now", what=error)), None

    def _do(self, kind: int, request: Any, handed: list[Any]) -> Any:
        if kind == wire.NAME:
            return self.find(*request)
        number, *forms = request
        function = self.functions.own(number)
        arguments, keywords = (crossing.unpack(form, self.functions) for form in forms)
        values = (arguments, keywords)
        if any(map(crossing.changeable, (*arguments, *keywords.values()))):
            handed += [values, self._as_sent(values)]
        return function(*arguments, **keywords)

    def _changed(self, values: tuple[Any, ...], before: bytes) -> crossing.Form | None:
        return self._packed(values) if self._as_sent(values) != before else None

    def _as_sent(self, values: tuple[Any, ...]) -> bytes:
        return wire.encode(self._packed(values), depth=crossing.WIRE_DEPTH)

    def _packed(self, values: tuple[Any, ...]) -> crossing.Form:
        return crossing.pack(values, self.functions, crossing.DEPTH + 1)

    def _send(self, kind: int, exchange: bytes, request: tuple[Any, ...]) -> None:
        body = wire.encode(request, depth=crossing.WIRE_DEPTH)
        if len(body) > MOST:
            raise wire.WireError(f"{len(body)} bytes; at most {MOST} go from one process to the other")
        try:
            self.link.sendall(wire.frame(kind, exchange, body))
        except OSError as error:
            raise self._lose(f"{say('ended')} ({error})") from None

    def _receive(self) -> tuple[int, bytes, Any]:
        try:
            kind, length, exchange = wire.header(self._exactly(wire.HEADER.size), MOST, wire.PEER_KINDS)
            body = wire.decode(self._exactly(length), depth=crossing.WIRE_DEPTH, items=MOST, raw=True)
        except wire.WireError as error:
            raise self._lose(say("protocol", error=error)) from None
        return kind, exchange, body

    def _exactly(self, count: int) -> bytes:
        data = bytearray()
        while len(data) < count:
            try:
                part = self.link.recv(min(count - len(data), 2**20))
            except OSError:
                part = b""
            if not part:
                raise self._lose(say("ended"))
            data += part
        return bytes(data)


class Unreachable:
    """Stands for a value that cannot cross: whatever is done with it breaks the test off, and says why."""

    def __init__(self, peer: Peer, why: str) -> None:
        object.__setattr__(self, "_refuse", lambda: peer._lose(why))

    def __getattribute__(self, name: str) -> Any:
        raise object.__getattribute__(self, "_refuse")()


def _refused(self: Unreachable, *_: Any, **__: Any) -> Any:
    raise object.__getattribute__(self, "_refuse")()


USES = (
    "call getitem setitem delitem iter next len contains bool int float complex index str repr format hash eq ne lt le gt ge "
    "add radd sub rsub mul rmul truediv rtruediv floordiv rfloordiv mod rmod pow rpow matmul rmatmul neg pos abs invert "
    "and rand or ror xor rxor lshift rlshift rshift rrshift round enter exit array"
)
for use in USES.split():
    setattr(Unreachable, f"__{use}__", _refused)
