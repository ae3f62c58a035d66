"""`trundle equations` and `trundle export NAME FILE.fmu`, as a user types them."""

from __future__ import annotations

import zipfile
from pathlib import Path

import pytest
from tests.cli.conftest import Command


@pytest.mark.parametrize(
    ("form", "said"),
    [
        ("c", "void field_rolling_rates(double t, const double *y, const double *p, const double *u, double *found)"),
        ("python", "def rolling_rates(t, y, p, u):"),
        ("javascript", "export function rolling_rates(t, y, p, u) {"),
        ("jax", "import jax.numpy as jnp"),
        ("latex", r"\begin{align*}"),
    ],
)
def test_each_form_is_printed(here: Command, form: str, said: str) -> None:
    shown = here("equations", "tilted-turntable", "--as", form)
    assert (shown.status, shown.err, shown.files) == (0, "", set())
    assert said in shown.out
    assert ("[2] body.radius (m) = 0.025" in shown.out) == (form != "latex")


def test_a_module_of_python_runs(here: Command) -> None:
    shown = here("equations", "billiard-swerve", "-o", "ball.py")
    assert (shown.status, shown.out, shown.files) == (0, "Wrote ball.py\n", {"ball.py"})
    place: dict[str, object] = {}
    exec(Path("ball.py").read_text(), place)  # noqa: S102
    assert callable(place["slipping_rolling_after_grip"])


def test_c_comes_with_its_header(here: Command) -> None:
    shown = here("equations", "tilted-turntable", "--as", "c", "-o", "1 ball.c", "--inputs", "torque")
    assert shown.status == 0
    assert shown.files == {"1 ball.c", "1 ball.h"}
    assert "void _1_ball_rolling_rates(" in Path("1 ball.h").read_text()
    assert "torque_z" in here("equations", "tilted-turntable", "--inputs", "torque").out


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("tilted-tuntable",), "Did you mean 'tilted-turntable'?"),
        (("tilted-turntable", "--as", "fortran"), "There are: c, python, javascript, latex, jax"),
        (
            ("tilted-turntable", "--phase", "rest"),
            "`--phase` must be one that the system may have: rolling, flight; got 'rest'",
        ),
        (("tilted-turntable", "--phase", "sinking"), "There are: rolling, slipping, flight, rest, held_slipping"),
        (("tilted-turntable", "--inputs", "wind"), "There are: force, torque, support"),
        (("roll-home-turned",), "must have a body that forces act on"),
        (("tilted-turntable", "-o", "."), "must be a file"),
    ],
)
def test_what_is_wrong_is_said_in_a_line(here: Command, words: tuple[str, ...], said: str) -> None:
    shown = here("equations", *words)
    assert (shown.status, shown.out, shown.files) == (2, "", set())
    assert said in shown.err
    assert shown.err.count("\n") == 1


def test_a_unit_of_fmi(here: Command) -> None:
    shown = here("export", "tilted-turntable", "ball.fmu")
    assert shown.status == 0
    assert shown.out.startswith("Wrote ball.fmu (")
    assert "with a binary for" in shown.out or "sources only: no C compiler is found here" in shown.out
    with zipfile.ZipFile("ball.fmu") as held:
        assert "modelDescription.xml" in held.namelist()
    assert here("export", "ball.nc", "ball.fmu").status == 2
    assert "must have a body that forces act on" in here("export", "roll-home-turned", "path.fmu").err
