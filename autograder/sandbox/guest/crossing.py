"""Values that go from one notebook's process to another's: plain data as copies, functions as names of themselves.

A test cell that runs apart from the learner's code calls that code across a socket. What crosses is written as plain tuples
(tag first) for the wire; nothing is pickled, and nothing that arrives is executed. Types are kept: a list stays a list, an
``np.float32`` an ``np.float32``, a ``KeyError`` a ``KeyError``. What has no form here does not cross, and the error says what.

    "=" None, bool, float, str, int of 64 bits   "i" any other int      "c" complex       "b" bytes, bytearray
    "[" list, tuple, set, frozenset               "{" dict               ":" range, slice  "." Ellipsis, NotImplemented
    "a" numeric array, its dtype                  "s" numpy scalar       "t" array of text or of times
    "x" a builtin type, by name                   "f" function of the side that writes
    "m" function of the side that reads           "e" an exception

Whatever can be called and is no class crosses as a function.
"""

from __future__ import annotations

import builtins
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from autograder.sandbox.guest.words import say

DEPTH = 24  # of containers in containers
# Of a function: what can be learned of it without calling it.
INSIDE = ["__code__", "__closure__", "__defaults__", "__kwdefaults__", "__globals__", "__annotations__", "__signature__"]
WIRE_DEPTH = 3 * DEPTH + 8  # each container takes up to three tuples of the wire
MESSAGE = 2000  # characters kept of an error's message
CONTAINERS: dict[str, type] = {"list": list, "tuple": tuple, "set": set, "frozenset": frozenset}
TYPES = {name: value for name, value in vars(builtins).items() if isinstance(value, type)}
EXCEPTIONS = {name: value for name, value in TYPES.items() if issubclass(value, BaseException)}
SINGLE = {"Ellipsis": ..., "NotImplemented": NotImplemented}
Form = tuple[Any, ...]


class CannotCross(Exception):
    """A value that has no form between two processes."""


class Functions:
    """The functions of this side that the other side knows by number, and those of the other side that were seen here.

    Parameters
    ----------
    call : callable
        ``call(number, arguments, keywords)`` calls the other side's function of that number.
    refuse : callable
        What is raised where somebody looks into such a function instead of calling it, given a sentence.
    """

    def __init__(
        self,
        call: Callable[[int, tuple[Any, ...], dict[str, Any]], Any],
        refuse: Callable[[str], BaseException] = AttributeError,
    ) -> None:
        self._call, self._refuse = call, refuse
        self._own: list[Any] = []
        self._numbers: dict[int, int] = {}  # by id: what is listed is never let go, so ids stay its own
        self._theirs: dict[int, Remote] = {}

    def number(self, function: Any) -> int:
        """The number of a function of this side."""
        if id(function) not in self._numbers:
            self._numbers[id(function)] = len(self._own)
            self._own.append(function)
        return self._numbers[id(function)]

    def own(self, number: int) -> Any:
        """The function of this side with that number."""
        if not 0 <= number < len(self._own):
            raise CannotCross(say("never_handed"))
        return self._own[number]

    def remote(self, number: int, name: str, doc: str | None) -> Callable[..., Any]:
        """What stands here for the other side's function; the same one each time."""
        if number not in self._theirs:
            self._theirs[number] = Remote(self._call, self._refuse, number, name, doc)
        return self._theirs[number]

    def is_theirs(self, value: Any) -> int | None:
        """The number on the other side of a stand-in made here, else None."""
        if type(value) is not Remote:
            return None
        number: int = vars(value)["_number"]
        return number if self._theirs.get(number) is value else None


class Remote:
    """Stands for a function of the other side: it is called, named and handed back, and is no function of this side.

    A test that reads the text, the code or the signature of what it tests must not read those of a stand-in, where everybody
    would pass: so there are none, and asking for them is refused.
    """

    def __init__(
        self, call: Callable[..., Any], refuse: Callable[[str], BaseException], number: int, name: str, doc: str | None
    ) -> None:
        known = {"__name__": name, "__qualname__": name, "__doc__": doc, "__module__": "__main__"}
        vars(self).update(known, _call=call, _refuse=refuse, _number=number)

    def __call__(self, *arguments: Any, **keywords: Any) -> Any:
        """What the function returns, or raises, on its own side."""
        return self._call(self._number, arguments, keywords)

    def __getattr__(self, name: str) -> Any:
        if name in INSIDE:
            raise self._refuse(say("stays", name=name, function=self.__name__))
        raise AttributeError(f"'function' object has no attribute '{name}'")

    def __repr__(self) -> str:
        return f"<function {self.__name__}>"


