"""What the documents refer to exists: links, equations, sections, sources, pinned versions."""

from __future__ import annotations

import re
import tomllib
import unicodedata
from pathlib import Path

import pytest
from tests.documents.tables import PLACE, TABLES, written_anew

ROOT = Path(__file__).parents[2]
DOCUMENTS = [ROOT / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")] + sorted(
    (ROOT / "docs").glob("*.md")
)
SOURCES = sorted((ROOT / "src").rglob("*.py"))
THEORY = (ROOT / "docs" / "theory.md").read_text(encoding="utf-8")
BIBLIOGRAPHY = (ROOT / "docs" / "refs.bib").read_text(encoding="utf-8")
EXECUTED = {"python", "toml", "console"}
KEY = r"\[([a-z]+\d{4})\]"


def text_of(path: Path) -> str:
    return path.read_text(encoding="utf-8")


def prose_of(path: Path) -> str:
    """Return a document without its code blocks."""
    return re.sub(r"^```.*?^```", "", text_of(path), flags=re.DOTALL | re.MULTILINE)


def test_the_tables_of_parts_are_as_the_parts_say() -> None:
    pages = [path for path in DOCUMENTS if written_anew(text_of(path)) != text_of(path)]
    assert not pages, f"`make tables` writes them anew: {', '.join(path.name for path in pages)}"
    assert sorted(name for path in DOCUMENTS for _, name, _ in PLACE.findall(text_of(path))) == sorted(TABLES)


def anchors_of(path: Path) -> set[str]:
    """Return the anchors of a document's headings, by the rule of the sites that render Markdown."""
    headings = re.findall(r"^#+ (.+)$", prose_of(path), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def entries() -> dict[str, dict[str, str]]:
    """Return the fields of each entry of the bibliography."""
    found = re.findall(r"^@\w+\{(\w+),\n(.*?)^\}", BIBLIOGRAPHY, re.DOTALL | re.MULTILINE)
    return {key: dict(re.findall(r"(\w+) +?= \{(.*)\},", body)) for key, body in found}


def test_each_library_that_trundle_needs_has_its_reason() -> None:
    project = tomllib.loads(text_of(ROOT / "pyproject.toml"))["project"]
    named = [*project["dependencies"], *(name for names in project["optional-dependencies"].values() for name in names)]
    table = text_of(ROOT / "docs" / "conventions.md").partition("## What trundle leans on")[2].lower()
    reasons = " ".join(re.findall(r"^\| ([^|]*) \|", table, re.MULTILINE))
    for name in named:  # `test` takes the extras in, by the name of trundle
        assert name.startswith("trundle[") or re.split(r"[\[<>=;! ]", name)[0].lower() in reasons, name


@pytest.mark.parametrize("path", DOCUMENTS, ids=lambda path: path.name)
def test_each_code_block_has_a_language_that_is_executed_or_is_plain_text(path: Path) -> None:
    fences = re.findall(r"^```(.*)$", text_of(path), re.MULTILINE)
    opening, closing = fences[::2], fences[1::2]
    assert set(opening) <= EXECUTED | {"text"}
    assert closing == [""] * len(opening)


@pytest.mark.parametrize("path", DOCUMENTS, ids=lambda path: path.name)
def test_each_link_within_the_project_leads_somewhere(path: Path) -> None:
    targets = re.findall(r"\]\(([^)]+)\)|^\[[^\]]+\]: (\S+)$", prose_of(path), re.MULTILINE)
    for target in ("".join(pair) for pair in targets):
        if re.match(r"https?:", target):
            continue
        name, _, anchor = target.partition("#")
        file = path.parent / name if name else path
        assert file.exists(), f"{path.name} links to {target}"
        if anchor:
            assert anchor in anchors_of(file), f"{path.name} links to {target}"


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: str(path.relative_to(ROOT / "src")))
def test_each_equation_and_section_that_the_code_cites_is_on_the_theory_page(path: Path) -> None:
    text = text_of(path)
    tags = set(re.findall(r"\\tag\{(T\d[a-z]?)\}", THEORY))
    sections = set(re.findall(r"^## (\d)\.", THEORY, re.MULTILINE))
    assert set(re.findall(r"\bT\d[a-z]?\b", text)) <= tags
    assert set(re.findall(r"theory page, section (\d+)", text)) <= sections


def test_equations_are_numbered_once() -> None:
    tags = re.findall(r"\\tag\{(.*?)\}", THEORY)
    assert len(tags) == len(set(tags))
    assert {"T1", "T2", "T3", "T4", "T5"} <= set(tags)


@pytest.mark.parametrize("path", DOCUMENTS + SOURCES, ids=lambda path: str(path.relative_to(ROOT)))
def test_each_source_cited_is_in_the_bibliography(path: Path) -> None:
    text = prose_of(path) if path.suffix == ".md" else text_of(path)
    assert set(re.findall(KEY, text)) <= entries().keys()


def unaccented(text: str) -> str:
    return "".join(letter for letter in unicodedata.normalize("NFD", text) if not unicodedata.combining(letter))


def test_the_theory_page_lists_the_bibliography_as_it_is() -> None:
    listed = dict(re.findall(rf"^- \*\*{KEY}\*\* (.*)$", THEORY, re.MULTILINE))
    assert listed.keys() == entries().keys()
    for key, fields in entries().items():
        line = listed[key]
        assert key.endswith(fields["year"])
        assert fields["year"] in line
        assert re.sub(r"[{}]", "", fields["title"]) in line
        first = fields["author"].partition(",")[0]
        assert key.startswith(unaccented(first.lower()))
        assert first in line
        for name in {"volume", "pages"} & fields.keys() - ({"volume"} if "series" in fields else set()):
            assert fields[name].replace("--", "–") in line


def test_every_direct_dependency_is_pinned_exactly_and_nothing_says_where_from() -> None:
    lines = text_of(ROOT / "constraints.txt").splitlines()
    pins = [line for line in lines if not line.startswith("#")]
    assert all(re.fullmatch(r"[\w.-]+==[\w.]+( ; \w+ == '\w+')?", pin) for pin in pins)
    names = [re.sub(r"[-_.]+", "-", pin.partition("==")[0]).lower() for pin in pins]
    assert names == sorted(set(names))
    project = tomllib.loads(text_of(ROOT / "pyproject.toml"))
    wanted = list(project["project"]["dependencies"]) + list(project["build-system"]["requires"])
    for extra in project["project"]["optional-dependencies"].values():
        wanted += extra
    direct = {re.sub(r"[-_.]+", "-", re.match(r"[\w.-]+", line)[0]).lower() for line in wanted} - {"trundle"}
    assert direct <= set(names)


def test_no_npm_package_may_or_need_run_a_script_while_it_is_installed() -> None:
    assert "ignore-scripts=true" in text_of(ROOT / "web" / ".npmrc").splitlines()
    assert "hasInstallScript" not in text_of(ROOT / "web" / "package-lock.json")


def test_the_version_stands_in_one_place() -> None:
    version = tomllib.loads(text_of(ROOT / "pyproject.toml"))["project"]["version"]
    holders = [path for path in [*SOURCES, ROOT / "CITATION.cff", ROOT / "README.md"] if version in text_of(path)]
    assert holders == []
    assert f"## [{version}]" in text_of(ROOT / "CHANGELOG.md")
