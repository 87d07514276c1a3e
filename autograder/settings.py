"""The settings of a course, from ``nbgrader_config.py`` and Jupyter's folders, found where nbgrader finds them."""

from __future__ import annotations

import ast
import contextlib
import difflib
import logging
import sys
from pathlib import Path
from typing import Any

from traitlets.config.loader import (
    Config,
    ConfigFileNotFound,
    DeferredConfigList,
    DeferredConfigString,
    JSONFileConfigLoader,
    PyFileConfigLoader,
)

from autograder.errors import CourseError

CONFIG = "nbgrader_config"
OWN = {"Directrix": ("level", "packages", "salt"), "Sandbox": ("tests", "withhold", "engine")}
# Sections that nbgrader's classes inherit settings from, the nearest first.
INHERITED = {
    "Autograde": ("Autograde", "BaseConverter"),
    "GenerateFeedback": ("GenerateFeedback", "BaseConverter"),
    "Execute": ("Execute", "ExecutePreprocessor", "NbGraderPreprocessor"),
    "OverwriteCells": ("OverwriteCells", "NbGraderPreprocessor"),
    "IgnorePattern": ("IgnorePattern", "NbGraderPreprocessor"),
    "LimitOutput": ("LimitOutput", "NbGraderPreprocessor"),
    "AssignLatePenalties": ("AssignLatePenalties", "NbGraderPreprocessor"),
    "LateSubmissionPlugin": ("LateSubmissionPlugin", "BasePlugin"),
}


def found(config: Config, section: str, name: str, default: Any) -> Any:
    """A setting under its section or one that the section inherits from."""
    for known in INHERITED.get(section, (section,)):
        if known in config and name in config[known]:
            return _resolved(config[known][name])
    return default


def refuse_unknown(config: Config) -> None:
    """Refuse a misspelt setting of ours, which traitlets passes over: it may be the one that keeps answers from learners.

    Raises
    ------
    CourseError
        That names it, and what may be meant.
    """
    for section, names in OWN.items():
        for name in sorted(set(config.get(section, {})) - set(names)):
            near = difflib.get_close_matches(name, names, n=1)
            meant = f"is c.{section}.{near[0]} meant? " if near else ""
            raise CourseError(f"there is no setting c.{section}.{name}; {meant}c.{section} has {', '.join(names)}")


def load(folder: Path) -> Config:
    """Settings from Jupyter's configuration folders and the course folder, the course's last, as nbgrader merges them.

    Raises
    ------
    CourseError
        If a file cannot be read.
    """
    from jupyter_core.paths import jupyter_config_path

    merged = Config()
    sys.path.insert(0, str(folder))  # nbgrader does so too: a course may import its own plug-ins
    try:
        for place in [*reversed([Path(path) for path in jupyter_config_path()]), folder]:
            for loader in (JSONFileConfigLoader, PyFileConfigLoader):
                suffix = ".py" if loader is PyFileConfigLoader else ".json"
                if (place / (CONFIG + suffix)).is_file():
                    merged.merge(_loaded(loader, CONFIG + suffix, place))
    finally:
        sys.path.remove(str(folder))
    return merged


def _loaded(loader: Any, name: str, place: Path) -> Config:
    try:
        return loader(name, path=str(place), log=logging.getLogger(__name__)).load_config()  # type: ignore[no-any-return]
    except ConfigFileNotFound:
        return Config()
    except Exception as error:
        raise CourseError(f"{place / name} cannot be read: {type(error).__name__}: {error}") from error


def _resolved(value: Any) -> Any:
    """A setting as it is meant: one from the command line is a string whose type its trait would have decided."""
    if isinstance(value, DeferredConfigList):
        return [_resolved(DeferredConfigString(item)) for item in value]
    if isinstance(value, DeferredConfigString):
        with contextlib.suppress(ValueError, SyntaxError):
            return ast.literal_eval(str(value))
        return str(value)
    return value
