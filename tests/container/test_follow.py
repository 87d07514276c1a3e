"""The Containerfile says what its follower can follow, and the follower does what a container engine would."""

import re
from pathlib import Path

import pytest

from autograder import doctor
from tests.container import follow

SMALL = r"""# A comment, and an empty line.

FROM debian:12-slim
RUN apt-get update \
    # in the middle of it
    && apt-get install -y bubblewrap

COPY one.txt two.txt /src/
COPY folder /src/folder
RUN ["touch", "/made"]
ENV PATH=/opt/bin:$PATH NAME="two words"
user grader
WORKDIR /course
WORKDIR inner
ENTRYPOINT ["directrix"]
CMD ["doctor"]
"""


@pytest.fixture
def context(tmp_path):
    place = tmp_path / "context"
    (place / "folder" / "deep").mkdir(parents=True)
    for name in ("one.txt", "two.txt", "folder/deep/three.txt"):
        (place / name).write_text(name)
    return place


@pytest.fixture
def followed(tmp_path, context):
    """Follow a Containerfile in a system of two tables; returns the image and the commands that were run."""
    root = tmp_path / "root"
    (root / "etc").mkdir(parents=True)
    (root / "etc/passwd").write_text("root:x:0:0:root:/root:/bin/sh\ngrader:x:1000:1001::/home/grader:/bin/sh\n")
    (root / "etc/group").write_text("root:x:0:\nmarkers:x:50:\n")

    def do(text, code=0):
        ran = []

        def execute(image, command):
            ran.append((command, image.user, dict(image.environment)))
            return code

        return follow.follow(follow.parse(text), context, root, execute), ran

    return do


def test_steps_are_done_in_their_order(followed):
    image, ran = followed(SMALL)
    assert [command for command, *_ in ran] == [
        ["/bin/sh", "-c", "apt-get update && apt-get install -y bubblewrap"], ["touch", "/made"],
    ]  # fmt: skip
    assert (image.root / "src/one.txt").read_text() == "one.txt"
    assert (image.root / "src/folder/deep/three.txt").read_text() == "folder/deep/three.txt"
    assert image.environment == {"PATH": f"/opt/bin:{follow.FIRST_PATH}", "NAME": "two words"}
    assert (image.user, image.ids()) == ("grader", (1000, 1001))
    assert (image.workdir, (image.root / "course/inner").is_dir()) == ("/course/inner", True)
    assert (image.entrypoint, image.command) == (("directrix",), ("doctor",))


def test_what_is_set_holds_for_later_steps_only(followed):
    _, ran = followed("FROM debian:12\nRUN first\nENV A=1\nUSER 7:markers\nRUN second")
    assert [(user, environment.get("A")) for _, user, environment in ran] == [("root", None), ("7:markers", "1")]


def test_users_are_those_of_the_image(followed):
    assert followed("FROM debian:12\nUSER 4321")[0].ids() == (4321, 0)
    assert followed("FROM debian:12\nUSER 1000:markers")[0].ids() == (1000, 50)
    with pytest.raises(follow.CannotFollow, match="the image has no user or group nobody"):
        followed("FROM debian:12\nUSER nobody")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (
            "FROM debian:12\n\nHEALTHCHECK NONE",
            "line 3: HEALTHCHECK NONE: HEALTHCHECK is not followed here; what is: FROM",
        ),
        ("FROM debian:12\nRUN a \\\n  b\nADD x /x", "line 4: ADD x /x: ADD is not followed"),
        ("FROM debian:12\nRUN --mount=type=cache,target=/x make", "the option --mount is not followed"),
        ("FROM debian:12\nCOPY --chown=1 one.txt /", "the option --chown is not followed"),
        ("FROM debian:12\nRUN <<END\ntrue\nEND", "here-documents are not followed"),
        ("RUN true", "one FROM, and it comes first"),
        ("FROM debian:12\nFROM debian:12", "one FROM, and it comes first"),
        ("FROM python:3.11-slim", "only debian:NAME can be made"),
        ("FROM debian:unheard", "only debian:NAME can be made"),
        ("FROM debian:12\nENV A", "must be NAME=VALUE"),
        ("FROM debian:12\nENV A=$NEVER", "NEVER is not set by an ENV before it"),
        ("FROM debian:12\nCOPY missing.txt /x", "missing.txt is not in"),
        ("FROM debian:12\nCOPY ../secret /x", "../secret is not in"),
        ("FROM debian:12\nCOPY one.txt two.txt /x", "TARGET must end in /"),
        ('FROM debian:12\nCMD ["a", 1]', "must be a JSON list of strings"),
        ("FROM debian:12\nCMD [a]", "begins like a JSON list"),
        ("FROM debian:12\nRUN a \\", "ends in a backslash"),
        ("# nothing", "no instruction in it"),
    ],
)
def test_what_is_not_understood_is_an_error_that_names_it(followed, context, text, said):
    (context.parent / "secret").write_text("outside")
    with pytest.raises(follow.CannotFollow, match=re.escape(said)):
        followed(text)


def test_a_step_that_fails_ends_it(followed):
    with pytest.raises(follow.CannotFollow, match="line 2: RUN false: ended with 3"):
        followed("FROM debian:12\nRUN false\nRUN true", code=3)


def test_settings_of_this_machine_are_told_and_its_paths_are_not(tmp_path):
    bundle = tmp_path / "bundle.crt"
    bundle.touch()
    settings, shown = follow.told({
        "PIP_CERT": str(bundle), "UV_INDEX_URL": "https://index.example/simple", "HTTPS_PROXY": "http://proxy.example:3128",
        "PIP_TIMEOUT": "60", "PYTHONPATH": "/elsewhere", "API_TOKEN": "secret",
    })  # fmt: skip
    assert settings == {
        "PIP_CERT": "/run/machine/0", "UV_INDEX_URL": "https://index.example/simple", "PIP_TIMEOUT": "60",
        "HTTPS_PROXY": "http://proxy.example:3128",
    }  # fmt: skip
    assert shown == [(str(bundle), "/run/machine/0")]


def test_ours_can_be_followed_and_its_user_is_ordinary():
    instructions = follow.parse((follow.TOP / "Containerfile").read_text("utf-8"))
    assert follow.suite(instructions[0]) == "bookworm"
    last = {instruction.name: instruction.rest for instruction in instructions}
    assert (last["USER"], last["WORKDIR"], last["ENTRYPOINT"]) == ("grader", "/course", '["directrix"]')
    copied = [word for one in instructions if one.name == "COPY" for word in one.words()[:-1]]
    assert copied
    assert [name for name in copied if not (follow.TOP / name).exists()] == []


def test_the_options_are_the_same_in_the_docs_and_in_what_doctor_advises():
    page = (follow.TOP / "docs" / "container.md").read_text("utf-8")
    options = set(re.findall(r"--security-opt [\w=]+", doctor.IN_CONTAINERS))
    assert len(options) == 4
    assert options <= set(re.findall(r"--security-opt [\w=]+", page))
    assert Path(follow.__file__).relative_to(follow.TOP).as_posix() in page
