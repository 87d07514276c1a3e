"""The small version of ``campaign.py mistakes``: two random seeds that no other test uses, every exercise."""

import pytest
from evidence_tables import mistakes_of, random_seeds, syllabus

from autograder.catalogue import shipped

IDS = [exercise.id for exercise in shipped()]


@pytest.mark.parametrize("id", IDS)
def test_reference_stub_and_every_listed_mistake(id):
    """Full marks, none, and its own name, on the released data and under random seeds."""
    row = mistakes_of(id, 2)
    assert not row.failures
    assert row.reference == row.stub == 3
    assert row.public == row.random == row.mistakes == len(shipped().find(id).mistakes)
    assert row.listed == len(syllabus().get(id, []))


def test_the_syllabus_is_posed_in_full():
    """Each exercise of its tables is there, and all their mistakes are counted."""
    assert set(syllabus()) <= set(IDS)
    assert len(syllabus()) == 45
    assert sum(map(len, syllabus().values())) == 218


def test_random_seeds_are_the_same_every_time_and_differ_by_exercise():
    assert random_seeds(5, "cylinder") == random_seeds(5, "cylinder")
    assert not set(random_seeds(5, "cylinder")) & set(random_seeds(5, "torus"))
