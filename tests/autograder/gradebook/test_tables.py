"""The tables that we write are nbgrader's: every column, type, key and constraint."""

import pytest
import sqlalchemy as sa

from autograder.gradebook import tables


@pytest.fixture(scope="module")
def models():
    from nbgrader.api import Base

    return Base.metadata


def described(table: sa.Table) -> dict:
    """All that decides what the table is, in plain values."""
    return {
        "columns": {
            column.name: (
                type(column.type).__name__,
                getattr(column.type, "length", None),
                tuple(getattr(column.type, "enums", ())),
                getattr(column.type, "name", None) if isinstance(column.type, sa.Enum) else None,
                column.nullable,
                column.primary_key,
                sorted(key.target_fullname for key in column.foreign_keys),
            )
            for column in table.columns
        },
        "unique": sorted(
            sorted(column.name for column in rule.columns)
            for rule in table.constraints
            if isinstance(rule, sa.UniqueConstraint)
        ),
    }


def test_our_tables_are_those_of_nbgraders_models(models):
    """Names of all tables agree; nbgrader's alembic_version is no model."""
    assert set(tables.metadata.tables) == set(models.tables)


@pytest.mark.parametrize("name", sorted(tables.metadata.tables))
def test_each_table_has_nbgraders_columns_and_constraints(models, name):
    """A new nbgrader that changes a column fails here, not in a gradebook."""
    assert described(tables.metadata.tables[name]) == described(models.tables[name])


@pytest.mark.parametrize("dialect", ["sqlite", "postgresql"])
def test_both_make_the_same_sql(models, dialect):
    """CREATE TABLE, as both databases spell it, is the same set of lines."""
    import importlib

    spelling = importlib.import_module(f"sqlalchemy.dialects.{dialect}").dialect()

    def lines(table):
        made = str(sa.schema.CreateTable(table).compile(dialect=spelling))
        return sorted(line.strip().rstrip(",") for line in made.splitlines())

    for name, table in tables.metadata.tables.items():
        assert lines(table) == lines(models.tables[name]), name