def pack(value: Any, functions: Functions, depth: int = DEPTH) -> Form:
    """The form of a value.

    Raises
    ------
    CannotCross
        If it, or something in it, has none.
    """
    kind = type(value)
    if value is None or kind in (bool, float, str) or (kind is int and -(2**63) <= value < 2**63):
        return ("=", value)
    if kind is int:
        return ("i", hex(value))
    if kind is complex:
        return ("c", value.real, value.imag)
    if kind in (bytes, bytearray):
        return ("b", kind.__name__, bytes(value))
    if kind in CONTAINERS.values() or kind is dict:
        if depth < 1:
            raise CannotCross(say("deep", most=DEPTH))
        if kind is dict:
            items = ((pack(key, functions, depth - 1), pack(item, functions, depth - 1)) for key, item in value.items())
            return ("{", tuple(items))
        return ("[", kind.__name__, tuple([pack(item, functions, depth - 1) for item in value]))
    if kind in (range, slice):
        return (":", kind.__name__, *(pack(part, functions, depth - 1) for part in (value.start, value.stop, value.step)))
    if value is Ellipsis or value is NotImplemented:
        return (".", repr(value))
    if kind is np.ndarray:
        return _pack_array(value)
    if isinstance(value, np.generic) and kind.__module__ == "numpy":
        return ("s", _pack_array(np.asarray(value)))
    return _pack_other(value, functions, depth)


def _pack_other(value: Any, functions: Functions, depth: int) -> Form:
    if isinstance(value, type) and TYPES.get(value.__name__) is value:
        return ("x", value.__name__)
    if (number := functions.is_theirs(value)) is not None:
        return ("m", number)
    if callable(value) and not issubclass(type(value), type):  # a function, what lru_cache made of one, a class's own __call__
        return ("f", functions.number(value), _name(value), _doc(value))
    if isinstance(value, BaseException):
        return pack_error(value, functions, depth - 1)
    raise CannotCross(say("object", type=_type_name(value)))


def pack_error(error: BaseException, functions: Functions, depth: int = 4) -> Form:
    """The form of an exception: the nearest builtin class, its own class's name, its arguments, or its message without them."""
    nearest = next(base.__name__ for base in type(error).__mro__ if EXCEPTIONS.get(base.__name__) is base)
    try:
        arguments = pack(tuple(error.args), functions, depth)
    except Exception:  # what the learner raised with may be anything, and may fail when it is looked at
        arguments = pack((_message(error),), functions, depth)
    return ("e", nearest, _type_name(error), arguments)


def _pack_array(array: np.ndarray[Any, Any]) -> Form:
    kind, size = array.dtype.kind, array.dtype.itemsize
    if kind in "biufc" and size <= (16 if kind == "c" else 8):
        plain = np.asarray(array, array.dtype.newbyteorder("="))
        return ("a", array.dtype.str, plain.view("i8") if plain.dtype == np.uint64 else plain)  # the wire has no u8
    if kind in "US":
        texts = [text if isinstance(text, str) else text.decode("latin-1") for text in array.ravel().tolist()]
        return ("t", array.dtype.str, array.shape, tuple(texts))
    if kind in "mM":
        return ("t", array.dtype.str, array.shape, tuple(array.ravel().view("i8").tolist()))
    raise CannotCross(say("dtype", dtype=array.dtype))


def unpack(form: Any, functions: Functions) -> Any:
    """The value of a form.

    Raises
    ------
    CannotCross
        If it is not one.
    """
    try:
        return _unpack(form, functions)
    except CannotCross:
        raise
    except (TypeError, ValueError, KeyError, IndexError, AttributeError, OverflowError, RecursionError, MemoryError) as error:
        raise CannotCross(say("no_value", exception=type(error).__name__)) from None


