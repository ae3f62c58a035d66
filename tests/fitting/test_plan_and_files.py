"""What a plan promises, what files hold, what emcee draws."""

from __future__ import annotations

import html
import re
from dataclasses import replace
from itertools import chain, product

import numpy as np
import pytest
import xarray
from tests.fitting.coverage import CASES, chances, distances
from tests.fitting.measured import ball, on_turntable, scenario, seen, turntable

import trundle as tr
from trundle.analysis.fit import report
from trundle.analysis.fit.observations import COLUMNS, unit_of
from trundle.analysis.fit.sampling import Samples
from trundle.analysis.fit.undetermined import pm

K, RATE = "body.inertia_ratio", "support.motion.rate"
T = np.arange(300) / 30.0
TABLE = scenario(body=ball(0.4), support=turntable(3.487), start={"position": [0.1, 0.0], "velocity": [0.0, 0.15]})


@pytest.fixture(scope="module")
def fitted() -> tr.Fit:
    return tr.fit(seen(T, 5e-4, 1, z=on_turntable(T, 3.487)), TABLE, [K, RATE], noise="0.5 mm")


def test_a_plan_promises_what_a_fit_then_has() -> None:
    found = tr.fit(seen(T, 5e-4, 2, z=on_turntable(T, 3.487)), TABLE, [K], noise="0.5 mm")
    plan = tr.plan_fit(TABLE, K, durations=[T[-1]], rates=[30], noises=["0.5 mm"])
    assert plan.sigma[0, 0, 0, 0] == pytest.approx(found[K].sigma, rel=0.02)


def test_a_circle_alone_is_as_well_known_as_its_phase() -> None:
    # Of z = z0 + R e^{iκt} the rate has the textbook error of a phase against time, wider for what else is free:
    # at most σ √(24/N)/(R T) over many rounds (Rife and Boorstyn 1974: √12 for x and y each of half the noise power).
    duration, noise, rate = 600.0, 1e-3, 30.0
    plan = tr.plan_fit(TABLE, RATE, durations=[duration], rates=[rate], noises=[noise])
    radius, count = 0.15 / (3.487 * 2 / 7), duration * rate
    kappa = noise * np.sqrt(12 / count) / (radius * duration)
    assert plan.sigma[0, 0, 0, 0] == pytest.approx(kappa * 7 / 2, rel=0.05)


def test_a_plan_says_what_no_length_of_film_shows() -> None:
    plan = tr.plan_fit(TABLE, [K, RATE], durations=[10.0], rates=[30], noises=[5e-4])
    assert np.isnan(plan.sigma).all()
    assert f"{RATE}·{K}/(1 + {K})" in str(plan)
    marked = tr.plan_fit(TABLE, [K, RATE], durations=[10.0], rates=[30], noises=[5e-4],
                         observed=("x", "y", "wx", "wy"))  # fmt: skip
    assert np.isfinite(marked.sigma).all()


def test_a_plan_refuses_what_cannot_be() -> None:
    for given, says in (
        ({"durations": [-1.0]}, "`durations` must be positive"),
        ({"rates": []}, "a length, a rate and a noise"),
        ({"observed": ("u",)}, "unknown column"),
        ({"durations": [1e5], "rates": [60]}, "at most"),
        ({"start": "here"}, "unknown start"),
    ):
        with pytest.raises(tr.TrundleError, match=says):
            tr.plan_fit(TABLE, K, **given)


def test_a_file_holds_data_fit_and_covariance(fitted: tr.Fit, tmp_path) -> None:
    path = fitted.save(tmp_path / "fit.nc")
    with xarray.open_dataset(path, engine="h5netcdf") as kept:
        assert kept.measured.dims == ("row", "column")
        assert np.allclose(kept.measured - kept.fitted, kept.residual)
        assert kept.covariance.dims == ("parameter", "parameter_2")
        assert np.isnan(kept.sigma.sel(parameter=K))
        assert float(kept.sigma.sel(parameter="start.velocity[1]")) > 0
        assert "do not tell" in kept.attrs["undetermined"]
        tr.Scenario.loads(kept.attrs["scenario"]).run()


def test_a_file_names_the_unit_of_each_value(fitted: tr.Fit, tmp_path) -> None:
    with xarray.open_dataset(fitted.save(tmp_path / "fit.nc"), engine="h5netcdf") as kept:
        assert [str(kept.measured.sel(column=name).column_unit.item()) for name in "xy"] == ["m", "m"]
        assert kept.value.sel(parameter=K).unit.item() == "1"
        assert kept.covariance.sel(parameter=K, parameter_2="start.velocity[1]").unit_2.item() == "m/s"
        for variable in kept.data_vars.values():
            for named in variable.attrs["units"].removeprefix("see ").split(",")[0].split(" and "):
                assert set(kept[named].dims) <= set(variable.dims)


