"""Numbers of one's own: the same for the same student everywhere, others for others, and no way from them to hidden data."""

import subprocess
import sys

import numpy as np
import pytest

from autograder import personal
from autograder.catalogue import shipped
from autograder.exercise import PUBLIC_SEED
from autograder.judge import judge
from autograder.notebook import own
from autograder.notebook.secret import hidden_seed, public_salt

SALT = "surfaces 2027"
SECRETS = bytes(range(32)), bytes(range(1, 33))


@pytest.fixture(autouse=True)
def _nobody_yet(monkeypatch):
    monkeypatch.setattr(personal, "_here", {"salt": "", "student": ""})
    monkeypatch.delenv("JUPYTERHUB_USER", raising=False)


@pytest.fixture
def sweep():
    return shipped().find("linear_sweep")


def drawn(exercise, seed=PUBLIC_SEED):
    """All numbers of its public data, but for the curves."""
    return {one.name: [np.array(v).tolist() for k, v in one.arguments.items() if k != "curve"] for one in exercise.draw(seed)}


def test_two_students_see_different_numbers_and_each_the_same_again(sweep):
    """Data that do not come from rng stay everybody's."""
    ada, bob = (sweep.of_student(personal.seed(SALT, student)) for student in ("ada", "bob"))
    assert drawn(ada)["yours"] != drawn(bob)["yours"]
    assert drawn(ada) == drawn(sweep.of_student(personal.seed(SALT, "ada")))
    assert drawn(ada)["lecture"] == drawn(bob)["lecture"] == drawn(sweep)["lecture"]


def test_another_course_gives_other_numbers(sweep):
    """So last year's solutions are no help."""
    assert len({str(drawn(sweep.of_student(personal.seed(salt, "ada")))) for salt in ("2026", "2027", "2028")}) == 3


def test_the_bytes_of_a_seed_are_fixed_once_and_for_all():
    """What a student saw in September is what the grader draws in December, on another machine."""
    assert personal.seed(SALT, "ada").hex() == "a31d9289d76e40f5d455f34dfb0e1e92683929c56c8064dd60a789767ad6ab47"
    assert personal.generator(personal.seed(SALT, "ada"), "linear_sweep", "yours").integers(0, 1000, 3).tolist() == [
        519,
        232,
        738,
    ]


def test_id_and_word_do_not_run_into_each_other():
    """The word "a" with the student "bc" is not the word "ab" with the student "c"."""
    assert personal.seed("a", "bc") != personal.seed("ab", "c")


def test_the_notebook_draws_the_very_numbers_that_check_uses(sweep):
    """`personal.numbers` is the generator of the data set `yours`."""
    personal.course(SALT)
    rng = personal.numbers("linear_sweep", " ada ")
    mine = [rng.integers(1, 6, 3).tolist(), int(rng.integers(2, 7))]
    assert mine == drawn(sweep.of_student(personal.seed_here()))["yours"]
    assert personal.student_here() == "ada"


def test_without_an_id_the_hub_says_who_it_is_and_else_all_share_one_set(sweep, monkeypatch):
    """A name that is typed comes before the hub's."""
    personal.course(SALT)
    assert personal.seed_here() == PUBLIC_SEED
    monkeypatch.setenv("JUPYTERHUB_USER", "ada")
    assert personal.seed_here() == personal.seed(SALT, "ada")
    personal.numbers("linear_sweep", "bob")
    assert personal.seed_here() == personal.seed(SALT, "bob")


def test_an_exercise_that_is_not_personal_stays_everybodys():
    """Its public data are those of the lecture and the cards."""
    cylinder = shipped().find("cylinder")
    assert cylinder.of_student(personal.seed(SALT, "ada")) is cylinder


def test_hidden_data_hang_on_the_secret_and_not_on_the_public_word(sweep):
    """Everything public fixed, another secret draws other hidden data; the word of a course is no seed of them."""
    seeds = [hidden_seed(secret, "ada", "linear_sweep", "digest") for secret in SECRETS]
    ada = sweep.of_student(personal.seed(SALT, "ada"))
    first, second = (drawn(ada, seed) for seed in seeds)
    assert first["yours"] != second["yours"]
    assert first == drawn(sweep, seeds[0])  # whoever sees which public data
    guesses = [personal.seed(SALT, "ada"), personal.seed(public_salt(SECRETS[0]), "ada"), public_salt(SECRETS[0]), PUBLIC_SEED]
    for guess in guesses:
        assert drawn(sweep.of_student(personal.seed(SALT, "ada")), guess)["any_curve"] != first["any_curve"]


def test_the_public_word_is_fixed_by_the_secret_and_does_not_hold_it():
    """Sixteen hexadecimal digits of a one-way function."""
    words = [public_salt(secret) for secret in SECRETS]
    assert words[0] == public_salt(SECRETS[0])
    assert words[0] != words[1]
    assert not any(word in secret.hex() for word, secret in zip(words, SECRETS, strict=True))
    assert all(len(word) == 16 for word in words)


def test_the_judge_shows_a_students_own_numbers(sweep):
    """The worst place of a wrong answer is told of his data."""

    def backwards(u, w, curve, direction, d):
        return sweep(u, w, curve, direction, -d)

    told = [judge(sweep.of_student(personal.seed(SALT, s)), backwards, seed=b"hidden") for s in ("ada", "bob")]
    assert [verdict.mistake for verdict in told] == ["backwards", "backwards"]
    places = [next(c.expected for c in verdict.cases if c.data == "yours" and not c.hidden) for verdict in told]
    assert places[0] != places[1]


@pytest.mark.parametrize(
    ("source", "salt"),
    [
        ('personal.course("workbook")  # a word', "workbook"),
        ("import x\npersonal.course('2027')", "2027"),
        ('# personal.course("no")', None),
        ("personal.course(word)", None),
    ],
)
def test_the_word_is_found_and_written_only_where_it_stands(source, salt):
    """A call with a literal at the beginning of a line."""
    assert own.salt_in(source) == salt
    written = own.with_salt(source, "0123")
    assert own.salt_in(written) == ("0123" if salt is not None else None)
    assert written == (source.replace(salt, "0123").replace("'", '"') if salt is not None else source)


@pytest.mark.parametrize(
    ("source", "noted"),
    [
        ('student = "bob"  # me', True),
        ("student = 'ada'", False),
        ('student = " ada "', False),
        ('student = ""', False),
        ("student = input()", False),
        ("def f():\n    student = 'bob'", False),
        ("student = 'bob", False),
    ],
)
def test_a_typed_id_that_is_somebody_elses_is_noted(sweep, source, noted):
    """What is typed is compared with the folder, and never trusted."""
    cells = [{"cell_type": "markdown", "source": "student = 'bob'"}, {"cell_type": "code", "source": source}]
    said = own.other_id(cells, [sweep], "ada")
    assert (said is not None and "'bob'" in said and "ada" in said) if noted else said is None
    assert own.other_id(cells, [shipped().find("cylinder")], "ada") is None


def test_personal_needs_numpy_only():
    """The sandbox loads this module, where nothing else of the autograder is."""
    code = (
        "import sys; sys.modules['autograder.exercise'] = None; from autograder import personal; "
        "print(personal.numbers('a', 'b').integers(9))"
    )
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert ran.stdout.strip().isdigit()
