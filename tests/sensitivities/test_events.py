"""Derivatives across events, each kind of event by itself and several in a row, against differences of whole runs."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from tests.sensitivities.differences import changed, check

import trundle as tr
from trundle.analysis.sensitivities import following
from trundle.analysis.sensitivities.keys import chosen
from trundle.mechanics.duals import Dual, slopes_of, value_of
from trundle.solve import tracing
from trundle.solve.creeping import CreepingLaw

BALL = {"kind": "solid-sphere", "radius": 0.03, "mass": 0.2}
ELLIPSOID = {"kind": "ellipsoid", "semi_axes": [0.1, 0.07, 0.05], "mass": 0.4}
TURNING = {"kind": "spin", "rate": -2.0}  # clockwise
JERK = {"kind": "move", "position": ["0.25*abs(t - 0.2)", 0, 0]}
DROP = {"position": [0.1, 0.0], "velocity": [1.0, 0.2, -0.5], "angular_velocity": [1.0, -20.0, 3.0], "height": 0.05}
LEANING = {**DROP, "attitude": [0.4, 0.5, 0.3], "angular_velocity": [1.0, -2.0, 3.0], "velocity": [0.4, 0.1, -0.5]}

# Tables, the numbers to differentiate by, the events that come, and the times at which to compare.
EVENTS: dict[str, tuple[dict[str, Any], tuple[str, ...], tuple[str, ...], tuple[float, ...]]] = {
    "a ball grips": (
        {
            "body": BALL,
            "support": {"kind": "plane", "friction": 0.2, "tilt": 0.02},
            "start": {"position": [0, 0], "velocity": [1.0, 0.0], "angular_velocity": [0, 0, 0]},
        },
        ("support.friction", "support.tilt", "start.velocity[0]", "body.radius", "gravity"),
        ("grip",),
        (0.05, 0.14, 0.2, 0.4),
    ),
    "a ball that swerves grips on a clockwise table": (
        {
            "body": BALL,
            "support": {"kind": "plane", "friction": 0.2, "tilt": -0.02, "motion": TURNING},
            "start": {"position": [0.1, 0], "velocity": [0.5, 0.3], "angular_velocity": [-20.0, 5.0, 3.0]},
        },
        ("support.friction", "support.tilt", "support.motion.rate", "start.velocity[1]", "start.angular_velocity[0]"),
        ("grip",),
        (0.05, 0.2, 0.4, 0.6),
    ),
    "a ball begins to slip on a dome, and comes off": (
        {
            "body": BALL,
            "support": {"kind": "dome", "radius": 0.5, "friction": 0.5},
            "start": {"position": [0.1, 0.02], "velocity": [0.8, 0.1]},
        },
        ("support.friction", "support.radius", "body.radius", "start.velocity[0]", "start.position[1]", "gravity"),
        ("slip", "lift"),
        (0.1, 0.2, 0.25, 0.3),
    ),
    "a ball begins to slip on a dome in wind": (
        {
            "body": BALL,
            "support": {"kind": "dome", "radius": 0.5, "friction": 0.5},
            "loads": [{"kind": "quadratic-drag", "coefficient": 0.05}],
            "start": {"position": [0.1, 0.02], "velocity": [0.8, 0.1]},
        },
        ("loads[0].coefficient", "start.velocity[0]", "start.position[1]", "body.mass"),
        ("slip",),
        (0.1, 0.2, 0.25),
    ),
    "a ball begins to slip with less friction than it held by": (
        {
            "body": BALL,
            "support": {"kind": "dome", "radius": 0.5, "friction": 0.5, "kinetic_friction": 0.4},
            "start": {"position": [0.1, 0.02], "velocity": [0.8, 0.1]},
        },
        ("support.friction", "support.kinetic_friction", "start.velocity[0]"),
        ("slip", "lift"),
        (0.1, 0.2, 0.25, 0.3),
    ),
    "a ball slips from rest": (
        {
            "body": BALL,
            "support": {"kind": "plane", "friction": 0.1, "tilt": 0.6},
            "start": {"position": [0, 0], "velocity": [0, 0]},
        },
        ("support.friction", "support.tilt", "gravity", "body.radius"),
        (),
        (0.1, 0.3),
    ),
    "a ball bounces and slips": (
        {"body": BALL, "support": {"kind": "plane", "tilt": 0.0, "friction": 0.15, "restitution": 0.6}, "start": DROP},
        ("support.friction", "support.restitution", "support.tilt", "start.height", "start.velocity", "body.radius"),
        ("land", "land", "land"),
        (0.03, 0.1, 0.2, 0.28),
    ),
    "a ball bounces and holds": (
        {
            "body": BALL,
            "support": {
                "kind": "plane",
                "tilt": 0.02,
                "restitution": 0.7,
                "tangential_restitution": 0.4,
                "motion": TURNING,
            },
            "start": DROP,
        },
        ("support.restitution", "support.tangential_restitution", "support.tilt", "support.motion.rate", "body.mass"),
        ("land", "land"),
        (0.03, 0.1, 0.2, 0.3),
    ),
    "a ball that comes straight down bounces on what is level": (
        {
            "body": BALL,
            "support": {"kind": "plane", "friction": 0.3, "restitution": 0.6, "tilt": 0.0},
            "start": {"position": [0.1, 0.0], "velocity": [0, 0], "height": 0.05},
        },
        ("start.height", "support.restitution"),
        ("land", "land", "land"),
        (0.05, 0.15, 0.3),
    ),
    "a ball lands in a bowl, slips and grips": (
        {
            "body": BALL,
            "support": {"kind": "bowl", "radius": 0.4, "friction": 0.2, "restitution": 0.0},
            "start": {
                "position": [0.05, 0.02],
                "velocity": [0.3, 0.1, -0.4],
                "angular_velocity": [0, -40, 5],
                "height": 0.03,
            },
        },
        ("support.friction", "support.radius", "start.height", "start.velocity[0]", "body.radius"),
        ("land", "grip"),
        (0.02, 0.06, 0.1, 0.3),
    ),
    "an ellipsoid lands, its slip turning on the way": (
        {"body": ELLIPSOID, "support": {"kind": "plane", "friction": 0.2, "restitution": 0.5}, "start": LEANING},
        ("support.friction", "support.restitution", "body.semi_axes[0]", "start.attitude[1]", "start.velocity[1]"),
        ("land", "land"),
        (0.02, 0.08, 0.12),
    ),
    "an ellipsoid lands straight, and friction cannot hold it": (
        {
            "body": ELLIPSOID,
            "support": {"kind": "plane", "friction": 0.05, "restitution": 0.4},
            "start": {"position": [0, 0], "velocity": [0, 0], "height": 0.05, "attitude": [0.4, 0.5, 0.3]},
        },
        ("support.friction", "support.restitution", "start.attitude[1]", "body.mass", "gravity"),
        ("land",),
        (0.05, 0.11, 0.13),
    ),
    "an ellipsoid lands and sticks": (
        {"body": ELLIPSOID, "support": {"kind": "plane", "restitution": 0.5}, "start": LEANING},
        ("support.restitution", "body.semi_axes[0]", "start.attitude[1]", "start.velocity[1]", "start.height"),
        ("land", "land"),
        (0.02, 0.08, 0.12),
    ),
    "a ball bounces about in an uneven bowl": (
        {
            "body": BALL,
            "support": {"kind": "ellipsoidal-bowl", "semi_axes": [0.24, 0.43, 0.18], "restitution": 0.5},
            "start": {"position": [0.02, -0.1], "velocity": [0.4, 0.1, -0.2], "height": 0.03},
        },
        ("support.semi_axes[2]", "start.velocity[1]", "support.restitution", "gravity"),
        ("land", "land", "land"),
        (0.03, 0.1, 0.16, 0.2),
    ),
    "a ball lands on a light table that is free to turn": (
        {
            "body": BALL,
            "support": {
                "kind": "plane",
                "friction": 0.1,
                "tangential_restitution": 0.9,
                "motion": {"kind": "free-axle", "inertia": 1e-4},
            },
            "start": {"position": [0.2, 0.1], "velocity": [0.3, 0.1, -0.5], "spin": 1.0, "height": 0.02},
        },
        ("body.mass", "start.velocity[0]", "support.friction"),
        ("land", "grip"),
        (0.02, 0.05, 0.1),
    ),
    "a cut ball begins to slip whose direction lags": (
        {
            "body": {"kind": "hemisphere", "radius": 0.015, "density": 880.0, "centre": [0.0035, -0.005, -0.012]},
            "support": {"kind": "paraboloid", "radius": 0.11, "tilt": 0.6, "friction": 0.26},
            "start": {"position": [-0.0144, -0.013], "orientation": [0.937, 0.021, 0.272, 0.117]},
        },
        ("body.centre[2]", "support.friction", "gravity"),
        ("slip",),
        (0.02, 0.04, 0.06, 0.08),
    ),
    "a table jerks under a ball, which holds": (
        {
            "body": BALL,
            "support": {"kind": "plane", "tilt": 0.02, "motion": JERK},
            "start": {"position": [0, 0], "velocity": [0.1, 0.2]},
        },
        ("body.radius", "support.tilt", "start.velocity[1]", "gravity"),
        ("jolt",),
        (0.1, 0.19, 0.21, 0.4),
    ),
    "a table jerks under a ball, which slips and grips": (
        {
            "body": BALL,
            "support": {"kind": "plane", "tilt": 0.02, "friction": 0.3, "motion": JERK},
            "start": {"position": [0, 0], "velocity": [0.1, 0.2]},
        },
        ("body.radius", "support.tilt", "support.friction", "start.velocity[1]", "gravity"),
        ("jolt", "grip"),
        (0.1, 0.19, 0.21, 0.4),
    ),
    "a ball runs off a clockwise table": (
        {
            "body": BALL,
            "support": {"kind": "plane", "rim": 0.4, "tilt": 0.05, "motion": TURNING},
            "start": {"position": [0.1, 0], "velocity": [0.4, 0.2]},
        },
        ("support.rim", "support.tilt", "support.motion.rate", "start.velocity[0]"),
        ("rim",),
        (0.1, 0.3),
    ),
    "a ball rolls to and fro across the crease of a force": (
        {
            "body": BALL,
            "support": {"kind": "plane", "tilt": 0.01},
            "loads": [{"kind": "potential", "formula": "0.3*abs(x)"}],
            "start": {"position": [-0.02, 0.0], "velocity": [0.1, 0.2]},
        },
        ("support.tilt", "start.velocity[0]", "start.position[0]", "body.mass"),
        (),
        (0.1, 0.3, 0.5, 0.8),
    ),
    "a ball falls through the crease of a force": (
        {
            "body": BALL,
            "support": {"kind": "plane", "restitution": 0.5},
            "loads": [{"kind": "potential", "formula": "0.5*abs(z - 0.05)"}],
            "start": {"position": [0.1, 0.0], "velocity": [0.2, 0.0, 0.1], "height": 0.04},
        },
        ("start.height", "start.velocity[2]", "body.mass", "gravity"),
        ("land",),
        (0.05, 0.09, 0.15),
    ),
    "a ball comes to rest": (
        {
            "body": BALL,
            "support": {"kind": "plane"},
            "loads": [{"kind": "rolling-resistance", "offset": 0.002}],
            "start": {"position": [0, 0], "velocity": [0.2, 0.1]},
        },
        ("loads[0].offset", "start.velocity", "gravity", "body.radius"),
        ("stop",),
        (0.1, 0.3, 0.6, 0.8),
    ),
    "a ball turns back in quadratic drag": (
        {
            "body": BALL,
            "support": {"kind": "plane", "tilt": 0.1},
            "loads": [{"kind": "quadratic-drag", "coefficient": 0.3}],
            "start": {"position": [0, 0], "velocity": [-0.3, 0.0]},
        },
        ("loads[0].coefficient", "support.tilt", "start.velocity[0]", "body.mass"),
        (),
        (0.2, 0.5, 0.8),
    ),
}


def tables_of(name: str) -> tuple[dict[str, Any], tuple[str, ...], tuple[str, ...], tuple[float, ...]]:
    tables, keys, kinds, times = EVENTS[name]
    end = 2.0 if "rim" in kinds else times[-1]
    return {"gravity": 9.8, **tables, "run": {"duration": end, "every": 0.01}}, keys, kinds, times


@pytest.mark.parametrize("name", EVENTS)
def test_a_run_through_events_has_the_derivatives_of_its_runs(name: str) -> None:
    tables, keys, kinds, times = tables_of(name)
    scenario = tr.Scenario.read(tables)
    found = check(tables, [key.name for key in chosen(scenario, keys)], np.array(times))
    assert tuple(found.data.kind.values) == kinds


@pytest.mark.parametrize("name", EVENTS)
def test_by_numbers_of_the_start_alone_they_are_the_same(name: str) -> None:
    """Then the system itself is in plain numbers, and only the state is not."""
    tables, keys, _, times = tables_of(name)
    scenario = tr.Scenario.read(tables)
    some = [key for key in keys if key.startswith("start")] or ["start.position[0]"]
    alone = tr.sensitivities(scenario, some, duration=times[-1])
    beside = tr.sensitivities(scenario, [*some, "gravity"], duration=times[-1], compared=False)
    assert alone.passed
    for quantity in ("position", "velocity", "angular_velocity", "contact_force"):
        wanted = beside[quantity].values[..., : alone.data.parameter.size]
        assert alone[quantity].values == pytest.approx(wanted, rel=1e-8, abs=1e-8 * max(1.0, np.abs(wanted).max()))


@pytest.mark.parametrize("name", [name for name, (*_, kinds, _) in EVENTS.items() if kinds])
def test_when_an_event_comes_has_its_derivative(name: str) -> None:
    tables, keys, kinds, _ = tables_of(name)
    key = keys[0]
    found = tr.sensitivities(tr.Scenario.read(tables), [key], compared=False)
    step = 1e-4 * max(abs(float(found.data.value[0])), 0.01)

    def instants(by: float) -> Any:
        scenario = tr.Scenario.read(changed(tables, key, by))
        run = scenario.run("taylor")
        return np.array([event.time for event in run.events])

    wide, narrow = ((instants(h) - instants(-h)) / (2 * h) for h in (step, step / 2))
    assert np.allclose(found.event_time.values[:, 0], (4 * narrow - wide) / 3, rtol=1e-7, atol=1e-8)
    assert len(kinds) == len(found.data.kind)


@pytest.mark.usefixtures("through_walls")
@pytest.mark.parametrize("duration", [0.13, 0.15, 0.53])
@pytest.mark.parametrize("key", ["start.velocity[0]", "start.velocity[1]", "support.friction"])
def test_when_a_law_grows_singular_has_its_derivative(key: str, duration: float) -> None:
    """A ring slips in a steep cone until its rim lies closely: a step back from there would lead anywhere."""
    tables = {
        "body": {"kind": "ring", "radius": 0.0322989, "mass": 0.781133},
        "support": {"kind": "cone", "half_angle": 1.39868, "friction": 0.0655, "tangential_restitution": 0.0725993},
        "start": {"position": [0.0814643, 0.0], "velocity": [0.041712, -0.0600521, -0.115096], "height": 0.0792799},
        "run": {"duration": duration, "every": 0.01},
    }
    found = tr.sensitivities(tr.Scenario.read(tables), key, compared=False)
    ends = [tr.Scenario.read(changed(tables, key, by)).run("taylor").events[-1] for by in (1e-5, -1e-5)]
    assert [event.kind for event in ends] == ["curved", "curved"]
    assert float(found.event_time[-1, 0]) == pytest.approx((ends[0].time - ends[1].time) / 2e-5, rel=1e-7)


@pytest.mark.parametrize("side", ["inside", "outside"])
@pytest.mark.parametrize("kind", ["ring", "solid-sphere", "torus"])
def test_a_fall_along_a_wall_depends_on_gravity_alone(kind: str, side: str) -> None:
    """Nothing presses: z = z₀ − g t²/2, so that ∂z/∂g = −t²/2, ∂z/∂z₀ = 1, and nothing turns."""
    body = {"kind": kind, "radius": 0.035, "mass": 0.2229} | ({"rim_radius": 0.01} if kind == "torus" else {})
    tables = {
        "body": body,
        "support": {"kind": "cylinder", "radius": 0.355, "side": side, "friction": 0.4},
        "start": {"position": [-0.1, -0.05]},
        "run": {"duration": 0.6, "every": 0.1},
    }
    names = ["gravity", "start.position[1]", "body.mass", "body.radius", "support.friction"]
    found = tr.sensitivities(tr.Scenario.read(tables), names)
    assert found.passed, str(found)
    time = found.time
    height = np.stack([-(time**2) / 2, np.ones_like(time), *[np.zeros_like(time)] * 3], axis=1)
    assert np.abs(found.position[:, 2] - height).max() < 1e-12
    assert np.abs(found.angular_velocity).max() < 1e-12


def test_a_landing_whose_slip_settles_at_once_has_slopes() -> None:
    """On a table a thousand times as light its direction stands still, and only the slopes tell how fast it settles."""
    tables = {
        "body": {"kind": "solid-sphere", "radius": 0.197317, "density": 906.965},
        "support": {
            "kind": "revolution",
            "formula": "0.426546*r**2 - 0.426766*r2**4 + -0.0211967*exp(r2)",
            "friction": 0.100958,
            "kinetic_friction": 0.0324191,
            "tangential_restitution": 0.950037,
            "motion": {"kind": "free-axle", "inertia": 0.00125555},
        },
        "start": {
            "position": [-0.038366, 0.239471],
            "velocity": [0.0, 0.176091],
            "spin": -0.447463,
            "height": 0.132589,
            "support": [-1.5707963267948966, 0.0],
        },
        "run": {"duration": 0.17, "every": 0.017},
    }
    found = tr.sensitivities(tr.Scenario.read(tables), "support.tilt")
    assert tuple(found.data.kind.values) == ("land",)
    assert found.passed


# Where rolling ends as friction just fails, or at rest, the rates do not jump, and when that is does not matter. They
# do where less friction is left than held the body.
JUMPS = [
    name
    for name, (tables, _, kinds, _) in EVENTS.items()
    if {"land", "grip"} & set(kinds) or "kinetic_friction" in tables["support"]
]


@pytest.mark.parametrize("name", JUMPS)
def test_without_the_saltation_the_derivatives_are_wrong(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    tables, keys, _, times = tables_of(name)
    scenario = tr.Scenario.read(tables)
    right = tr.sensitivities(scenario, keys, compared=False)

    def as_if_at_one_instant(run: Any, now: Any, begins: Any) -> list[Any]:  # noqa: ARG001
        return [Dual(value_of(part), slopes_of(part, run.count)) for part in begins.state_vector]

    monkeypatch.setattr(following._Run, "_at_fixed_time", as_if_at_one_instant)
    wrong = tr.sensitivities(scenario, keys)
    apart = abs(wrong.velocity - right.velocity).sel(time=times[-1]).max()
    assert float(apart) > 1e-3 * float(abs(right.velocity).max())
    assert wrong.passed is False


@pytest.mark.parametrize("shares", [(1.0,), (0.6, 0.4)])
@pytest.mark.parametrize("c", [0.05, 1e-6, -0.01])
def test_across_a_crease_they_are_those_of_the_formula(c: float, shares: tuple[float, ...]) -> None:
    """Under U = c |x| a ball rolls as x = −d + vt + at²/2 to the crease, and from there as v₁τ − aτ²/2.

    Two loads may have their creases in one place.
    """
    d, v, mass = 0.1, 0.2, 0.2
    a = c / (mass * 7 / 5)
    tables = {
        "body": {"kind": "solid-sphere", "radius": 0.03, "mass": mass},
        "support": {"kind": "plane"},
        "loads": [{"kind": "potential", "formula": f"{c * share}*abs(x)"} for share in shares],
        "start": {"position": [-d, 0], "velocity": [v, 0]},
        "run": {"duration": 1.0, "every": 0.1},
    }
    found = tr.sensitivities(tr.Scenario.read(tables), "start.velocity[0]")
    assert found.passed
    fast = np.sqrt(v * v + 2 * a * d)  # v₁
    there = (fast - v) / a
    t = found.data.time.values
    # ∂v₁/∂v = v/v₁ and ∂t₁/∂v = (v/v₁ − 1)/a, so that τ gets less by that.
    later = v / fast * (t - there) - (fast - a * (t - there)) * (v / fast - 1) / a
    wanted = np.where(t < there, t, later)
    assert found.position.sel(axis="x").values.squeeze() == pytest.approx(wanted, abs=1e-9)


def test_a_later_start_moves_all_that_follows() -> None:
    """A ball that slips as a billiard ball does: x = vτ − μgτ²/2 and then 5/7 v, with τ = t − t₀."""
    mu, v, t0 = 0.2, 1.0, 0.3
    tables = {
        "gravity": 9.80665,
        "body": {"kind": "solid-sphere", "radius": 0.03, "mass": 0.2},
        "support": {"kind": "plane", "friction": mu},
        "start": {"position": [0, 0], "velocity": [v, 0], "angular_velocity": [0, 0, 0], "time": t0},
        "run": {"duration": 0.4, "every": 0.05},
    }
    found = tr.sensitivities(tr.Scenario.read(tables), "start.time")
    assert found.passed
    data = found.data.squeeze("parameter")
    since = data.time.values - t0
    grips = 2 * v / (7 * mu * 9.80665)
    assert data.event_time.values == pytest.approx([1.0], abs=1e-12)
    assert data.instant.values == pytest.approx([t0 + grips], abs=1e-12)
    wanted = -np.where(since < grips, v - mu * 9.80665 * since, 5 / 7 * v)
    assert data.position.sel(axis="x").values == pytest.approx(wanted, abs=1e-11)


@pytest.mark.parametrize("name", ["billiard-follow", "turntable-starting-up", "ball-on-a-pushed-box", "turntable-drop"])
def test_the_clock_is_a_number_of_any_scenario(name: str) -> None:
    """Also where the support is faster then, and where a slip ends in nothing to the last digit."""
    found = tr.sensitivities(name, "start.time", duration=0.3, every=0.1)
    assert found.passed


@pytest.mark.parametrize("draw", range(40))
def test_when_a_ball_grips_has_the_derivative_of_its_formula(draw: int) -> None:
    """Slip along a line ends after |s|/(μg(1 + 1/k)), and how near the last look comes to that end is chance."""
    random = np.random.default_rng(draw)
    mu, k, (v_x, v_y), spin = random.uniform(0.03, 0.3), random.uniform(0.3, 0.6), *random.uniform(-0.5, 0.5, (1, 2)), 2
    Omega_x, Omega_y = random.uniform(-20.0, 20.0, 2)
    tables = {
        "gravity": 9.80665,
        "body": {"kind": "sphere", "radius": 0.03, "mass": 0.17, "inertia_ratio": k},
        "support": {"kind": "plane", "friction": mu},
        "start": {"position": [0.1, 0.1], "velocity": [v_x, v_y], "angular_velocity": [Omega_x, Omega_y, spin]},
        "run": {"duration": 4.0, "every": random.uniform(0.01, 0.05)},
    }
    found = tr.sensitivities(
        tr.Scenario.read(tables), ["start.velocity[0]", "start.angular_velocity[0]"], compared=False
    )
    slip = np.array([v_x - 0.03 * Omega_y, v_y + 0.03 * Omega_x])  # s = V + Ω×ρ, with ρ = −a e_z
    per = slip / np.linalg.norm(slip) / (mu * 9.80665 * (1 + 1 / k))
    assert found.event_time.values == pytest.approx(np.array([[per[0], 0.03 * per[1]]]), rel=1e-9, abs=1e-12)


def test_slip_that_begins_at_each_landing_is_traced_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where and when each begins are numbers, of the variational law as of the law itself."""
    traced: list[tuple[Any, Any, Any]] = []

    def counted(system: Any, law: Any, own: Any) -> Any:
        traced.append((type(system), type(law), getattr(law, "kind", None)))
        return follows(system, law, own)

    follows = tracing._traced
    monkeypatch.setattr(tracing, "_traced", counted)
    tracing._memory.cache_clear()
    bouncing = {
        "body": {"kind": "solid-sphere", "radius": 0.025, "mass": 0.5},
        "support": {"kind": "cylinder", "radius": 0.125, "tilt": "90 deg", "friction": 0.3, "restitution": 0.6},
        "start": {"position": [0.17, 0.0], "velocity": [0.8, 0.0, 0.27]},
        "run": {"duration": 1.5, "every": 0.05},
    }
    found = tr.sensitivities(tr.Scenario.read(bouncing), ["start.velocity[0]"])
    assert (found.data.kind == "land").sum() > 4
    assert any(kind is CreepingLaw for _, _, kind in traced)
    assert len(traced) == len(set(traced))