def test_the_unit_of_each_column_is_that_of_its_kind() -> None:
    wanted = {"m": "x y z mark_x mark_y spot_x spot_y spot_z", "m/s": "vx vy vz", "rad": "angle"}
    wanted["rad/s"] = "wx wy wz gyro_x gyro_y gyro_z"
    assert {name: unit_of(name) for name in COLUMNS} == {n: unit for unit, all_ in wanted.items() for n in all_.split()}


def test_no_table_or_figure_shows_a_zero_with_a_minus(fitted: tr.Fit) -> None:
    size = len(fitted.values)
    tiny = tuple(
        replace(one, value=-0.0 if one.sigma is None else -1e-12, sigma=one.sigma and 1.0) for one in fitted.estimates
    )
    told = replace(fitted, estimates=tiny, covariance=np.eye(size) - 1e-9 * (1 - np.eye(size)))
    shown = [told.table(), told.table("latex"), *chain(*report.correlation_cells(told)[0])]
    shown += [text.get_text() for panel in told.plot().axes for text in panel.texts]
    assert not re.findall(r"[-−]0(?:\.0+)?(?![.\d])", "\n".join(shown))


@pytest.mark.parametrize(("value", "sigma"), [*product((-1e-12, -3e-7, -0.0, -1e5), (0.0, 2e-9, 0.02, 3.0, 2e7))])
def test_a_value_that_rounds_to_zero_has_no_sign(value: float, sigma: float) -> None:
    shown = pm(value, sigma).split(" ")[0].strip("(")
    assert shown[0] != "-" or float(shown) != 0


def test_each_form_of_table_has_each_number(fitted: tr.Fit) -> None:
    for form in ("text", "markdown", "latex", "csv"):
        told = fitted.table(form)
        for one in fitted.estimates:
            assert one.name.replace("_", r"\_" if form == "latex" else "_") in told
    assert "nan" not in str(fitted) + fitted.table("csv")
    with pytest.raises(tr.UnknownNameError):
        fitted.table("word")


def test_a_figure_and_a_page_of_its_own(fitted: tr.Fit, tmp_path) -> None:
    figure = fitted.plot()
    path, correlations, residuals = figure.axes
    assert path.get_aspect() == 1.0
    assert (path.get_xlabel(), residuals.get_ylabel()) == ("x, m", "residual, σ")
    assert correlations.get_title() == "correlation"
    text = fitted.save_html(tmp_path / "fit.html").read_text(encoding="utf-8")
    assert "data:image/png;base64," in text
    assert "<script" not in text
    assert html.unescape(text).count(fitted.to_toml().rstrip()) == 1


def test_emcee_draws_what_least_squares_say() -> None:
    t = T[::10]
    found = tr.fit(seen(t, 5e-4, 3, z=on_turntable(t, 3.487)), TABLE, [K], noise="0.5 mm")
    draws = found.sample(steps=100, walkers=12, seed=1)
    spread = draws.draws[:, 0].std()
    assert spread == pytest.approx(found[K].sigma, rel=0.35)
    assert abs(np.median(draws.draws[:, 0]) - found[K].value) < found[K].sigma
    assert "too short" in draws.verdict


@pytest.mark.parametrize("count", [500, 20000])
def test_draws_say_which_number_is_not_normal(count: int) -> None:
    normal = np.random.default_rng(3).normal(size=(count, 4))
    held, way = np.zeros(count), normal[:, 0]
    draws = np.column_stack([way, np.exp(way), -np.exp(normal[:, 1]), 1 + 1e-3 * normal[:, 2], held])
    names = ("straight", "long above", "long below", "narrow", "held")
    made = Samples("A fit", names, ("",) * 5, draws, 0.4, 1.0, count)
    assert made.lopsided == names[1:3]
    assert "Not normal: long above, long below." in str(made)
    slow = Samples("A fit", names, ("",) * 5, draws, 0.4, count / 10, count)  # ten that are independent tell nothing
    assert slow.lopsided == ()
    assert "were it normal" in str(slow)


def test_errors_are_as_large_as_they_say() -> None:
    case = CASES["incline"]  # `python -m tests.fitting.coverage` does this for each case, with more draws
    squares = distances(case, 40)
    for share, chance in chances(squares, len(case.truth)).values():
        assert chance > 1e-3, share
