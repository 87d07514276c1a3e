"""Answers of references and mistakes, and how far two are apart: without the judge, so that it is held to account too."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from autograder.exercise import Drawn, Exercise

GRID = np.linspace(0.0, 1.0, 9)
SCATTERED = np.random.default_rng(8).uniform(size=(3, 32))
REFUSAL = "ValueError"


def answer(exercise: Exercise, function: Callable[..., Any], drawn: Drawn) -> Any:
    """What a function answers on a data set.

    Returns
    -------
    array (n, dimension) of a map's samples on a mesh and at scattered places; the value itself for what is no map; or the word
    "ValueError" where the function refuses the data. Other errors of the function are not caught.
    """
    arguments = list(drawn.arguments.values())
    axes = len(exercise.parameters)
    with np.errstate(all="ignore"):
        try:
            if exercise.judged_as is not None:
                return exercise.judged_as(function(*arguments))(*SCATTERED[:2])
            if not axes:
                return function(*arguments)
            mesh = np.meshgrid(*[GRID] * axes, indexing="ij", sparse=True)
            samples = [np.asarray(function(*where, *arguments)) for where in (mesh, SCATTERED[:axes])]
        except ValueError:
            return REFUSAL
    dimension = () if exercise.kind == "mask" else (samples[0].shape[-1],)
    return np.concatenate([np.reshape(sample, (-1, *dimension)) for sample in samples])


def refuses(right: Any) -> bool:
    """Whether an answer is the refusal of its data."""
    return isinstance(right, str) and right == REFUSAL


def apart(one: Any, other: Any) -> float:
    """The largest distance between two answers relative to the size of the first.

    1 where words, truth values or shapes differ, or what is no number stands in one of them only; the largest of its parts for
    a tuple of several answers.
    """
    if isinstance(one, tuple) and isinstance(other, tuple) and len({np.shape(part) for part in (*one, *other)}) > 1:
        return max(map(apart, one, other), default=0.0) if len(one) == len(other) else 1.0
    if isinstance(one, str) or isinstance(other, str):
        return float(not (isinstance(one, str) and isinstance(other, str) and one == other))
    one, other = np.asarray(one), np.asarray(other)
    if one.dtype == bool or one.shape != other.shape or not np.array_equal(np.isnan(one), np.isnan(other)):
        return float(not np.array_equal(one, other, equal_nan=True))
    one, other = np.nan_to_num(one), np.nan_to_num(other)
    size = np.linalg.norm(np.ptp(one, axis=0)) if one.ndim > 1 else np.linalg.norm(one)
    return float(np.linalg.norm(np.atleast_2d(one - other), axis=-1).max() / (size or 1.0))