@pytest.mark.usefixtures("through_walls")
def test_a_law_that_grows_singular_next_to_the_end_of_a_formula_has_its_derivative() -> None:
    """A step back from there leads to where log has no value."""
    tables = {
        "body": {
            "kind": "disc",
            "radius": 0.0340577,
            "mass": 0.0123712,
            "centre": [0.00454312, -0.00988888, 0.0179914],
        },
        "support": {
            "kind": "height-field",
            "formula": "0.0486609*sin(7.14858*x)*cos(3.18754*x) - 0.10237*log(0.3 + x)",
            "restitution": 0.0259233,
            "motion": {"kind": "precessing-tilt", "angle": -0.18634, "rate": 0.37784},
        },
        "start": {"position": [0.058236, 0.0110493], "velocity": [-0.0397163, 0, 1.7938]},
        "run": {"duration": 0.53, "every": 0.02},
    }
    found = tr.sensitivities(tr.Scenario.read({"gravity": 9.80665, **tables}), ["gravity"], compared=False)
    ends = [tr.Scenario.read({"gravity": 9.80665 + h, **tables}).run("taylor").events[-1].time for h in (1e-5, -1e-5)]
    assert found.data.kind.values[-1] == "curved"
    assert float(found.event_time.values[-1, 0]) == pytest.approx((ends[0] - ends[1]) / 2e-5, rel=1e-5)
