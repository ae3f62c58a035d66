"""Cells without a number, lines of the wrong length, gaps: a word in the report, or one clear line of refusal."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import trundle as tr

from .test_mistakes import BALL, run, system
from .theirs import only

SYSTEM = system(BALL)
CLEAN = only(run(), "v")


def lines(separator: str = ",", ending: str = "", **changed: Any) -> list[str]:
    """Return a table as the lines of a file."""
    data = CLEAN | changed
    rows = zip(*data.values(), strict=True)
    return [separator.join(data) + ending, *(separator.join(map(str, row)) + ending for row in rows)]


def written(folder: Path, text: list[str], name: str = "theirs.csv") -> Path:
    path = folder / name
    path.write_text("\n".join(text) + "\n")
    return path


@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_a_separator_at_the_end_of_lines_shifts_no_column(tmp_path: Path, separator: str) -> None:
    whole = lines(separator)
    for text in (lines(separator, separator), [whole[0], *(f"{line}{separator}" for line in whole[1:])]):
        checked = tr.check(written(tmp_path, text), SYSTEM)
        assert checked.passed, str(checked)


@pytest.mark.parametrize("word", ["", "NaN", "nan", "null", "--"])
def test_a_cell_without_a_number_leaves_its_row_out_with_a_word(tmp_path: Path, word: str) -> None:
    text = lines()
    cells = text[17].split(",")
    text[17] = ",".join([cells[0], word, *cells[2:]])
    text[40] = ",".join([*text[40].split(",")[:-1], word])
    checked = tr.check(written(tmp_path, text), SYSTEM)
    assert checked.passed
    assert "2 of 200 rows were left out, for want of a number: line 18 (x), line 41 (vz)." in checked.remark
    assert "198 samples" in checked.method


@pytest.mark.parametrize("missing", ["x", "vx"])
def test_arrays_are_counted_by_rows(missing: str) -> None:
    holes = CLEAN[missing].copy()
    holes[[3, 60, 61]] = np.nan
    checked = tr.check(CLEAN | {missing: holes}, SYSTEM)
    assert checked.passed
    assert f"row 4 ({missing}), row 61 ({missing}), row 62 ({missing})." in checked.remark


def test_a_long_gap_is_no_mistake() -> None:
    for keep in (np.r_[0:80, 130:200], np.r_[0:5, 60:200], np.r_[0:60, 62:64, 100:200]):
        assert tr.check({name: array[keep] for name, array in CLEAN.items()}, SYSTEM).passed


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (
            lambda text: [*text[:9], "1.0,2.0", *text[10:]],
            "a cell for each of its 7 headings in every line; got '2 in line 10",
        ),
        (lambda text: [*text[:-1], text[-1][:20]], "in line 201"),
        (
            lambda text: [text[0], *(f"{i},{line}" for i, line in enumerate(text[1:]))],
            "got '8 in line 2'. Is a heading",
        ),
        (lambda text: [text[0].replace(",vz", ""), *text[1:]], "got '7 in line 2'. Is a heading missing"),
        (lambda text: [text[0] + ",wx", *text[1:]], "8 headings in every line; got '7 in line 2'"),
        (lambda text: [*text[:6], text[6].replace("0.0", "oops", 1), *text[7:]], "must hold numbers; got \"'oops"),
        (
            lambda text: [*text[:3], "inf," + text[3].partition(",")[2], *text[4:]],
            "`t` must be finite numbers; got 'inf in line 4'",
        ),
        (lambda text: [text[0].replace("vx", "x"), *text[1:]], "must differ from each other; got \"'x' twice\""),
        (
            lambda text: [text[0], *(line.rpartition(",")[0] + "," for line in text[1:])],
            "`vz` must hold a number in most rows",
        ),
        (lambda text: text[:1], "must hold rows of numbers below its headings"),
        (lambda text: text[:9], "12 samples or more"),
        (lambda text: [*text[:30], text[29], *text[30:]], "`time` must ascend"),
    ],
)
def test_what_cannot_be_read_is_refused_by_line_and_column(tmp_path: Path, change: Any, says: str) -> None:
    with pytest.raises(tr.InvalidValueError) as caught:
        tr.check(written(tmp_path, change(lines(z=CLEAN["z"].round(3), t=CLEAN["t"].round(4)))), SYSTEM)
    assert says in str(caught.value)
    assert "\n" not in str(caught.value)


def test_other_columns_may_hold_anything(tmp_path: Path) -> None:
    text = lines()
    noted = [text[0] + ",remark,frame", *(f"{line},{'' if i % 3 else 'good'},nan" for i, line in enumerate(text[1:]))]
    checked = tr.check(written(tmp_path, noted), SYSTEM)
    assert checked.passed
    assert checked.remark == ""


def test_files_of_other_programs(tmp_path: Path) -> None:
    quoted = [",".join(f'"{cell}"' for cell in line.split(",")) for line in lines()]
    assert tr.check(written(tmp_path, quoted), SYSTEM).passed
    path = tmp_path / "wide.txt"
    path.write_text("\r\n".join(line.replace(",", "\t").replace(".", ",") for line in lines()), encoding="utf-16")
    assert tr.check(path, SYSTEM).passed
    commented = [f"{line}  # seen" if i else line for i, line in enumerate(lines())]
    assert tr.check(written(tmp_path, commented), SYSTEM).passed
