"""Follows the Containerfile without a container engine: each step is done in a system that debootstrap makes.

A step gets what a container has: mount, process and IPC namespaces, a root of its own by pivot_root (in a mere chroot, Linux
refuses user namespaces), its own /proc and /dev. It is a container with the options of docs/container.md, that is without
masks over /proc (``--masked`` puts them there) and without a system call filter. Needs root, debootstrap and util-linux.

What this machine's clients are told of mirrors and certificates (variables of pip and uv, proxies, apt's settings) is told to
the steps as well, from outside, and stays out of what they make.

    python tests/container/follow.py                        # follow, then `doctor --level A-` and `demo` as the image's user
    python tests/container/follow.py --run "doctor --json" --keep /somewhere
"""

import argparse
import contextlib
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
SUITES = {"12": "bookworm", "bookworm": "bookworm", "13": "trixie", "trixie": "trixie"}
TOLD = re.compile(r"(PIP|UV)_\w+|(https?|no|all)_proxy|SSL_CERT_(FILE|DIR)|REQUESTS_CA_BUNDLE", re.IGNORECASE)
FIRST_PATH = "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin"
DEVICES = ("null", "zero", "full", "random", "urandom", "tty")
MASKED = ("/proc/kcore", "/proc/keys", "/proc/timer_list", "/proc/sysrq-trigger")  # some of those that engines cover
RUNS = ("doctor --level A-", "demo --dir demo")

# Its arguments: the root, masks, pairs of a path of this machine and its place inside, --, and the command.
ENTER = """
set -e
root=$1; masks=$2; shift 2
mount --rbind "$root" "$root"
mount -t proc proc "$root/proc"
for path in $masks; do [ ! -e "$root$path" ] || mount --bind /dev/null "$root$path"; done
mount -t tmpfs -o mode=755 tmpfs "$root/dev"
for name in DEVICES; do : > "$root/dev/$name"; mount --bind "/dev/$name" "$root/dev/$name"; done
ln -s /proc/self/fd "$root/dev/fd"
mkdir "$root/dev/shm"; mount -t tmpfs -o mode=1777 tmpfs "$root/dev/shm"
mount -t tmpfs -o mode=755 tmpfs "$root/run"
mkdir "$root/run/machine"
while [ "$1" != -- ]; do
    if [ -d "$1" ]; then mkdir -p "$root$2"; else : > "$root$2"; fi
    mount --bind "$1" "$root$2"
    shift 2
done
shift
cd "$root"
pivot_root . .
umount -l .
exec "$@"
""".replace("DEVICES", " ".join(DEVICES))


class CannotFollow(Exception):
    """A Containerfile that says what is not understood here, or a step that failed."""


@dataclass(frozen=True)
class Instruction:
    """One instruction with the line it begins in."""

    line: int
    name: str
    rest: str

    def cannot(self, why):
        return CannotFollow(f"line {self.line}: {self.name} {self.rest}: {why}")

    def words(self):
        """The words of an instruction that takes no options here."""
        words = shlex.split(self.rest)
        if words and words[0].startswith("--"):
            raise self.cannot(f"the option {words[0].partition('=')[0]} is not followed here; leave it out or teach {__file__}")
        return words

    def command(self):
        """The JSON form as it stands, the other one by a shell."""
        if self.rest.startswith("["):
            try:
                words = json.loads(self.rest)
            except ValueError as error:
                raise self.cannot(f"begins like a JSON list and is none: {error}") from None
            if not words or not all(isinstance(word, str) for word in words):
                raise self.cannot("must be a JSON list of strings")
            return words
        return ["/bin/sh", "-c", self.rest]


@dataclass
class Image:
    """What has been made so far, and how it is to be run."""

    root: Path
    environment: dict[str, str] = field(default_factory=lambda: {"PATH": FIRST_PATH})
    user: str = "root"
    workdir: str = "/"
    entrypoint: tuple[str, ...] = ()
    command: tuple[str, ...] = ()

    def inside(self, path):
        """Where a path of the image lies on this machine; relative ones begin at its WORKDIR."""
        return self.root / os.path.normpath(os.path.join(self.workdir, path)).lstrip("/")

    def ids(self):
        """uid, gid and groups of its user, by the image's own tables."""
        name, _, group = self.user.partition(":")
        rows = [line.split(":") for line in (self.root / "etc/passwd").read_text().splitlines()]
        uid, gid = next((row[2:4] for row in rows if name in (row[0], row[2])), (name, "0"))
        if group:
            tables = [line.split(":") for line in (self.root / "etc/group").read_text().splitlines()]
            gid = next((row[2] for row in tables if group in (row[0], row[2])), group)
        if not (uid.isdigit() and gid.isdigit()):
            raise CannotFollow(f"the image has no user or group {self.user}")
        return int(uid), int(gid)


