"""Connections to a gradebook in SQLite or PostgreSQL, made so that its writers wait for each other and never for ever."""

from __future__ import annotations

from typing import Any

import sqlalchemy as sa
from sqlalchemy.engine import URL, Connection, Engine, make_url

from autograder.errors import CourseError

BUSY_SECONDS = 60


def parsed(url: str) -> URL:
    """The URL of a gradebook.

    Raises
    ------
    CourseError
        If it is none, or of another kind than these two.
    """
    try:
        place = make_url(url)
    except sa.exc.ArgumentError:  # not repeated: a password may stand in it
        raise CourseError(
            "c.CourseDirectory.db_url is no database URL; write sqlite:///PATH or postgresql+psycopg://..."
        ) from None
    if place.get_backend_name() not in ("sqlite", "postgresql"):
        raise CourseError(f"a gradebook lies in SQLite or PostgreSQL; c.CourseDirectory.db_url names {place.drivername}")
    return place


def engine_of(url: URL) -> Engine:
    """An engine whose transactions wait a minute for those of others, and no longer.

    SQLite's take the write lock at once, so that two writers never deadlock. Those of PostgreSQL lock rows as they come to
    them; who writes single rows, as formgrader does, is never part of a deadlock.
    """
    if url.get_backend_name() == "postgresql":
        return _postgresql(url)
    engine = sa.create_engine(url, connect_args={"timeout": BUSY_SECONDS})

    @sa.event.listens_for(engine, "connect")
    def _(connection: Any, record: Any) -> None:
        connection.isolation_level = None  # pysqlite must not begin transactions on its own

    @sa.event.listens_for(engine, "begin")
    def _(connection: Connection) -> None:
        connection.exec_driver_sql("BEGIN IMMEDIATE")

    return engine


def _postgresql(url: URL) -> Engine:
    try:
        engine = sa.create_engine(url, pool_pre_ping=True)  # a server that was started again costs a connection, not the run
    except ModuleNotFoundError as error:
        raise CourseError(
            f"a gradebook in PostgreSQL needs {error.name}: pip install 'directrix[postgres]', and write the URL in "
            "c.CourseDirectory.db_url as postgresql+psycopg://..."
        ) from None

    @sa.event.listens_for(engine, "begin")
    def _(connection: Connection) -> None:
        connection.exec_driver_sql(f"SET LOCAL lock_timeout = '{BUSY_SECONDS}s'")

    return engine
