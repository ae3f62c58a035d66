"""What `pip install trundle` alone brings: how much that is, what it is enough for, and what names an extra."""

from __future__ import annotations

import pickle
import subprocess
import sys
import tomllib
from collections.abc import Callable, Iterable
from importlib import metadata
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from trundle.errors import MissingExtraError
from trundle.extras import MODULES

PROJECT = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text(encoding="utf-8"))["project"]
EXTRAS = PROJECT["optional-dependencies"]
MOST_PACKAGES = 40  # that one installation brings, trundle among them
NAME = "level-turntable-nudged"

# In a process of its own: what belongs to no package of the core is not there to be found.
BARE = """
import sys

class Without:
    def __init__(self, finder):
        self.finder = finder

    def find_spec(self, name, path=None, target=None):
        return None if name.partition(".")[0] in {absent} else self.finder.find_spec(name, path, target)

    def __getattr__(self, name):
        return getattr(self.finder, name)

sys.meta_path[:] = [Without(finder) for finder in sys.meta_path]
"""
COMMAND = "from trundle.cli import main; main(sys.argv[1:])"

Bare = Callable[..., "subprocess.CompletedProcess[str]"]


def named(requirements: Iterable[str]) -> set[str]:
    return {canonicalize_name(Requirement(text).name) for text in requirements}


def brought(requirements: Iterable[str]) -> set[str]:
    """Return what these bring on this machine: themselves, what they need, and so on."""
    waiting = [(Requirement(text), "") for text in requirements]
    seen = set()
    while waiting:
        wanted, extra = waiting.pop()
        if wanted.marker is not None and not wanted.marker.evaluate({"extra": extra}):
            continue
        name = canonicalize_name(wanted.name)
        for extra in {"", *wanted.extras} - {extra for other, extra in seen if other == name}:
            seen.add((name, extra))
            waiting += [(Requirement(text), extra) for text in metadata.requires(name) or []]
    return {name for name, _ in seen}


@pytest.fixture(scope="module")
def absent() -> set[str]:
    """The modules that are installed here and would not be after `pip install trundle`."""
    core = {"trundle", *brought(PROJECT["dependencies"])}
    homes = metadata.packages_distributions().items()
    return {module for module, names in homes if not core & set(map(canonicalize_name, names))} - {"trundle"}


@pytest.fixture
def bare(absent: set[str], tmp_path: Path) -> Bare:
    """Python without them, in an empty folder."""

    def call(code: str, *words: str) -> subprocess.CompletedProcess[str]:
        words = (sys.executable, "-c", BARE.replace("{absent}", repr(absent)) + code, *words)
        return subprocess.run(words, cwd=tmp_path, capture_output=True, encoding="utf-8", timeout=120, check=False)  # noqa: S603

    return call


def test_the_core_is_light() -> None:
    core = {"trundle", *brought(PROJECT["dependencies"])}
    assert len(core) <= MOST_PACKAGES, sorted(core)
    assert not named(PROJECT["dependencies"]) & named([*EXTRAS["lab"], *EXTRAS["notebook"], *EXTRAS["parquet"]])


def test_each_extra_is_looked_for_by_all_that_it_brings(absent: set[str]) -> None:
    homes = metadata.packages_distributions()  # what is imported may have another name than what is installed
    looked_for = {extra: [homes.get(name, [name])[0] for name in modules] for extra, modules in MODULES.items()}
    assert {extra: named(packages) for extra, packages in looked_for.items()} == {
        extra: named(EXTRAS[extra]) for extra in EXTRAS.keys() - {"test", "bench"}
    }
    assert {*MODULES["lab"], *MODULES["notebook"]} <= absent  # or the tests below would show nothing


def test_the_core_does_what_it_says(bare: Bare, tmp_path: Path) -> None:
    done = bare(COMMAND, "list")
    assert (done.returncode, done.stderr) == (0, "")
    assert NAME in done.stdout
    for words in (["--help"], ["lab", "--help"], ["run", NAME, "-q"], ["export", f"{NAME}/run.nc", "scene.html", "-q"]):
        done = bare(COMMAND, *words)
        assert (done.returncode, done.stderr) == (0, ""), words
    made = {path.relative_to(tmp_path).as_posix() for path in tmp_path.rglob("*.*")}
    assert made == {f"{NAME}/run.nc", f"{NAME}/path.png", f"{NAME}/series.png", "scene.html"}


def test_every_public_name_is_there(bare: Bare) -> None:
    done = bare("import trundle; print(len([getattr(trundle, name) for name in trundle.__all__]) > 50)")
    assert (done.stdout, done.stderr) == ("True\n", "")


@pytest.mark.parametrize(
    ("words", "asked", "extra"),
    [
        (["lab"], "trundle lab", "lab"),
        (["lab", "--no-open", NAME], "trundle lab", "lab"),
        (["export", NAME, "scene.glb"], "scene.glb", "lab"),
        (["export", NAME, "scene.GLB"], "scene.GLB", "lab"),
        (["check", "theirs.parquet", "--scenario", NAME], "theirs.parquet", "parquet"),
    ],
)
def test_the_command_names_the_extra(bare: Bare, tmp_path: Path, words: list[str], asked: str, extra: str) -> None:
    (tmp_path / "theirs.parquet").write_bytes(b"PAR1")
    done = bare(COMMAND, *words)
    assert (done.returncode, done.stdout) == (2, "")
    (line,) = done.stderr.splitlines()
    assert line.startswith(f"trundle: `{asked}` needs the extra `{extra}`, which is not installed here: ")
    assert f"pip install 'trundle[{extra}]'." in line
    assert [path.name for path in tmp_path.iterdir()] == ["theirs.parquet"]


@pytest.mark.parametrize(
    ("call", "asked", "extra"),
    [
        ("run().view()", "view", "notebook"),
        ("run().save_glb('scene.glb')", ".glb", "lab"),
        ("tr.check('theirs.parquet', run().system)", "theirs.parquet", "parquet"),
        ("__import__('trundle.lab').lab.create_app()", "trundle.lab.create_app", "lab"),
    ],
)
def test_python_names_the_extra(bare: Bare, tmp_path: Path, call: str, asked: str, extra: str) -> None:
    (tmp_path / "theirs.parquet").write_bytes(b"PAR1")
    code = f"""
import trundle as tr
run = tr.Scenario.load({NAME!r}).run
run().save_html("scene.html")
try:
    {call}
except tr.MissingExtraError as error:
    print((error.asked, error.extra))
"""
    done = bare(code)
    assert (done.stdout, done.stderr) == (f"{(asked, extra)}\n", "")
    assert {path.name for path in tmp_path.iterdir()} == {"theirs.parquet", "scene.html"}


def test_the_error_is_the_package_s_and_goes_from_process_to_process() -> None:
    error = MissingExtraError("view", "notebook", "`save_html` needs nothing more.")
    again = pickle.loads(pickle.dumps(error))  # noqa: S301
    assert (str(again), again.extra) == (str(error), "notebook")
    assert isinstance(error, ImportError)
