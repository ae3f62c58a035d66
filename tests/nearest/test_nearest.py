"""The choice of tests for daily work: near ones before far ones, and none for what Python does not run."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from tests.nearest import __main__ as nearest
from tests.nearest.changes import acts_otherwise, changed, git, meaning
from tests.nearest.distance import Distances, file_of, module_of

CONTACT = "src/trundle/mechanics/contact.py"


@pytest.fixture(scope="module")
def distances():
    return Distances()


def test_a_changed_file_of_tests_is_the_nearest_to_itself(distances):
    assert distances.tests({"tests/laws/test_impact.py"}) == [(0, "tests/laws/test_impact.py")]


def test_tests_that_import_a_module_come_before_those_that_need_it_by_others(distances):
    far = {file: distance for distance, file in distances.tests({CONTACT})}
    assert far["tests/laws/test_impact.py"] == 1 < far["tests/cli/test_cli_run.py"]
    assert list(far.values()) == sorted(far.values())


def test_what_a_test_takes_from_the_package_itself_it_imports_from_its_home(distances):
    assert (1, "tests/lab/test_scene_findings.py") in distances.tests({"src/trundle/mechanics/motions/uneven.py"})


def test_modules_are_found_by_their_files_and_files_by_their_modules():
    for file in (CONTACT, "src/trundle/views/scene/__init__.py", "tests/nearest/test_nearest.py"):
        assert file_of(module_of(file)) == Path(file)


def test_docstrings_comments_and_layout_mean_nothing():
    plain = "def f(x):\n    return x"
    for same in (f'"""A module."""\n\n{plain}', "def f(x): return x  # so", 'def f(x):\n    """Say."""\n    return x'):
        assert meaning(same) == meaning(plain)
    assert meaning("def f(x):\n    return -x") != meaning(plain)


@pytest.mark.skipif(shutil.which("git") is None, reason="asks git")
def test_what_has_changed_is_told_from_a_commit_on(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in ("kept.py", "said.py", "done.py"):
        Path(name).write_text('"""It."""\nx = 1\n', encoding="utf-8")
    who = ("-c", "user.name=it", "-c", "user.email=it@example.org")
    for words in (("init", "-q"), ("add", "."), (*who, "commit", "-qm", "First")):
        git(*words)
    Path("said.py").write_text('"""It is."""\nx = 1\n', encoding="utf-8")
    Path("done.py").write_text('"""It."""\nx = 2\n', encoding="utf-8")
    Path("new.py").touch()
    assert changed("HEAD") == ["done.py", "new.py", "said.py"]
    assert [acts_otherwise(file, "HEAD") for file in changed("HEAD")] == [True, True, False]


def test_only_so_many_files_are_chosen_and_the_rest_is_named(monkeypatch):
    monkeypatch.setattr(nearest, "acts_otherwise", lambda *_: True)
    chosen, said = nearest.choice([CONTACT, "web/lab.html"], "HEAD")
    assert chosen[:3] == [CONTACT, "tests/dispatch/test_dispatch.py", "tests/laws/test_impact.py"]
    assert "are left to make test" in said[1]
    assert said[2] == "No test is chosen for web/lab.html: make test."


def test_a_docstring_needs_only_the_examples_of_its_own_file(monkeypatch):
    monkeypatch.setattr(nearest, "acts_otherwise", lambda *_: False)
    assert nearest.choice([CONTACT, "docs/theory.md"], "HEAD")[0] == [CONTACT, "docs/theory.md"]


def test_nothing_is_run_where_nothing_has_changed():
    assert nearest.choice([], "HEAD") == ([], ["Nothing has changed since HEAD: no test to run."])