def _unpack(form: Any, functions: Functions) -> Any:
    tag, *rest = form
    if tag == "=":
        (value,) = rest
        if value is not None and type(value) not in (bool, int, float, str):
            raise CannotCross(say("no_plain"))
        return value
    return _READERS[tag](functions, *rest)


def _container(functions: Functions, kind: str, items: tuple[Any, ...]) -> Any:
    return CONTAINERS[kind](_unpack(item, functions) for item in items)


def _dictionary(functions: Functions, items: tuple[Any, ...]) -> dict[Any, Any]:
    return {_unpack(key, functions): _unpack(item, functions) for key, item in items}


def _stretch(functions: Functions, kind: str, *parts: Any) -> Any:
    start, stop, step = (_unpack(part, functions) for part in parts)
    return range(start, stop, step) if kind == "range" else slice(start, stop, step)


def _array(_: Functions, dtype: str, array: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    wanted = np.dtype(dtype)
    if wanted.kind not in "biufc" or type(array) is not np.ndarray:
        raise CannotCross(say("no_array"))
    if wanted.newbyteorder("=") == np.uint64:
        array = array.view("u8")
    return array.astype(wanted)  # a copy: what arrived is read-only


def _scalar(functions: Functions, form: Form) -> Any:
    return _unpack(form, functions)[()]


def _text_array(_: Functions, dtype: str, shape: tuple[int, ...], items: tuple[Any, ...]) -> np.ndarray[Any, Any]:
    wanted = np.dtype(dtype)
    if wanted.kind not in "USmM":
        raise CannotCross(say("no_text"))
    array = np.array(items, "i8").view(wanted) if wanted.kind in "mM" else np.array(items, wanted)
    return array.reshape(shape)


def _error(functions: Functions, nearest: str, name: str, arguments: Form) -> BaseException:
    made: BaseException = EXCEPTIONS[nearest](*_unpack(arguments, functions))
    if name != nearest:
        made.add_note(f"(raised as {name[:100]})")
    return made


def changeable(value: Any) -> bool:
    """Whether a function that is handed this could change it."""
    if type(value) in (tuple, frozenset):
        return any(map(changeable, value))
    return type(value) in (list, dict, set, bytearray, np.ndarray)


def restore(value: Any, changed: Any) -> Any:
    """Give a value the content of its copy on the other side, in place where it can be changed; returns what it is now."""
    kind = type(value)
    if kind is not type(changed):
        return changed
    if kind is np.ndarray:
        if value.shape != changed.shape or value.dtype != changed.dtype:
            return changed
        if value.tobytes() != changed.tobytes():
            value[...] = changed
    elif kind is list:
        value[:] = [*map(restore, value, changed), *changed[len(value) :]]
    elif kind is tuple:
        return (*map(restore, value, changed), *changed[len(value) :])
    elif kind is dict:
        items = {key: restore(value[key], item) if key in value else item for key, item in changed.items()}
        value.clear()
        value.update(items)
    elif kind is set:
        value.clear()
        value.update(changed)
    elif kind is bytearray:
        value[:] = changed
    else:
        return changed
    return value


_READERS: Mapping[str, Callable[..., Any]] = {
    "i": lambda _, text: int(text, 16),
    "c": lambda _, real, imaginary: complex(real, imaginary),
    "b": lambda _, kind, data: bytearray(data) if kind == "bytearray" else bytes(data),
    "[": _container,
    "{": _dictionary,
    ":": _stretch,
    ".": lambda _, name: SINGLE[name],
    "a": _array,
    "s": _scalar,
    "t": _text_array,
    "x": lambda _, name: TYPES[name],
    "f": lambda functions, number, name, doc: functions.remote(int(number), str(name)[:200], doc and str(doc)[:10_000]),
    "m": lambda functions, number: functions.own(number),
    "e": _error,
}


def _type_name(value: object) -> str:
    return str(type(value).__name__)[:100]


def _name(value: object) -> str:
    name = getattr(value, "__name__", None)
    return name[:200] if isinstance(name, str) else _type_name(value)


def _doc(value: object) -> str | None:
    doc = getattr(value, "__doc__", None)
    return doc[:10_000] if isinstance(doc, str) else None


def _message(error: BaseException) -> str:
    try:
        return str(error)[:MESSAGE]
    except BaseException:  # a learner's own __str__
        return say("unshown")