def parse(text):
    """The instructions of a Containerfile: lines that end in a backslash go on, comments and empty lines are left out.

    Raises
    ------
    CannotFollow
        For an instruction that this follower does not know, a here-document, or a file that does not begin with FROM.
    """
    found, begun, parts = [], 0, []
    for number, line in enumerate(text.splitlines(), 1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        begun = begun if parts else number
        more = line.rstrip().endswith("\\")
        parts.append(line.rstrip().removesuffix("\\").strip())
        if more:
            continue
        name, _, rest = " ".join(parts).partition(" ")
        instruction, parts = Instruction(begun, name.upper(), rest.strip()), []
        if instruction.name not in KNOWN:
            raise instruction.cannot(f"{instruction.name} is not followed here; what is: {', '.join(KNOWN)}")
        if "<<" in instruction.rest:
            raise instruction.cannot("here-documents are not followed here")
        if (instruction.name == "FROM") == bool(found):
            raise instruction.cannot("there must be one FROM, and it comes first")
        found.append(instruction)
    if parts:
        raise CannotFollow(f"line {begun}: ends in a backslash, and nothing follows")
    if not found:
        raise CannotFollow("no instruction in it")
    return found


def suite(instruction):
    """Debian's name of the release that FROM asks for."""
    named = re.fullmatch(r"debian:(\w+)(?:-slim)?", instruction.rest)
    if named is None or named[1] not in SUITES:
        raise instruction.cannot(f"only debian:NAME can be made with debootstrap, NAME one of {', '.join(SUITES)}")
    return SUITES[named[1]]


def substituted(instruction, text, environment):
    """``$NAME`` and ``${NAME}`` by their values; one that was never set is an error, though an engine takes it as empty."""

    def value(match):
        name = match[1] or match[2]
        if name not in environment:
            raise instruction.cannot(f"${name} is not set by an ENV before it")
        return environment[name]

    return re.sub(r"\$(?:(\w+)|\{(\w+)\})", value, text)


def _env(instruction, image, context, execute):
    pairs = [word.partition("=") for word in instruction.words()]
    if not pairs or not all(equals and name for name, equals, _ in pairs):
        raise instruction.cannot("must be NAME=VALUE ...")
    image.environment |= {name: substituted(instruction, value, image.environment) for name, _, value in pairs}


def _copy(instruction, image, context, execute):
    *sources, target = words = instruction.words()
    if len(words) < 2 or (len(sources) > 1 and not target.endswith("/")):
        raise instruction.cannot("must be SOURCE ... TARGET, and TARGET must end in / where there are several")
    for source in sources:
        path = (context / source).resolve()
        if not path.is_relative_to(context.resolve()) or not path.exists():
            raise instruction.cannot(f"{source} is not in {context}")
        place = image.inside(target)
        if path.is_dir():
            shutil.copytree(path, place, symlinks=True, dirs_exist_ok=True)
        else:
            place = place / path.name if target.endswith("/") else place
            place.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(path, place)


def _run(instruction, image, context, execute):
    if instruction.rest.startswith("--"):
        instruction.words()
    code = execute(image, instruction.command())
    if code:
        raise instruction.cannot(f"ended with {code}")


def _user(instruction, image, context, execute):
    image.user = substituted(instruction, instruction.rest, image.environment)
    image.ids()


def _workdir(instruction, image, context, execute):
    image.inside(instruction.rest).mkdir(parents=True, exist_ok=True)
    image.workdir = os.path.normpath(os.path.join(image.workdir, instruction.rest))


def _entrypoint(instruction, image, context, execute):
    image.entrypoint, image.command = tuple(instruction.command()), ()


def _cmd(instruction, image, context, execute):
    image.command = tuple(instruction.command())


def _from(instruction, image, context, execute):
    suite(instruction)


KNOWN = {
    "FROM": _from, "RUN": _run, "COPY": _copy, "ENV": _env, "USER": _user, "WORKDIR": _workdir,
    "ENTRYPOINT": _entrypoint, "CMD": _cmd,
}  # fmt: skip


def follow(instructions, context, root, execute):
    """Do what the instructions say in ``root``, which holds what FROM names; ``execute(image, command)`` gives an exit code."""
    image = Image(Path(root))
    for instruction in instructions:
        KNOWN[instruction.name](instruction, image, Path(context), execute)
    return image


# ---- on this machine


def told(environment):
    """This machine's settings for package clients, paths in them below /run/machine; and what is shown at each of these."""
    settings, shown = {}, []
    for name, value in environment.items():
        if TOLD.fullmatch(name):
            if os.path.isabs(value) and os.path.exists(value):
                shown.append((value, f"/run/machine/{len(shown)}"))
                value = shown[-1][1]
            settings[name] = value
    return settings, shown


class Steps:
    """Runs commands in an image as a container engine would."""

    def __init__(self, scratch, masked=False):
        self.masked = masked
        self.machine, self.shown = told(os.environ)
        acquire = subprocess.run(["apt-config", "dump", "Acquire"], capture_output=True, text=True, check=True).stdout
        apt = Path(scratch, "apt.conf")
        apt.write_text("".join(line + "\n" for line in acquire.splitlines() if not line.endswith('"";')))
        self.shown += [(str(apt), "/run/machine/apt.conf"), ("/etc/resolv.conf", "/run/machine/resolv.conf")]
        self.machine["APT_CONFIG"] = "/run/machine/apt.conf"

    def build(self, image, command):
        """A step of the Containerfile: it may reach this machine's mirrors."""
        print(f"+ {shlex.join(command)}", flush=True)
        resolver = [("/etc/resolv.conf", "/etc/resolv.conf")]
        return self._in(image, command, image.environment | self.machine, [*self.shown, *resolver])

    def run(self, image, command, course):
        """The finished image, with a course folder mounted where it works."""
        print(f"\n$ {shlex.join(command)}", flush=True)
        return self._in(image, command, image.environment, [(str(course), image.workdir)], self.masked)

    def _in(self, image, command, environment, shown, masked=False):
        uid, gid = image.ids()
        namespaces = ["unshare", "--mount", "--pid", "--ipc", "--fork", "--kill-child", "--propagation", "private"]
        paths = [path for pair in shown for path in pair]
        become = ["setpriv", f"--reuid={uid}", f"--regid={gid}", "--init-groups" if uid == 0 else "--clear-groups"]
        variables = [f"{name}={value}" for name, value in {"HOME": "/root", **environment}.items()]
        inside = ["/bin/sh", "-c", 'cd "$1"; shift; exec "$@"', "sh", image.workdir, "env", "-i", *variables, *become, *command]
        enter = ["sh", "-c", ENTER, "sh", str(image.root), " ".join(MASKED) if masked else "", *paths, "--", *inside]
        return subprocess.run([*namespaces, *enter], check=False, stdin=subprocess.DEVNULL).returncode


def mirror(name):
    """Where this machine's apt gets that release from; empty: debootstrap's own choice."""
    command = ["apt-get", "indextargets", "--format", "$(REPO_URI) $(RELEASE) $(COMPONENT)", "Created-By: Packages"]
    rows = [row.split() for row in subprocess.run(command, capture_output=True, text=True, check=False).stdout.splitlines()]
    return next((uri for uri, release, component in rows if (release, component) == (name, "main")), "")


def bootstrapped(name, root, base):
    """A system of that release in ``root``; a copy of ``base``, where that is one that debootstrap has made before."""
    if base is not None:
        subprocess.run(["cp", "-a", f"{base}/.", root], check=True)
        return
    command = ["debootstrap", "--variant=minbase", name, str(root), *filter(None, [mirror(name)])]
    print(f"+ {shlex.join(command)}", flush=True)
    if subprocess.run(command, stdout=subprocess.DEVNULL, check=False).returncode:
        raise CannotFollow("debootstrap failed; its log is debootstrap/debootstrap.log in that folder")


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", nargs="?", type=Path, default=TOP / "Containerfile")
    parser.add_argument("--run", action="append", help=f"what to run in it afterwards; default: {', then '.join(RUNS)}")
    parser.add_argument("--keep", type=Path, help="an empty folder for the system, which then stays")
    parser.add_argument("--base", type=Path, help="a folder that debootstrap has made, to begin with a copy of it")
    parser.add_argument("--masked", action="store_true", help="cover parts of /proc while running, as engines do by default")
    options = parser.parse_args(arguments)
    missing = [name for name in ("debootstrap", "unshare", "pivot_root", "apt-config") if shutil.which(name) is None]
    if missing or os.geteuid() != 0:
        print(
            f"this needs root and, as programs: {', '.join(missing) or 'nothing more'} (apt-get install debootstrap util-linux)"
        )
        return 2
    with contextlib.ExitStack() as stack:
        scratch = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="directrix-container-")))
        root = options.keep or scratch / "root"
        root.mkdir(parents=True, exist_ok=True)
        course = scratch / "course"
        course.mkdir()
        began = time.monotonic()
        try:
            instructions = parse(options.file.read_text("utf-8"))
            bootstrapped(suite(instructions[0]), root, options.base)
            steps = Steps(scratch, options.masked)
            image = follow(instructions, options.file.resolve().parent, root, steps.build)
            seconds = time.monotonic() - began
            print(f"\nfollowed {len(instructions)} instructions in {seconds:.0f} s; user {image.user} {image.ids()}")
            os.chown(course, *image.ids())
            for words in options.run or RUNS:
                code = steps.run(image, [*image.entrypoint, *shlex.split(words)], course)
                if code:
                    raise CannotFollow(f"{shlex.join(image.entrypoint)} {words} ended with {code}")
        except CannotFollow as error:
            print(f"{options.file.name}: {error}", file=sys.stderr)
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
