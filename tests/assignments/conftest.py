"""What the tests of the assignments share: answers sampled without the judge, so that they hold the judge to account too."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from autograder.exercise import Drawn, Exercise

GRID = np.linspace(0.0, 1.0, 9)
SCATTERED = np.random.default_rng(8).uniform(size=(3, 32))


class Sampler:
    """Evaluates a function on a data set, and measures how far two such answers are apart."""

    def answer(self, exercise: Exercise, function: Callable[..., Any], drawn: Drawn) -> Any:
        """All samples as one array (n, dimension), the value itself, or the word "ValueError" for a refusal."""
        arguments = list(drawn.arguments.values())
        axes = len(exercise.parameters)
        try:
            if exercise.judged_as is not None:
                return exercise.judged_as(function(*arguments))(*SCATTERED[:2])
            if not axes:
                return function(*arguments)
            mesh = np.meshgrid(*[GRID] * axes, indexing="ij", sparse=True)
            samples = function(*mesh, *arguments), function(*SCATTERED[:axes], *arguments)
        except ValueError:
            return "ValueError"
        dimension = () if exercise.kind == "mask" else (samples[0].shape[-1],)
        return np.concatenate([np.reshape(sample, (-1, *dimension)) for sample in samples])

    def apart(self, one: Any, other: Any) -> float:
        """The largest distance relative to the size of the first; 1 where words, truth values or shapes differ, or what is no
        number stands in one of them only."""
        if isinstance(one, str) or isinstance(other, str):
            return float(not (isinstance(one, str) and isinstance(other, str) and one == other))
        one, other = np.asarray(one), np.asarray(other)
        if one.dtype == bool or one.shape != other.shape or not np.array_equal(np.isnan(one), np.isnan(other)):
            return float(not np.array_equal(one, other, equal_nan=True))
        one, other = np.nan_to_num(one), np.nan_to_num(other)
        size = np.linalg.norm(np.ptp(one, axis=0)) if one.ndim > 1 else np.linalg.norm(one)
        return float(np.linalg.norm(np.atleast_2d(one - other), axis=-1).max() / (size or 1.0))


@pytest.fixture(scope="session")
def sampler() -> Sampler:
    return Sampler()
