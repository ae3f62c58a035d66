"""The page on the lecture: each section asks and answers, and its pictures are those that it says it makes."""

from __future__ import annotations

import re
import struct
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[2] / "docs"
PAGE = (DOCS / "lecture.md").read_text(encoding="utf-8")
NAMED = re.findall(r"!\[[^\]]+\]\(images/([\w-]+)\.png\)", PAGE)
SECTIONS = re.split(r"^## ", PAGE, flags=re.MULTILINE)[1:]
LARGEST = 150_000  # bytes: a page that loads at once
SHARED = {"tilted-turntable": "tilted-turntable-path"}  # the README's picture of the same run, by its older name


def written_by_the_page() -> set[str]:
    """Return the pictures that the page's blocks write: folder/name.png, shown as folder-name."""
    by_commands = re.findall(r"[\w-]+/[\w-]+\.png", " ".join(re.findall(r"^Wrote .*$", PAGE, re.MULTILINE)))
    by_python = re.findall(r"""savefig\("([\w-]+\.png)"\)""", PAGE)
    return {path.removesuffix(".png").replace("/", "-") for path in by_commands + by_python}


def test_the_page_has_pictures_and_each_is_written_by_one_of_its_blocks() -> None:
    assert len(NAMED) == len(set(NAMED)) >= 8
    assert {SHARED.get(name, name) for name in NAMED} <= written_by_the_page()


@pytest.mark.parametrize("name", NAMED)
def test_each_picture_is_there_small_and_large_enough_to_read(name: str) -> None:
    data = (DOCS / "images" / f"{name}.png").read_bytes()
    assert data.startswith(b"\x89PNG\r\n\x1a\n")
    assert len(data) < LARGEST
    width, height = struct.unpack(">II", data[16:24])
    assert min(width, height) >= 600


def test_each_picture_that_is_kept_is_shown_somewhere() -> None:
    shown = "".join(path.read_text(encoding="utf-8") for path in [DOCS.parent / "README.md", *DOCS.glob("*.md")])
    for picture in (DOCS / "images").glob("*.png"):
        assert f"images/{picture.name})" in shown


@pytest.mark.parametrize("section", SECTIONS, ids=lambda section: section.partition("\n")[0])
def test_each_section_ends_with_one_question_that_a_command_answers(section: str) -> None:
    asked = section.split("**Guess first.**")
    assert len(asked) == 2
    question, answer = asked[1].partition("\n\n")[::2]
    assert "?" in question
    assert re.match(r"```console\n(# .*\n)?\$ trundle ", answer)


def test_the_contents_name_every_section_in_order() -> None:
    listed = re.findall(r"^\d+\. \[([^\]]+)\]", PAGE, re.MULTILINE)
    assert listed == [section.partition("\n")[0] for section in SECTIONS]


def test_each_equation_named_is_on_the_page_that_numbers_it() -> None:
    prose = re.sub(r"`[^`]*`", "", PAGE)
    for letter, page in (("T", "theory.md"), ("G", "rolling-as-geometry.md")):
        numbered = set(re.findall(r"\\tag\{(\w+)\}", (DOCS / page).read_text(encoding="utf-8")))
        named = set(re.findall(rf"\b{letter}\d[a-z]?\b", prose))
        assert named
        assert named <= numbered
