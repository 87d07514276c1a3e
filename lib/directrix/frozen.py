"""The holder that every form is: attributes set once, compared and printed by value."""

from __future__ import annotations

from typing import Any

import numpy as np

from directrix.errors import FrozenError


class Frozen:
    """An object whose attributes are set once, by ``_hold`` in its ``__init__``.

    Two frozen objects are equal when they are of the same class and hold equal values. Arrays are held read-only, so that
    neither the caller's array nor the form can change under the other.

    Examples
    --------
    >>> from directrix.curves.line import Line
    >>> line = Line((0, 0, 0), (2, 0, 0))
    >>> line == Line((0, 0, 0), (2, 0, 0))
    True
    >>> line.end = (1, 1, 1)
    Traceback (most recent call last):
        ...
    directrix.errors.FrozenError: a Line does not change once it is made; build a new one to change end
    """

    _names: tuple[str, ...] = ()

    def _hold(self, **values: Any) -> None:
        for name, value in values.items():
            if isinstance(value, np.ndarray) and value.flags.writeable:
                value = value.copy() if value.base is not None else value
                value.flags.writeable = False
            object.__setattr__(self, name, value)
        object.__setattr__(self, "_names", (*self._names, *values))

    def __setattr__(self, name: str, value: Any) -> None:
        raise FrozenError(
            f"a {type(self).__name__} does not change once it is made; build a new one to change {name}", name=name
        )

    def __delattr__(self, name: str) -> None:
        raise FrozenError(f"a {type(self).__name__} does not change once it is made; {name} cannot be deleted", name=name)

    def __setstate__(self, state: dict[str, Any]) -> None:
        names = state.pop("_names")
        object.__setattr__(self, "_names", ())
        self._hold(**{name: state[name] for name in names})

    def __getstate__(self) -> dict[str, Any]:
        return {"_names": self._names, **{name: getattr(self, name) for name in self._names}}

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return self._names == other._names and all(_same(getattr(self, name), getattr(other, name)) for name in self._names)

    def __hash__(self) -> int:
        return hash((type(self), tuple(_key(getattr(self, name)) for name in self._names)))

    def __repr__(self) -> str:
        shown = ", ".join(f"{name}={_brief(getattr(self, name))}" for name in self._names)
        return f"{type(self).__name__}({shown})"


def _same(a: Any, b: Any) -> bool:
    if isinstance(a, np.ndarray) or isinstance(b, np.ndarray):
        return np.array_equal(a, b)
    return bool(a == b)


def _key(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return value.shape, (value + 0.0).tobytes()  # + 0.0 makes -0.0 and 0.0, which are equal, hash alike
    return value


def _brief(value: Any) -> str:
    if isinstance(value, np.ndarray):
        return repr(value.tolist()) if value.size <= 12 else f"<array of shape {value.shape}>"
    return repr(value)
