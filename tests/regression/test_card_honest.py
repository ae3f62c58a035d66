"""Honest runs of kinds that the card once condemned: what a motion makes of roundings is no fault of the run."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
import pytest
import tomli_w

import trundle as tr
from trundle import verify
from trundle.solve import runge_kutta, taylor
from trundle.solve.dense import Dense
from trundle.solve.methods import Method
from trundle.solve.patience import Patience
from trundle.solve.samples import FLIGHT, ROLLING
from trundle.verify import law
from trundle.verify.again import Again
from trundle.verify.bounds import sizes_of
from trundle.verify.compared import Compared
from trundle.verify.growth import growth
from trundle.verify.law import _SLOPE, _slope_at_middle, residuals, window_times
from trundle.views.scene.headline import _events

pytest.importorskip("heyoka")

PLANE, STEEP = {"kind": "plane"}, {"kind": "height-field", "formula": "0.1*exp(3*x)"}


def passes(**tables: Any) -> tr.Trajectory:
    """Run a scenario, and ask for a card without a failure."""
    run = tr.Scenario.loads(tomli_w.dumps(tables)).run()
    card = run.card()
    assert card.passed, str(card)
    return run


# --- what a motion makes of an error ------------------------------------------------------------------------


def stone(heading: float, spin: float) -> dict[str, Any]:
    """A flat stone, nearly plane where it touches: a small turn moves its contact far."""
    body = {"kind": "ellipsoid", "semi_axes": [0.2, 0.03, 0.02], "mass": 1.0, "moments": [2e-4, 1.6e-3, 1.7e-3]}
    body |= {"products": [2e-5, 0, 0], "centre": [0, 0, 0.01]}
    load = {"kind": "rolling-couple", "coefficient": 1e-4}
    start = {"position": [0, 0], "velocity": [-0.06285, 0.06008], "attitude": ["0 deg", "0.7071 deg", f"{heading} deg"]}
    start |= {"spin": spin}
    return {"loads": [load], "body": body, "support": PLANE, "start": start, "run": {"duration": 3, "every": 0.02}}


def coin(spin: float, lean: float) -> dict[str, Any]:
    """A coin that falls almost flat and rises again: for a moment it turns much faster than before and after."""
    start = {"position": [0, 0], "spin": spin, "attitude": ["0 deg", f"{lean} deg", "0 deg"]}
    body = {"kind": "disc", "radius": "12 mm", "mass": "8 g"}
    return {"body": body, "support": PLANE, "start": start, "run": {"duration": 3, "every": 0.02}}


def ring(x: float, spin: float) -> dict[str, Any]:
    """A ring thrown down a steep slope."""
    body = {"kind": "ring", "radius": 0.007107, "mass": 0.2735}
    start = {"position": [x, 0.04889], "spin": spin}
    return {"body": body, "support": STEEP, "start": start, "run": {"duration": 2, "every": 0.02}}


MAGNIFIED = {
    "a flat stone": stone(44.999, 5.0),
    "a flat stone, turned": stone(20.0, -5.0),
    "a coin almost flat": coin(15.468, 89.5),
    "a coin almost flat, slower": coin(13.1, 89.2),
    "a ring on a steep slope": ring(0.1659, -0.48),
    "a ring on a steep slope, faster": ring(0.11, 1.1),
}


@pytest.mark.parametrize("kind", MAGNIFIED)
def test_what_a_motion_magnifies_in_any_direction_passes(kind: str) -> None:
    passes(**MAGNIFIED[kind])


@pytest.mark.parametrize("kind", MAGNIFIED)
def test_a_change_is_followed_for_so_much_work_about_where_two_runs_part(
    kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("trundle.verify.compared._WORK_FOLLOWED", 1e8)
    again = passes(**MAGNIFIED[kind]).card()["the method run again"]
    assert again.passed is not False
    cut, followed = "nothing can be told beyond t = " in again.note, "times larger" in again.note
    assert cut <= followed
    assert cut == followed or "stone" in kind  # of a stone rounding decides whether its runs part before they end


@pytest.mark.parametrize("kind", ["a coin almost flat, slower", "a ring on a steep slope"])
def test_no_comparison_follows_changed_runs_through_more_work_than_that(
    kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    # The finer run of Runge-Kutta, too, which once had them followed through all of it: 26 s for a run of two.
    most, seen = 1e8, list[tuple[Dense | None, float, float]]()

    def watched(system: Any, start: Any, at: Any, method: Any, sizes: Any, kept: Dense | None = None) -> Any:
        seen.append((kept, start.time, float(at.time[-1])))
        return growth(system, start, at, method, sizes, kept)

    monkeypatch.setattr("trundle.verify.compared.growth", watched)
    monkeypatch.setattr("trundle.verify.compared._WORK_FOLLOWED", most)
    monkeypatch.setattr(Compared, "bound", 1e-18)  # each comparison asks what the motion magnifies
    scenario = tr.Scenario.loads(tomli_w.dumps(MAGNIFIED[kind] | {"run": {"duration": 1, "every": 0.02}}))
    run = scenario.run("runge-kutta")
    _ = run.card()
    assert seen  # the same method run again is the same to the last digit
    for kept, begin, end in seen:
        assert kept is not None
        work = np.diff(kept.work_until(np.array([begin, end])))[0]
        assert work <= max(1.01 * most, kept.work) / 12  # a dozen of them; or from one sample to the next


def test_a_ball_on_top_of_a_dome_magnifies_by_the_rate_at_which_it_falls() -> None:
    # θ̈ = (5/7) g θ/(R + r) near the top, and so e^{λt} for whatever is small there.
    system = tr.RollingSystem(tr.Body.solid_sphere(0.025, 0.065), tr.Support(tr.Dome(1.0)))
    start = system.place((0.0, 0.0))
    run = tr.simulate(system, start, duration=3.0, every=0.05)
    sizes = sizes_of(system, run.samples) | {"velocity": 1.0, "angular_velocity": 40.0}
    found = growth(system, start, run.samples, Method.of("taylor"), sizes)
    rate = math.sqrt(5 / 7 * 9.80665 / 1.025)
    one, other = found.at(np.array([1.5, 3.0]))
    assert other / one == pytest.approx(math.exp(1.5 * rate), rel=0.02)


# --- how slip begins ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("coefficient", [0.0, 1e-3])
@pytest.mark.parametrize("offset", [0.0, 1e-3, -1])
def test_slip_that_begins_at_once_loses_no_energy_to_what_resists(offset: float, coefficient: float) -> None:
    # When slip begins the normal force jumps, where the body is no ball, and with it the couple that resists rolling.
    egg = {"kind": "ellipsoid", "semi_axes": [0.03, 0.04, 0.05], "mass": 0.2}
    start = {"position": [0, 0], "velocity": [0.4, -0.2], "spin": -12, "attitude": ["20 deg", "55 deg", "70 deg"]}
    loads = [{"kind": "rolling-resistance", "offset": offset}] if offset > 0 else []
    loads += [{"kind": "rolling-couple", "coefficient": coefficient}] if coefficient else []
    loads += [{"kind": "pivot-friction", "offset": 1e-3}] if offset < 0 else []
    run = passes(
        body=egg,
        support={"kind": "plane", "friction": 0.02},
        start=start,
        loads=loads,
        run={"duration": 0.02, "every": 0.001},
    )
    assert [event.kind for event in run.events] in ([], ["slip"])
    assert (run.data.phase.values == 1).all()


def test_slip_that_creeps_on_keeps_its_energy() -> None:
    # A wobbling disc slips so slowly for 3 ms that its direction settles at once. Where that is followed 16 times more
    # closely, it grips at this instant: to the first power of the lag alone it did 7e-9 s later.
    run = passes(
        body={"kind": "disc", "radius": 0.0375, "mass": 0.4},
        support={**PLANE, "friction": 0.2},
        start={"position": [0, 0], "spin": 4.258621530466869, "attitude": ["0 deg", "15 deg", "0 deg"]},
        loads=[{"kind": "rolling-couple", "coefficient": 4e-5}],
        run={"duration": 1.97, "every": 0.005},
    )
    assert [event.kind for event in run.events] == ["slip", "grip"]
    assert abs(run.events[1].time - 1.96743309569239) <= 2e-11


# --- where the law is singular ------------------------------------------------------------------------------

CURVED = {
    # Nearly straight down into the tip of a cone, where it ends almost as hollow as the ball is round.
    "a ball in a cone": {
        "body": {"kind": "solid-sphere", "radius": "10 mm", "mass": "32.7 g"},
        "support": {"kind": "cone", "half_angle": "45 deg", "rim": "40 cm"},
        "start": {"position": ["20 cm", "0 cm"], "velocity": ["0 m/s", "8e-9 m/s"]},
        "run": {"duration": 1, "every": "5 ms"},
    },
    "an ellipsoid that slips in a funnel": {
        "body": {"kind": "ellipsoid", "semi_axes": [0.1294, 0.05665, 0.03186], "mass": 0.01047, "turn": "-12.63 deg"},
        "support": {
            "kind": "revolution",
            "formula": "0.2*r",
            "friction": 0.01831,
            "motion": {"kind": "uneven-spin", "rate": -1.216, "variation": -0.08564, "variation_rate": 7.828},
        },
        "start": {"position": [0.1, 0], "velocity": [-0.5623, 0.5265], "spin": 15.4},
        "run": {"duration": 2, "every": 0.02},
    },
}


@pytest.mark.usefixtures("through_walls")
@pytest.mark.parametrize("kind", CURVED)
def test_a_run_that_ends_where_the_support_is_as_hollow_as_the_body_is_round(kind: str) -> None:
    run = passes(**CURVED[kind])
    assert [event.kind for event in run.events] == ["curved"]
    # What is off by more than the end makes of a rounding is told.
    velocity = run.data.velocity.copy(deep=True)
    velocity[-1] *= 1.01
    altered = replace(run, data=run.data.assign(velocity=velocity), _kept={})
    assert not altered.card().passed


@pytest.mark.usefixtures("through_walls")
def test_a_flight_that_ends_where_no_point_of_the_support_is_nearest() -> None:
    # Between the clock's last two instants 1 + C S changes by 2e-7 there, and no step is shorter than ten of these.
    potential = {"kind": "potential", "formula": "1.48277*3*(z**2 + y**2) + -0.0237738*x**2"}
    r = [0.0, 0.0334105, 0.133642, 0.300694, 0.534567, 0.835262]
    run = passes(
        loads=[potential, {"kind": "pivot-friction", "offset": 1.06208e-5}],
        body={"kind": "sphere", "radius": 0.042949, "mass": 0.00745831, "inertia_ratio": 0.111937},
        support={"kind": "revolution", "r": r, "z": [0.0, 0.036817, 0.147268, 0.331353, 0.589072, 0.920425]},
        start={"position": [0.0419193, 0.140352]},
        run={"duration": 2.0, "every": 0.0121108},
    )
    assert run.method == "runge-kutta"
    assert [event.kind for event in run.events] == ["lift", "curved"]


NEAR_AN_END = {
    # Rounding of V, of places and of ρ adds up: none of them alone is what the slope of V is off.
    "a torus that slips over waves": (
        {
            "body": {"kind": "torus", "radius": 0.152593, "rim_radius": 0.0644632, "mass": 1.08559},
            "support": {
                "kind": "height-field",
                "formula": "0.0344411*sin(9.27021*x)*cos(2.88177*y)",
                "tilt": "45 deg",
                "friction": 0.0535826,
            },
            "loads": [{"kind": "torque", "value": ["0.00520443*sin(0.455723*t)", -0.437712, "0.06*sqrt(1 + 2.4*t)"]}],
            "start": {"position": [0.0870938, 0.0326401], "orientation": [0.075756, -0.187056, 0.964794, 0.0416816]},
            "run": {"duration": 2, "every": 0.02},
        },
        "curved",
    ),
    # Its contact runs 20 to 30 times as fast as its points: so many times a rounding of q is one of ρ̇.
    "a disc that rolls on a wave": (
        {
            "gravity": 1.62,
            "body": {"kind": "disc", "radius": 0.138512, "mass": 0.00825765},
            "support": {
                "kind": "height-field",
                "formula": "0.00672684*sin(7.0674*x)*cos(20.3578*x) + 0.00665141*exp(x)",
                "restitution": 0.123278,
            },
            "start": {"position": [0.269592, 0.183184], "velocity": [0.0, -1.58284, -0.68829], "spin": 4.28711},
            "run": {"duration": 2, "every": 0.0344283},
        },
        "curved",
    ),
    # Its contact passes at 6 km/s what moves at 1 mm/s: so many times a rounding is one of N.
    "a ring that all but rests in a bowl": (
        {
            "gravity": 30,
            "body": {"kind": "ring", "radius": 0.130939, "mass": 1.92392},
            "support": {
                "kind": "bowl",
                "radius": 1.50903,
                "friction": 0.639911,
                "kinetic_friction": 0.161269,
                "tangential_restitution": 0.174488,
            },
            "loads": [
                {"kind": "rolling-resistance", "offset": 0.00163649},
                {"kind": "force", "value": [0.0, "48.6987*(1 - exp(-t))", -5.85436]},
            ],
            "start": {"position": [0.157215, 0.00618215]},
            "run": {"duration": 1.55917, "every": 0.02},
        },
        "curved",
    ),
    # By the edge of its shape the last digits of p turn the normal of a narrow cone.
    "a hemisphere that flies down a cone": (
        {
            "body": {"kind": "hemisphere", "radius": 0.0278664, "mass": 0.545962},
            "support": {
                "kind": "cone",
                "half_angle": 0.116722,
                "tilt": "45 deg",
                "friction": 0.766418,
                "restitution": 0.0886718,
                "motion": {
                    "kind": "uneven-spin",
                    "rate": 0.664501,
                    "variation": 0.0286544,
                    "variation_rate": 0.472799,
                },
            },
            "start": {
                "position": [0.0294921, 0.0],
                "velocity": [-0.025037, 0.0, 0.893717],
                "spin": 0.948385,
                "attitude": [-0.00731487, -0.054886, "45 deg"],
            },
            "run": {"duration": 2, "every": 0.02},
        },
        "edge",
    ),
    # In flight over a table 1 + C S goes with the root of what the state is off.
    "a ring that flies over a funnel": (
        {
            "body": {"kind": "ring", "radius": 0.139403, "mass": 0.589753},
            "support": {
                "kind": "revolution",
                "r": [0.0, 0.0133002, 0.0532007, 0.119702, 0.212803, 0.332504],
                "z": [0.0, 0.0169886, 0.0679544, 0.152898, 0.271818, 0.424715],
                "tangential_restitution": 0.0234288,
            },
            "start": {"position": [0.0922631, -0.146428], "velocity": [-1.48126, -1.06934, -1.03627]},
            "run": {"duration": 2, "every": 0.02},
        },
        "curved",
    ),
}


@pytest.mark.usefixtures("through_walls")
@pytest.mark.parametrize("kind", NEAR_AN_END)
def test_what_rounding_does_near_an_end_adds_up(kind: str) -> None:
    tables, end = NEAR_AN_END[kind]
    run = passes(**tables)
    assert run.events[-1].kind == end
    velocity = run.data.velocity.copy(deep=True)
    velocity[1:] += 1e-5 * float(np.abs(velocity).max())
    assert not replace(run, data=run.data.assign(velocity=velocity), _kept={}).card().passed


@pytest.mark.parametrize("spin", [0.0140901, -0.140901, 1.40901])
@pytest.mark.parametrize("x", [0.0165628, 0.05])
def test_what_resistance_holds_as_soon_as_it_turns_is_still_beside_what_drives_it(x: float, spin: float) -> None:
    """Its forces let it turn at 27 rad/s; beside the 0.1 rad/s at which it spins a still body turned too fast."""
    run = passes(
        loads=[{"kind": "rolling-resistance", "offset": 0.0016286 * x / 0.0165628}],
        gravity=30.0,
        body={"kind": "sphere-with-moment", "radius": 0.0396598, "mass": 0.0733678, "moment_of_inertia": 4.8273e-05},
        support={"kind": "dome", "radius": 1.38167, "friction": 0.518007},
        start={"position": [0.0, -x], "spin": spin},
        run={"duration": 0.1, "every": 0.01},
    )
    assert [event.kind for event in run.events] == ["spot"]


@pytest.mark.usefixtures("through_walls")
@pytest.mark.parametrize("share", [0.999, 1.002, 1.006, 1.008])
def test_a_rounding_of_the_normal_force_turns_a_ring_about_its_easiest_axis(share: float) -> None:
    """By the trace of its inertia a rounding could turn it a quarter as fast: one in ten such runs failed."""
    tables, end = NEAR_AN_END["a ring that all but rests in a bowl"]
    body = {**tables["body"], "mass": share * tables["body"]["mass"]}
    assert passes(**{**tables, "body": body}).events[-1].kind == end


def test_a_force_that_is_a_little_off_is_seen_near_an_end(monkeypatch: pytest.MonkeyPatch) -> None:
    tables, _ = NEAR_AN_END["a torus that slips over waves"]
    run = tr.Scenario.loads(tomli_w.dumps(tables)).run()
    acting = law.acting

    def pulled(system: Any, at: Any) -> Any:
        F, *rest = acting(system, at)
        return F + 1e-8 * np.abs(F).max(), *rest

    monkeypatch.setattr(law, "acting", pulled)
    assert not run.card()["law of motion"].passed


# --- what changes faster than the samples show --------------------------------------------------------------


def pivoting(spin: float) -> dict[str, Any]:
    """An egg whose spin goes through nothing, where pivot friction turns round within an instant."""
    body = {"kind": "ellipsoid", "semi_axes": [0.03, 0.035, 0.04], "mass": 1.9, "centre": [0.004, -0.0015, 0.003]}
    start = {"position": [-0.017, 0.169], "velocity": [-0.84, -0.09], "spin": spin, "attitude": [0.3, 0.8, 0.2]}
    return {
        "body": body,
        "support": {"kind": "bowl", "radius": 0.5},
        "start": start,
        "loads": [{"kind": "pivot-friction", "offset": 6e-4}],
        "run": {"duration": 0.1, "every": 0.01},
    }


@pytest.mark.parametrize("spin", [1.07, -0.4, 0.1])
def test_windows_are_as_narrow_as_what_changes_in_them(spin: float) -> None:
    passes(**pivoting(spin))


@pytest.mark.parametrize("torque", [1.2e-3, -1.2e-3])
@pytest.mark.parametrize(("height", "rate"), [(0.003, -2.0), (0.006, 0.95), (0.006, -2.0), (0.01, -0.95), (0.01, 0.95)])
def test_a_hard_landing_makes_no_later_slope_less_sharp(height: float, rate: float, torque: float) -> None:
    # What a polynomial left of the slopes of slow slip was small beside those of the landing, and was let be.
    loads = [{"kind": "rolling-resistance", "offset": 2e-4}, {"kind": "torque", "value": [torque, 0.0, 3.6e-4]}]
    run = passes(
        body={"kind": "ring", "radius": 0.044, "mass": 0.08},
        support={"kind": "bowl", "radius": 0.52, "friction": 0.27, "motion": {"kind": "spin", "rate": rate}},
        loads=loads,
        start={"position": [-0.011, -0.126], "velocity": "co-rotating", "height": height},
        run={"duration": 0.35, "every": 0.02},
    )
    assert {"land", "grip", "slip"} <= {event.kind for event in run.events}


@pytest.mark.parametrize("angle", [5e-3, 5e-5, 5e-7])
def test_a_body_that_turns_slowly_and_quivers_is_followed_in_narrow_windows(angle: float) -> None:
    # Its forces could turn it a thousand times as fast: beside them its Ω, and how it quivers, are nothing.
    motion = {"kind": "tilt", "angle": f"{angle}*sqrt(1 + 0.3*t)"}
    support = {"kind": "plane", "friction": 0.0, "motion": motion}
    body = {"kind": "half-cylinder", "radius": 0.0243, "mass": 0.192}
    start = {"position": [0.005, -0.13], "velocity": "co-rotating"}
    run = passes(body=body, support=support, start=start, run={"duration": 2.0, "every": 0.0366})
    Omega = run.samples.angular_velocity
    assert 0 < np.ptp(Omega[:, 1]) < 1e-3 * angle / 5e-3


@pytest.mark.parametrize("amplitude", [0.644, -0.644])
def test_a_body_whose_resistance_turns_round_slips_before_friction_has_given_all(amplitude: float) -> None:
    # Where it stops turning over the support its resistance jumps from −δN to δN, and so does what asks for friction.
    rocks = {"kind": "rock", "amplitude": amplitude, "rate": 1.32, "phase": -0.08}
    way = -1 if amplitude > 0 else 1
    run = passes(
        body={"kind": "weighted-cylinder", "radius": 0.0329, "mass": 1.265, "weight": 0.0356, "distance": 0.014},
        support={"kind": "plane", "rim": 0.106, "friction": 0.0642, "motion": rocks},
        loads=[{"kind": "rolling-resistance", "offset": 0.001}],
        start={"position": [-0.013 * way, 0.0], "velocity": [0.097 * way, 0.0]},
        run={"duration": 0.6, "every": 0.02},
    )
    stop, slip = (event for event in run.events if event.kind in ("stop", "slip"))
    assert (stop.kind, slip.kind) == ("stop", "slip")
    assert stop.time == slip.time
    (told,) = (one.text for one in _events(run.system, run.samples))
    assert told == "begins to slip after {}"  # it does not come to rest


@pytest.mark.parametrize("turn", [0.0, 0.7, 2.5])
def test_what_a_body_thrown_outwards_has_about_the_axle_is_small_beside_its_products(turn: float) -> None:
    """A ball rolls down a hill that turns freely: x V_y and y V_x all but cancel, and were taken for one part."""
    c, s = float(np.cos(turn)), float(np.sin(turn))
    start = {"position": [0.00511 * s, -0.00511 * c], "velocity": [0.1248 * s - 0.0297 * c, -0.1248 * c - 0.0297 * s]}
    body = {"kind": "eccentric-sphere", "radius": 0.164625, "mass": 1.01397, "moments": [0.007473, 0.011016, 0.007473]}
    support = {"kind": "paraboloid", "radius": -1.43869, "friction": 0.46084}
    support |= {"motion": {"kind": "free-axle", "inertia": 0.00125727}}
    run = {"duration": 2.0, "every": 0.028, "method": "taylor"}
    passes(body=body, support=support, start=start | {"spin": 1.00813}, run=run)


def test_a_hemisphere_that_tips_over_its_edge() -> None:
    body = {"kind": "hemisphere", "radius": 0.0189, "mass": 0.1196}
    motion = {"kind": "free-axle", "inertia": 0.003368, "rate": -6.93}
    support = {"kind": "torus-track", "ring_radius": 0.986, "tube_radius": 0.2171, "side": "inside", "motion": motion}
    start = {"position": [0.03865, 0.2256], "velocity": [0.5017, 0.1908]}
    start |= {"attitude": ["1.419 deg", "73.77 deg", "-24.11 deg"]}
    loads = [{"kind": "pivot-friction", "offset": 5.275e-06}]
    run = passes(body=body, support=support, start=start, loads=loads, run={"duration": 2, "every": 0.02})
    assert run.events[-1].kind == "edge"


FLAT = {
    "a ring": (
        {"kind": "ring", "radius": 0.0801, "mass": 0.2086},
        {
            "kind": "paraboloid",
            "radius": -0.8199,
            "motion": {"kind": "precessing-tilt", "angle": "3 deg", "rate": 11.88},
        },
        {"position": [0.03848, 0.1808], "velocity": "co-rotating", "orientation": [1, 0, 0, 0]},
        [{"kind": "force", "value": [-0.007932, 0.033, -0.04224]}],
    ),
    "a disc that starts to slip from rest": (
        {"kind": "disc", "radius": 0.006101, "mass": 0.2091, "thickness": 0},
        {"kind": "paraboloid", "radius": -0.464, "friction": 0.01602},
        {"position": [0.1868, 0.1304], "spin": 1.597},
        [{"kind": "rolling-couple", "coefficient": 9.516e-05}, {"kind": "drag", "coefficient": 0.00389}],
    ),
    "a thick ring that slips on a mound": (
        {
            "kind": "torus",
            "radius": 0.0315268,
            "rim_radius": 0.0245393,
            "mass": 0.0670604,
            "moments": [2.16758e-05, 2.89984e-05, 1.6901e-05],
            "products": [1.60649e-06, 2.9112e-06, 2.60972e-06],
        },
        {"kind": "paraboloid", "radius": -0.154634, "friction": 0.0436124},
        {
            "position": [0.640445, -0.0151401],
            "angular_velocity": [-0.397206, 6.92338, -2.46728],
            "orientation": [-0.0360863, -0.0293762, -0.0290632, -0.529638],
        },
        [],
    ),
}


@pytest.mark.parametrize("kind", FLAT)
def test_a_body_that_comes_to_lie_flat(kind: str) -> None:
    body, support, start, loads = FLAT[kind]
    run = passes(body=body, support=support, start=start, loads=loads, run={"duration": 2, "every": 0.02})
    assert run.events[-1].kind == "edge"


# --- nothing beside nothing ---------------------------------------------------------------------------------


def test_a_disc_that_falls_over_from_rest_has_no_rates_to_drift() -> None:
    # Both constants of the Legendre pair vanish: what is left of them is a rounding of Ω.
    disc = {"kind": "disc", "radius": 0.037, "mass": 0.057, "thickness": 0}
    start = {"position": [0.2, -0.1], "velocity": [0, 0], "attitude": ["94 deg", "40 deg", "-163 deg"]}
    support = {"kind": "plane", "friction": 1.3}
    run = passes(body=disc, support=support, start=start, run={"duration": 0.05, "every": 0.01})
    assert run.card()["drift of the rates when upright (Legendre pair)"].passed


@pytest.mark.parametrize("radius", [1e6, 5e8])
def test_a_cylinder_in_a_drum_as_large_as_the_earth(radius: float) -> None:
    support = {"kind": "cylinder", "radius": radius, "tilt": "90 deg", "friction": 0.6}
    start = {"position": ["6 deg", "0 m"], "velocity": ["0 m/s", "0 m/s"]}
    body = {"kind": "cylinder", "radius": 0.025, "mass": 0.2}
    run = tr.Scenario.loads(tomli_w.dumps({"body": body, "support": support, "start": start, "run": RUN})).run()
    assert run.card()["samples fit together"].passed, str(run.card())


RUN = {"duration": 1, "every": 0.1}


STILL_CENTRES = {
    # A disc that wobbles steadily about a point: Ω lies along ρ, and the contact alone goes round.
    "a disc that wobbles": {
        "body": {"kind": "disc", "radius": 0.0375, "mass": 0.4},
        "support": PLANE,
        "start": {"position": [0, 0], "spin": 4.258621530466869, "attitude": ["0 deg", "15 deg", "0 deg"]},
        "run": {"duration": 0.4, "every": 0.0011},
    },
    "a disc that hovers over what sways": {
        "body": {"kind": "disc", "radius": 0.05, "mass": 0.17, "moments": [1.27e-4, 1.34e-4, 1.43e-4]},
        "support": {
            "kind": "dome",
            "radius": 0.72,
            "restitution": 0.2,
            "motion": {"kind": "wobble", "rate": 12.5, "angle": 0.28},
        },
        "start": {"position": [0.012, -0.023], "height": 0.0136},
        "gravity": 0.0,
        "run": {"duration": 0.09, "every": 0.002},
    },
}


@pytest.mark.parametrize("kind", STILL_CENTRES)
@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
def test_a_centre_that_stands_still_while_its_contact_moves(kind: str, method: str) -> None:
    tables = STILL_CENTRES[kind]
    run = passes(**{**tables, "run": {**tables["run"], "method": method}})
    assert not run.events
    assert np.abs(run.data.velocity.values).max() <= 1e-11
    # A velocity of a millionth of the contact's is told from none.
    again = Again(run.system, run.start, run.samples, Method.of(method))
    at = again.places(again.windows.ravel())
    passing = np.abs(np.gradient(run.samples.contact, run.samples.time, axis=0)).max()
    for velocity, told in ((at.velocity, False), (at.velocity + 1e-6 * passing, True)):
        found = residuals(run.system, replace(at, velocity=velocity), again.windows, again.bound)
        assert (found.path > again.bound) == told


# --- a support that only rounding moves, and the end of a run where the law is singular ----------------------


def on_a_still_axle(body: dict[str, Any], support: dict[str, Any], start: dict[str, Any]) -> dict[str, Any]:
    """What stands over the axle of a support that is free to turn: nothing turns it."""
    axle = {"kind": "free-axle", "inertia": 0.001, "bearing_drag": 1.5e-4, "bearing_torque": 0.0016}
    return {
        "body": body,
        "support": {**support, "motion": axle},
        "start": start,
        "run": {"duration": 1, "every": 0.02},
    }


TRACK = {"kind": "torus-track", "ring_radius": 0.572749, "tube_radius": 0.26177}
STILL_AXLES = {
    "it rolls up and down in a plane through the axle": on_a_still_axle(
        {"kind": "solid-sphere", "radius": 0.0163, "mass": 1.6}, TRACK, {"position": [-0.419634, -0.00623]}
    ),
    "it lies still where it came down": on_a_still_axle(
        {"kind": "half-cylinder", "radius": 0.034, "mass": 0.24},
        {"kind": "plane"},
        {"position": [0.037, 0.063], "height": 0.0112575, "support": [2.47037, 0.0]},
    ),
}


@pytest.mark.parametrize("kind", STILL_AXLES)
def test_an_axle_that_only_rounding_turns_passes(kind: str) -> None:
    run = passes(**STILL_AXLES[kind])
    assert np.abs(run.samples.support_coordinates[:, -1]).max() <= 1e-14


@pytest.mark.parametrize("rate", [4.41542, -4.41542, 0.02, 1e-9])
@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
def test_an_axle_that_its_bearing_stops_under_a_body_in_flight(method: str, rate: float) -> None:
    """Nothing but the bearing is there to measure by, and that has nothing left to do."""
    axle = {"kind": "free-axle", "inertia": 0.002, "rate": rate, "bearing_torque": 2.1}
    support = {"kind": "cylinder", "radius": 0.1, "side": "outside", "friction": 0.54, "motion": axle}
    start = {"position": [-0.246881, 0.0], "velocity": [0.343, 0.513, 0.149], "height": 0.124508}
    body = {"kind": "torus", "radius": 0.075, "rim_radius": 0.069, "density": 6414}
    run = passes(body=body, support=support, start=start, run={"duration": 0.8, "every": 0.015, "method": method})
    again = Again(run.system, run.start, run.samples, Method.of(method))
    at = again.places(again.windows.ravel())
    turned = np.add(at.support_coordinates, (0.0, 1e-9))
    found = residuals(run.system, replace(at, support_coordinates=turned), again.windows, again.bound)
    assert found.law > again.bound  # a thousand-millionth of a radian a second is told


@pytest.mark.usefixtures("through_walls")
def test_the_last_instant_before_a_singular_end_leaves_the_windows_wide() -> None:
    # Where the support is as hollow as the body is round the force is a million times that of all other instants.
    axle = {"kind": "free-axle", "inertia": 0.134335, "bearing_drag": 4.3e-5, "bearing_torque": 0.00215}
    support = {"kind": "ellipsoidal-bowl", "semi_axes": [0.884581, 0.234888, 1.26341], "motion": axle}
    body = {"kind": "sphere-with-moment", "radius": 0.05694, "mass": 0.109359, "moment_of_inertia": 0.000121253}
    start = {"position": [0.0, 0.11782], "velocity": [-0.358536, -0.210173]}
    run = passes(body=body, support=support, start=start, run={"duration": 0.4, "every": 0.004})
    assert run.events[-1].kind == "curved"
    again = Again(run.system, run.start, run.samples, Method.of("taylor"))
    assert np.median(np.ptp(again.windows, axis=1)) >= 1e-4


def test_slopes_of_what_spins_and_hardly_rolls_are_as_sharp_as_its_spin() -> None:
    # An upright disc on a resisting ground that only spins stops turning over it after some 1e-12 s.
    body = {"kind": "disc", "radius": 0.0261228, "density": 2553.64, "thickness": 0.0913427}
    support = {"kind": "height-field", "formula": "0.046*x**2 - 0.0177*cos(0.794*y)**2", "friction": 0.06}
    start = {"position": [0.182744, -0.0361311], "spin": -10.1605, "attitude": [-0.008078, "-90 deg", -0.161969]}
    load = {"kind": "rolling-resistance", "offset": 0.00165337}
    run = passes(loads=[load], body=body, support=support, start=start, run={"duration": 1.0, "every": 0.08})
    assert run.events[-1].kind == "spot"


# --- runs of no length --------------------------------------------------------------------------------------


@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
@pytest.mark.parametrize("speed", [1.0, 1e-3])
@pytest.mark.parametrize("left", [1e-16, 1e-13, 1e-10, 1e-7])
def test_a_run_that_ends_as_it_begins(left: float, speed: float, method: str) -> None:
    # A change of the start that is measured by 1/span alone would set the body spinning at 1e7 rad/s and more.
    bench = tr.RollingSystem(tr.Body.ellipsoid((0.1, 0.1, 0.08), 1.0), tr.Support(tr.Plane(rim=0.5), friction=0.3))
    run = tr.simulate(bench, bench.place((0.5 - left, 0.0), velocity=(speed, 0.1)), 1.0, 0.1, method)
    assert run.events[-1].kind == "rim"
    assert run.card().passed


# --- slip that begins while the body turns fast ---------------------------------------------------------------


@pytest.mark.parametrize("side", [1, -1])
def test_slip_that_begins_in_a_pipe_while_a_ball_spins_at_900_radians_a_second(side: int) -> None:
    # Against slip of 1e-12 m/s the rounding of accelerations of 7000 m/s² is not small: no step would be short enough.
    pipe = {"kind": "cylinder", "radius": "19.8 cm", "tilt": "7.2 deg", "friction": 2.8}
    start = {"position": [f"{-134 * side} deg", "0 m"], "velocity": ["0 m/s", "0 m/s"]}
    ball = {"kind": "solid-sphere", "radius": "9.78 mm", "mass": "149 g"}
    run = passes(body=ball, support=pipe, start=start, run={"duration": 1.4, "every": 0.02})
    assert {"grip", "slip"} <= {event.kind for event in run.events}


# --- a second run that does not come through ------------------------------------------------------------------


def test_what_a_small_change_grows_to_is_known_as_far_as_the_run_itself_comes() -> None:
    # Begun anew at a sample, a run may end sooner than those from changed starts: a rounding before a singular end.
    system = tr.RollingSystem(tr.Body.solid_sphere(0.05, 0.2), tr.Support(tr.Paraboloid(0.3)))
    start = system.place((0.1, 0.0), (0.1, 0.3))
    run = tr.simulate(system, start, 1.0, 0.1, method="taylor")
    asked = []

    class Kept(Dense):
        def __init__(self) -> None: ...

        def like_it(self, start: tr.State, times: Any) -> Any:
            asked.append(start)
            found = Method.of("taylor").solve(system, start, times)
            return found.part(slice(-3)) if len(asked) == 1 else found

    found = growth(system, start, run.samples, Method.of("taylor"), sizes_of(system, run.samples), Kept())
    assert len(asked) > 5
    assert found.magnified.shape == found.times.shape
    assert (found.magnified > 0).any()
    assert not ((found.times > 0.75) & (found.times < 0.95)).any()


def test_a_second_run_that_breaks_down_fails_the_card_and_raises_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    run = tr.Scenario.load("off-the-rim").run(method="taylor")

    def breaks_down(*_: object) -> None:
        raise tr.SolverError("Taylor's method hardly gets on at t = 0.1 s.")

    monkeypatch.setattr(Method, "dense", breaks_down)
    card = run.card()
    assert [figure.name for figure in card.failures] == ["the method run again"]
    assert "hardly gets on at t = 0.1 s" in str(card)


# --- a body that all but lies flat ---------------------------------------------------------------------------------


@pytest.mark.usefixtures("through_walls")
@pytest.mark.parametrize(("x", "spun"), [(0.0125681, 1.0), (0.0125681, 0.3), (0.0121, -1.0)])
def test_a_rounding_of_a_lean_of_a_millionth_is_no_fault(x: float, spun: float) -> None:
    # A disc that lands on its rim and rolls for some microseconds until it lies flat: its contact runs round the rim.
    wavy = {"kind": "height-field", "formula": "0.0317252*sin(4.15766*x)*cos(9.34178*x)", "rim": 0.283498}
    load = {"kind": "torque", "value": [0.000332839 * spun, "6.56851e-05*t**2", 0.00114775 * spun]}
    run = passes(
        body={"kind": "disc", "radius": 0.0184306, "mass": 0.0302301},
        support=wavy,
        loads=[load],
        start={"position": [x, -0.0470776], "velocity": [-0.24001, 0.0]},
        run={"duration": 0.45818, "every": 0.02},
    )
    assert run.events[-1].kind == "edge"


@pytest.mark.parametrize(("friction", "faster"), [(0.243451, 1.0), (0.3, 0.8), (0.5, 1.2)])
def test_a_rounding_of_the_last_lean_is_no_jump(friction: float, faster: float) -> None:
    # A disc that falls onto its face on a mound: at the end a rounding of its orientation moves the contact by 1e-11 m.
    run = passes(
        body={"kind": "disc", "radius": 0.0745393, "mass": 0.242908, "centre": [0.00304138, -0.00438588, 0.0139941]},
        support={
            "kind": "paraboloid",
            "radius": -0.851576,
            "rim": 0.165619,
            "friction": friction,
            "kinetic_friction": 0.0699557,
            "motion": {"kind": "tilt", "angle": "45 deg"},
        },
        start={
            "position": [0.0, 0.00594803],
            "angular_velocity": [1.68137 * faster, 9.55798 * faster, -0.185644 * faster],
        },
        run={"duration": 2, "every": 0.02},
    )
    assert run.events[-1].kind == "edge"


@pytest.mark.parametrize("lean", [0.0065064, -0.005])
@pytest.mark.parametrize("push", [0.0, 3.258])
def test_the_centre_of_a_ring_that_all_but_lies_flat_is_as_sharp_as_its_lean(lean: float, push: float) -> None:
    # A rounding of its orientation moves its contact, and with it the centre, by hundreds of roundings of a place.
    passes(
        body={"kind": "torus", "radius": 0.0917589, "rim_radius": 0.0113727, "density": 1817.93},
        support={"kind": "dome", "radius": 0.487786},
        loads=[
            {"kind": "potential", "formula": f"{push}*x**2"},
            {"kind": "motor", "value": [0.0, -0.00344823, -0.00959075]},
        ],
        start={"position": [0.275874, -0.0610814], "velocity": [0.686436, 1.12357], "attitude": [lean, 0.0058538, 0.0]},
        run={"duration": 2.0, "every": 0.02},
    )


@pytest.mark.parametrize("spin", [-14.982, 14.982, -7.3])
def test_a_spinning_ring_that_touches_the_wall_by_a_rounding_each_half_turn(spin: float) -> None:
    # It falls freely beside an upright wall, and is as far from it after half a turn as before: not at all.
    run = passes(
        body={"kind": "ring", "radius": 0.0519615, "mass": 0.821915},
        support={"kind": "cylinder", "radius": 0.340249, "friction": 0.118612},
        start={"position": [0.0133314, -0.00630666], "angular_velocity": [0.124072, spin, 0.0]},
        run={"duration": 1.25184, "every": 0.02},
    )
    fall = run.samples.position[0, 2] - run.samples.position[:, 2]
    np.testing.assert_allclose(fall, 9.80665 / 2 * run.samples.time**2, rtol=0, atol=1e-6)


@pytest.mark.usefixtures("through_walls")
def test_the_contact_of_a_flight_that_ends_where_none_is_nearest() -> None:
    run = passes(
        body={"kind": "ring", "radius": 0.0567743, "mass": 0.0233263},
        support={
            "kind": "height-field",
            "formula": "0.0309331*sin(23.8839*x)*cos(8.88022*y) + -0.0239599*exp(x)",
            "friction": 0.115313,
            "tangential_restitution": 0.104314,
        },
        start={
            "position": [0.0062303, 0.0798009],
            "velocity": [-1.435, 0.0587431, -0.0544254],
            "orientation": [-0.512733, -0.0514721, -0.0234051, -0.394995],
            "time": -0.469896,
        },
        run={"duration": 1.60406, "every": 0.0518702},
    )
    assert [event.kind for event in run.events] == ["curved"]


def test_what_comes_off_while_it_spins_fast_is_no_longer_pressed_on() -> None:
    # At 130 rad/s a rounding of |q| by Runge-Kutta's method was 1e-9 N of the normal force.
    run = passes(
        body={
            "kind": "formula",
            "support_function": "0.0440204 + 0.00354838*nu_z + 0.00252959*nu_z**2",
            "density": 1292.76,
        },
        support={"kind": "plane", "tilt": -0.104085, "friction": 0.0233857},
        loads=[{"kind": "torque", "value": [-0.0336972, -0.00348294, "-0.00250331*t*exp(-t)"]}],
        start={
            "position": [0.303598, 0.00475827],
            "angular_velocity": [0.0, 10.6626, 0.0],
            "attitude": [-1.38068, 0.118222, 0.11984],
            "height": 0.00472142,
        },
        run={"duration": 2.0, "every": 0.02, "method": "runge-kutta"},
    )
    assert sum(event.kind == "lift" for event in run.events) > 5


def test_two_runs_that_have_parted_are_in_any_phase() -> None:
    # It slips this way and that a hundred times; from other events on both may have as many behind them all the same.
    run = passes(
        body={
            "kind": "torus",
            "radius": 0.0410312,
            "rim_radius": 0.031131,
            "density": 3286.5,
            "moments": [1.71741e-05, 1.6145e-05, 9.72972e-06],
            "centre": [-0.0188899, 0.00307802, -0.00457407],
        },
        support={"kind": "bowl", "radius": 0.182278, "friction": 0.24915},
        loads=[
            {"kind": "torque", "value": [0.263358, 0.0129676, 0.0]},
            {"kind": "force", "value": [-1.11762, -0.643008, "4.50773*exp(-14.6818*t)"]},
        ],
        start={
            "position": [0.126051, -0.023398],
            "attitude": [1.32609, "45 deg", 0.0355373],
            "time": -0.107586,
        },
        run={"duration": 2.0, "every": 0.02},
    )
    phase = run.data.phase.copy(deep=True)
    assert phase[3] == FLIGHT
    phase[3] = ROLLING
    assert not replace(run, data=run.data.assign(phase=phase), _kept={}).card()["phase"].passed


def test_a_cylinder_that_stops_turning_over_a_table_that_rocks_stops_at_one_instant() -> None:
    # Where its turning has all but ended it goes on straight, by its rate over a table that speeds up itself.
    run = passes(
        body={"kind": "cylinder", "radius": 0.098414, "mass": 0.0181838},
        support={
            "kind": "plane",
            "motion": {"kind": "rock", "amplitude": -0.220624, "rate": 13.6622, "phase": "-90 deg"},
        },
        loads=[
            {"kind": "rolling-resistance", "offset": 5.92597e-05},
            {"kind": "force", "value": [0.00448208, 0.0, -0.0826896]},
        ],
        start={"position": [-0.193119, 0.0], "time": 1.8609},
        run={"duration": 2.0, "every": 0.00262831},
    )
    finer = partial(runge_kutta.solve, tolerance=1e-13)
    found = [
        [event.time for event in solve(run.system, run.start, np.linspace(1.8609, 3.0, count)).events][:5:2]
        for solve, count in ((finer, 7), (taylor.solve, 7), (taylor.solve, 50), (taylor.solve, 333))
    ]
    np.testing.assert_allclose(found[1:], [found[0]] * 3, rtol=0, atol=1.5e-13)


def test_a_rounding_of_the_arm_turns_a_body_that_is_light_to_turn() -> None:
    # 130 kg with the moments of a gram or so: a blow of 500 N s all but through its centre.
    body = {"kind": "torus", "radius": 0.155801, "rim_radius": 0.0803826, "density": 6617.34}
    support = {"kind": "plane", "rim": 0.261342, "friction": 0.369436}
    run = passes(
        body=body | {"moments": [0.000629289, 0.00103358, 0.000550821]},
        support=support | {"motion": {"kind": "wobble", "rate": -19.1455, "angle": "90 deg"}},
        start={"position": [0.0310921, 0.0617143], "height": 0.0695909},
        run={"duration": 0.579049, "every": 0.02},
    )
    assert [event.kind for event in run.events] == ["land", "rim"]


@pytest.mark.parametrize("faster", [1.0, 1.1])
def test_a_millionth_of_a_second_between_a_landing_and_a_singular_end_is_followed(faster: float) -> None:
    run = passes(
        body={"kind": "ring", "radius": 0.102157, "mass": 0.0112842},
        support={
            "kind": "torus-track",
            "ring_radius": 1.54879,
            "tube_radius": 1.40437,
            "side": "outside",
            "motion": {"kind": "uneven-spin", "rate": 1.66197 * faster, "variation": -0.05598, "variation_rate": 0.164},
        },
        loads=[
            {"kind": "rolling-resistance", "offset": 9.86194e-05},
            {"kind": "drag", "coefficient": 0.000222475, "air": "turning"},
        ],
        start={"position": [-0.265666, 0.15565], "orientation": [0.312042, -0.0855334, -0.02126, -0.699833]},
        run={"duration": 2.0, "every": 0.02},
    )
    *_, landed, ended = run.events
    assert ended.time - landed.time < 1e-5


@pytest.mark.usefixtures("through_walls")
@pytest.mark.parametrize("height", [0.03, 0.06, 0.0837479])
def test_a_flight_to_where_the_track_is_as_hollow_as_the_ring(height: float) -> None:
    # The place that is nearest there is known to a root of a rounding only: it differs from one instant to the next.
    run = passes(
        body={"kind": "ring", "radius": 0.0168899, "mass": 0.0250152},
        support={
            "kind": "torus-track",
            "ring_radius": 0.477418,
            "tube_radius": 0.148235,
            "friction": 0.92294,
            "kinetic_friction": 0.0,
            "restitution": 0.187614,
            "tangential_restitution": 0.415956,
            "motion": {
                "kind": "tilt",
                "angle": "0.190064*sqrt(1 + 0.682492*t)",
                "axis": [0.0, 0.0753854, -0.181466],
            },
        },
        start={
            "position": [-0.00595304, 0.0],
            "orientation": [-0.168692, -0.0277025, -0.0312925, -0.174921],
            "height": height,
        },
        run={"duration": 0.950409, "every": 0.0205301},
    )
    assert [event.kind for event in run.events] == ["land", "curved"]


# --- rest ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("position", [[0.0577, 0.0], [-0.03, 0.02]])
@pytest.mark.parametrize("kind", ["ellipsoidal-bowl", "paraboloid"])
def test_an_ellipsoid_at_rest_in_a_bowl_touches_where_it_was_put(kind: str, position: list[float]) -> None:
    # Under its centre the bowl has another normal than where it touches.
    shape = {"semi_axes": [1.25, 0.3, 0.1]} if kind == "ellipsoidal-bowl" else {"radius": 0.9}
    body = {"kind": "ellipsoid", "semi_axes": [0.01, 0.02, 0.03], "mass": 0.1}
    support = {"kind": kind, "friction": 0.5} | shape
    start = {"position": position, "orientation": [0.9, 0.1, 0.3, 0.2]}
    loads = [{"kind": "rolling-resistance", "offset": 0.02}]
    tables: dict[str, Any] = {"body": body, "support": support, "start": start, "loads": loads}
    run = passes(**tables, gravity=0.0, run={"duration": 1, "every": 0.1})
    assert run.method == "exact"
    again = tr.Scenario.loads(tomli_w.dumps(tables | {"gravity": 0.0, "run": {"duration": 1, "every": 0.1}}))
    numerical = again.run(method="runge-kutta")
    assert np.abs(run.samples.contact - numerical.samples.contact).max() <= 1e-15


# --- rolling without weight -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("way", [-1, 1])
@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
def test_a_cylinder_that_lands_without_weight_asks_for_no_friction(method: str, way: int) -> None:
    # It is set down by an impulse, and rolls on straight: all that is left of a contact force is rounding.
    body = {"kind": "eccentric-cylinder", "radius": 0.103888, "mass": 0.75288, "moment_of_inertia": 0.00303285}
    support = {"kind": "plane", "friction": 0.40902, "motion": {"kind": "tilt", "angle": -0.0252976}}
    start = {"position": [0, 0.173466], "velocity": [-0.720166 * way, -0.232072 * way, -0.529724]}
    run = passes(
        body=body, support=support, start=start, gravity=0.0, run={"duration": 2, "every": 0.1, "method": method}
    )
    assert [event.kind for event in run.events] == ["land"]


# --- every load on a plane ------------------------------------------------------------------------------------------

LOADS: dict[str, list[dict[str, Any]]] = {
    "rolling resistance": [{"kind": "rolling-resistance", "offset": 1e-4}],
    "pivot friction": [{"kind": "pivot-friction", "offset": 1e-4}],
    "both": [{"kind": "rolling-resistance", "offset": 1e-4}, {"kind": "pivot-friction", "offset": 1e-4}],
    "couple": [{"kind": "rolling-couple", "coefficient": 1e-5, "pivot_coefficient": 3e-5}],
    "drag": [{"kind": "drag", "coefficient": 0.03}],
    "quadratic drag": [{"kind": "quadratic-drag", "coefficient": 0.3}],
    "turning air": [{"kind": "quadratic-drag", "coefficient": 0.3, "air": 2.0}],
    "magnus": [{"kind": "magnus", "coefficient": 1e-3}],
    "motor": [{"kind": "motor", "value": [1e-5, "2e-5*cos(3*t)", 1e-5]}],
    "potential": [{"kind": "potential", "formula": "0.3*x**2 + 0.02*y + 0.01*abs(y - 0.01)"}],
    "force and torque": [{"kind": "force", "value": [0.01, "0.02*t", 0]}, {"kind": "torque", "value": [0, 1e-4, 1e-4]}],
}


@pytest.mark.parametrize("method", ["auto", "taylor", "runge-kutta"])
@pytest.mark.parametrize("start", [{}, {"velocity": [0.3, 0.1], "spin": 4}, {"velocity": [-0.2, 0]}, {"spin": -7}])
@pytest.mark.parametrize("tilt", [0.0, 0.06, -0.04])
@pytest.mark.parametrize("load", LOADS)
def test_a_ball_on_a_plane_under_each_load(load: str, tilt: float, start: dict[str, Any], method: str) -> None:
    body = {"kind": "solid-sphere", "radius": 0.02, "mass": 0.05}
    tables: dict[str, Any] = {"body": body, "support": {"kind": "plane", "tilt": tilt}, "loads": LOADS[load]}
    tables |= {"start": {"position": [0, 0]} | start, "run": {"duration": 0.6, "every": 0.02, "method": method}}
    if tilt == 0 and start == {"spin": -7} and "resistance" in str(LOADS[load]):
        with pytest.raises(tr.SolverError, match="only spins about the normal"):
            passes(**tables)
    else:
        passes(**tables)


# --- slip that is given back ----------------------------------------------------------------------------------------


def test_a_bounce_that_slip_given_back_would_undo() -> None:
    # With the slip that e_t gives back the point would come down again, so none is given back; then it bounces.
    moments = [0.00121653, 0.00129278, 0.00124872]
    body = {"kind": "disc", "radius": 0.143822, "mass": 0.252036, "moments": moments}
    support = {"kind": "dome", "radius": 0.552497, "restitution": 0.0331066, "tangential_restitution": 0.581215}
    spin = {"kind": "spin-by", "rate": "4.76321*cos(0.493665*t) + 1.65146"}
    run = passes(
        body=body | {"centre": [0.0191152, 0.0396028, 0.0179448]},
        support=support | {"motion": spin},
        start={"position": [0.391886, 0.0794833], "height": 0.00695833},
        run={"duration": 2, "every": 0.0574613},
    )
    assert [event.kind for event in run.events] == ["land", "land", "settle", "lift"]


# --- a place that hardly moves ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_a_start_beside_the_axis_of_a_rocking_support_is_no_landing(friction: float, method: str) -> None:
    # All that moves there is rounding, of which a share is no landing and no slip.
    body = {"kind": "sphere", "radius": 0.0129984, "mass": 0.0275282, "inertia_ratio": 0.0745848}
    support = {"kind": "height-field", "formula": "0.0894379*x**2 + 0.133397*sin(1.27826*x)", "friction": friction}
    rock = {"kind": "rock", "amplitude": 0.543352, "rate": -1.87797}
    start = {"position": [0.0, -0.00973892], "attitude": [0.0279771, -0.0345912, -1.5707963], "time": -1.05763}
    run = passes(
        body=body,
        support=support | {"motion": rock},
        start=start,
        run={"duration": 0.5, "every": 0.02, "method": method},
    )
    assert "land" not in {event.kind for event in run.events}


# --- friction that the resistance uses up -----------------------------------------------------------------------------


@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
@pytest.mark.parametrize("tilt", [0.05, -0.05])
@pytest.mark.parametrize(("share", "slips"), [(1 - 1e-6, True), (1 + 1e-6, False)])
def test_from_rest_friction_is_to_give_what_rolling_against_resistance_takes(
    share: float, slips: bool, tilt: float, method: str
) -> None:
    # J Ω' = a f − δ N and m V' = m g sin α − f, V' = a Ω': f = (J m g sin α + m a δ N)/(J + m a²).
    m, a, J, offset, g = 0.05, 0.02, 1e-5, 1e-4, 9.80665
    N, down = m * g * math.cos(tilt), m * g * math.sin(abs(tilt))
    needed = (J * down + m * a * offset * N) / (J + m * a * a)
    mu = share * needed / N
    run = passes(
        body={"kind": "sphere-with-moment", "radius": a, "mass": m, "moment_of_inertia": J},
        support={"kind": "plane", "tilt": tilt, "friction": mu},
        loads=[{"kind": "rolling-resistance", "offset": offset}],
        start={"position": [0, 0]},
        run={"duration": 0.6, "every": 0.1, "method": method},
    )
    f, t = min(mu * N, needed), run.samples.time
    assert set(run.samples.phase.tolist()) == {int(slips)}
    assert np.abs(run.samples.angular_velocity[:, 1] * np.sign(tilt) - (a * f - offset * N) / J * t).max() < 1e-9
    assert np.abs(run.samples.velocity[:, 0] * np.sign(tilt) - (down - f) / m * t).max() < 1e-11


@pytest.mark.parametrize("spin", [90.0, 155.0, -155.0, 220.0])
@pytest.mark.parametrize("friction", [3.0, 7.9345])
def test_at_the_very_grip_the_force_of_a_rounding_is_none(spin: float, friction: float) -> None:
    # At its grip a slip of 1e-14 m/s has the direction of its rounding, and so would have f = −μ N ŝ, and N by it.
    moments = (2.994285714285714e-6, 2.994285714285714e-6, 3.93645e-6)
    top = tr.Body.eccentric_sphere(0.02, 0.276328, moments, centre=(0.0, 0.0, 0.006))
    system = tr.RollingSystem(top, tr.Support(tr.Plane(), friction=friction))
    start = system.place(attitude=(0.0, 0.1, 0.0), angular_velocity=(0.0, 0.0, spin))
    run = tr.simulate(system, start, duration=0.05, every=0.0005)
    assert [event.kind for event in run.events] == ["grip"]
    assert run.card()["normal force"].passed


@pytest.mark.parametrize("place", ["0 m", "300 m", "3000 m"])
def test_a_weighted_cylinder_that_sticks_and_slips_far_from_the_origin(place: str) -> None:
    # ρ is the small difference of two places: a slope takes its rounding twenty times, over half of a short window.
    body = {"kind": "weighted-cylinder", "radius": "104.816 mm", "mass": "708.144 g", "weight": "125.721 g"}
    passes(
        body=body | {"distance": "26.2522 mm"},
        support={"kind": "plane", "tilt": "-7.81827 deg", "friction": 0.195706},
        start={"position": [place, "0 m"], "roll": "-150.918 deg"},
        run={"duration": 8.8, "every": 0.02},
    )


def test_a_slope_takes_an_error_of_its_places_twenty_times_at_most() -> None:
    times = window_times(0.0, 1.0, 3.0)[:1]
    half = 0.5 * (times[0, -1] - times[0, 0])
    weights = [_slope_at_middle(times, error[None, :])[0] * half for error in np.eye(times.size)]
    assert 0.99 * _SLOPE < np.abs(weights).sum() <= _SLOPE


def test_a_weighted_cylinder_that_comes_down_at_a_tenth_of_a_millimetre_a_second_while_it_turns_fast() -> None:
    # At 190 rad/s Ω×ρ is off by 1e-13 m/s where the place has so few digits, and the impulse by so much of the mass.
    body = {"kind": "weighted-cylinder", "radius": "25.725 mm", "mass": "445.787 g", "weight": "26.7027 g"}
    run = passes(
        body=body | {"distance": "4.6331 mm"},
        support={"kind": "plane", "tilt": "11.3674 deg", "friction": 2.10721},
        start={"position": [0.436585, 0.348528], "roll": "-463.095 deg"},
        run={"duration": 3.9, "every": 0.1},
    )
    assert sum(event.kind == "land" for event in run.events) > 3


@pytest.mark.parametrize("velocity", [-0.582166, -0.3])
def test_slip_that_creeps_takes_few_steps(velocity: float, monkeypatch: pytest.MonkeyPatch) -> None:
    # It lags by a slope of a slope. Over too short a time that is rounding, and a method takes a thousand steps.
    taken: list[int] = []
    after = Patience.after

    def counted(patience: Patience, steps: int, *rest: float) -> None:
        taken.extend([steps] * (patience.name != "The run"))  # which counts stretches
        after(patience, steps, *rest)

    monkeypatch.setattr(Patience, "after", counted)
    run = passes(
        gravity=0.0,
        loads=[{"kind": "rolling-couple", "coefficient": 4.24222e-06, "pivot_coefficient": 3.58037e-05}],
        body={"kind": "half-cylinder", "radius": 0.174, "density": 5668, "length": 0.02, "moment_of_inertia": 1.057e-3},
        support={"kind": "torus-track", "ring_radius": 0.6274, "tube_radius": 0.2867, "friction": 0.145571},
        start={"position": [-0.0126758, "180 deg"], "velocity": [0, velocity]},
        run={"duration": 1.0, "every": 0.02},
    )
    assert any(event.kind == "slip" for event in run.events)
    assert len(taken) < 60


@pytest.mark.parametrize("torque", [0.0126241, -0.0126241, 0.03])
@pytest.mark.parametrize("inertia", [0.00534196, 0.05])
def test_an_axle_that_settles_at_once_under_a_body_in_flight_is_followed_in_narrow_windows(
    torque: float, inertia: float
) -> None:
    axle = tr.FreeAxle(inertia, motor_torque=torque, bearing_torque=0.0390261)
    system = tr.RollingSystem(tr.Body.ring(0.05, 1.58663), tr.Support(tr.Plane(), motion=axle))
    start = system.place((0.3, 0.0), attitude=(0.8, 1.2, 0.0), height=0.9)
    run = tr.simulate(system, start, 0.4, 0.01)
    assert run.samples.phase[-1] == FLIGHT
    assert run.card().passed, str(run.card())


@pytest.mark.parametrize("spin", [0.0, 1e-14, -1e-14, 1e-9, -1e-6, 1e-3, -1e-3, 0.1, 10.0, -10.0, -20.0])
@pytest.mark.parametrize("every", [0.0002, 0.01, 0.1, 2.0])
def test_a_run_from_near_rest_that_ends_at_an_edge_has_windows_as_wide_as_its_motion_allows(
    every: float, spin: float
) -> None:
    """All but at rest forces show no rate: in windows of 10⁻¹² s all slopes are rounding, and in 10⁻⁴ s near an edge.

    Where start and edge are all the samples, only the last one shows how fast the body came to move.
    """
    body = {"kind": "disc", "radius": 0.0111582, "density": 524.104, "thickness": 0.0202322}
    off = {"centre": [-0.0030152, -0.00893241, 0.00932234]}
    support = {"kind": "dome", "radius": 0.150259, "friction": 0.0484944, "motion": {"kind": "tilt", "angle": 0.123139}}
    start = {"position": [0.0523731, -0.00837106], "spin": spin, "attitude": [-1.16503, -0.0330119, 0.0]}
    run = tr.Scenario.read(
        {"body": body | off, "support": support, "start": start, "run": {"duration": 2.0, "every": every}}
    ).run()
    assert [event.kind for event in run.events] == ["edge"]
    assert run.card().passed, run.card().failures


@pytest.mark.parametrize("roll", [0.266909, -0.266909, 0.9])
@pytest.mark.parametrize("moment", [6.92438e-05, 6.92438e-07])
def test_a_body_that_turns_back_against_resistance_begins_with_the_least_turn(roll: float, moment: float) -> None:
    """Of a body that is slow to turn this first turn is no longer a rounding of how fast it comes to turn."""
    body = {"kind": "half-cylinder", "radius": 0.013592, "density": 1473.23, "length": 0.0195219}
    run = passes(
        loads=[
            {"kind": "rolling-resistance", "offset": 1.51258e-05},
            {"kind": "pivot-friction", "offset": 2.06248e-05},
        ],
        body=body | {"moment_of_inertia": moment},
        support={"kind": "plane", "tilt": 0.0841393},
        start={"position": [0.0409548, 0.0102629], "roll": roll},
        run={"duration": 2.0, "every": 0.02},
    )
    assert {"stop", "start"} <= {event.kind for event in run.events}


# --- samples all but at an event --------------------------------------------------------------------------------------

CYLINDER = {"kind": "weighted-cylinder", "radius": 0.035, "mass": 0.01, "weight": 0.07, "distance": 0.03}
TILTED = {"kind": "plane", "friction": 0.3, "motion": {"kind": "precessing-tilt", "angle": 0.058, "rate": 0.0}}
NEAR_EVENTS: dict[str, dict[str, Any]] = {  # each rolls, slips and grips in turns
    "a weighted cylinder": {"body": CYLINDER, "support": TILTED, "start": {"position": [0.0, 0.2]}},
    "a ring in a bowl": {
        "body": {"kind": "ring", "radius": 0.044, "mass": 0.08},
        "support": {"kind": "bowl", "radius": 0.52, "friction": 0.27, "motion": {"kind": "spin", "rate": 0.95}},
        "loads": [{"kind": "torque", "value": [1.2e-3, 0.0, 3.6e-4]}],
        "start": {"position": [-0.011, -0.126], "velocity": "co-rotating", "height": 0.003},
    },
}


@pytest.fixture(scope="module")
def near_events() -> dict[tuple[str, str], tr.Trajectory]:
    runs = {}
    for kind, tables in NEAR_EVENTS.items():
        scenario = tr.Scenario.loads(tomli_w.dumps(tables | {"run": {"duration": 0.6, "every": 0.1}}))
        runs |= {(kind, method): scenario.run(method) for method in ("taylor", "runge-kutta")}
    return runs


@pytest.mark.parametrize("aside", [sign * 10.0**-k for k in (7, 8, 9, 10, 11, 12) for sign in (-1, 1)])
@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
@pytest.mark.parametrize("kind", NEAR_EVENTS)
def test_friction_of_slip_that_is_all_but_over_is_as_sharp_as_the_slip(
    kind: str, method: str, aside: float, near_events: dict[tuple[str, str], tr.Trajectory]
) -> None:
    run = near_events[kind, method]
    events = [event.time for event in run.events if not event.final]
    assert {"slip", "grip"} <= {event.kind for event in run.events}
    times = np.array([run.start.time, *(time + aside for time in events)])
    card = run.at(times[times <= run.data.time.values[-1]]).card()
    assert card.passed, str(card)


# --- a power that jumps -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("flies", "at"),
    [(flies, at) for flies, count in ((True, 25), (False, 6)) for at in np.linspace(0.30, 0.3417, count)],
)
def test_energy_is_balanced_wherever_in_a_panel_a_force_turns_round(flies: bool, at: float) -> None:
    """Between a panel's end and the quadrature's nearest node, too: 0.3017 s and 0.34 s for one that flies."""
    uneven = tr.Potential("2*t**2 + 3*abs(x)")  # it depends on the time: its work is summed up
    ball = tr.RollingSystem(tr.Body.solid_sphere(0.05, 1.0), tr.Support(tr.Plane()), loads=(uneven,))
    start = ball.place(position=(-at, 0.0), velocity=(1.0, 0.0), height=6.0 if flies else 0.0)
    balance = tr.simulate(ball, start, 1.0, 0.01).card()["energy balance"]
    assert balance.passed, str(balance)
    assert balance.bound < 1e-11


@pytest.mark.parametrize("rate", [0.41, -0.41, 0.9])
@pytest.mark.parametrize("time", [-0.0111119, 0.05, 0.2])
def test_a_body_without_weight_comes_off_within_rounding_of_what_sets_its_support_going(
    rate: float, time: float
) -> None:
    """Friction without a limit holds it at N = 0 and a rounding less, of the forces that it takes to follow a drum."""
    body = {"kind": "eccentric-cylinder", "radius": 0.0808, "mass": 0.187, "moment_of_inertia": 0.00057}
    motion = {"kind": "uneven-spin", "rate": rate, "variation": -0.92, "variation_rate": 14.3}
    support = {"kind": "cylinder", "radius": 0.2385, "motion": motion}
    load = {"kind": "magnus", "coefficient": -1.3e-4}
    start = {"position": [-0.02365, -1.0724], "time": time}
    times = {"duration": 0.5, "every": 0.01, "method": "taylor"}
    run = passes(body=body, support=support, loads=[load], gravity=0.0, start=start, run=times)
    pulled = replace(run.samples, contact_force=run.samples.contact_force - 1e-11 * run.samples.normals(run.system))
    card = verify.card(run.system, run.start, pulled, Method.of("taylor"))
    assert not card["normal force"].passed


@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
def test_a_body_that_falls_along_a_wall_may_come_off_where_all_but_nothing_presses_it_on(method: str) -> None:
    """It falls at 17 m/s, and N goes through zero by less than a nanonewton in a millisecond."""
    text = f"""
    loads = [{{ kind = "drag", coefficient = 0.00332103 }}]
    run = {{ duration = 2.0, every = 0.0138995, method = "{method}" }}
    [body]
    kind = "disc"
    radius = 0.0346872
    density = 302.653
    thickness = 0.0788359
    moments = [4.757e-05, 3.70052e-05, 2.58622e-05]
    [support]
    kind = "cylinder"
    radius = 0.156657
    friction = 0.130745
    motion = {{ kind = "uneven-spin", rate = 0.0, variation = 0.0468105, variation_rate = 3.71103 }}
    [start]
    position = [0.0492966, 0.0]
    spin = -0.364578
    orientation = [0.681346, -0.183789, -0.269423, -0.762199]
    """
    run = tr.Scenario.loads(text).run()
    assert [event.kind for event in run.events] == ["lift"]
    assert run.card().passed, str(run.card())


@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
@pytest.mark.parametrize("every", [0.02, 0.003])
def test_the_energy_of_a_disc_that_comes_to_its_edge_balances_to_what_steps_leave_of_its_lean(
    method: str, every: float
) -> None:
    """Where it all but lies flat, ρ moves by millions of times a rounding of the lean; a step leaves five of these."""
    text = f"""
    run = {{ duration = 2.0, every = {every}, method = "{method}" }}
    [body]
    kind = "disc"
    radius = 0.177187
    mass = 0.00698757
    moments = [8.40429e-05, 5.87074e-05, 7.72633e-05]
    products = [6.16891e-06, 7.4925e-06, -9.65923e-06]
    centre = [-0.003957, -0.00989414, -0.00463477]
    [support]
    kind = "dome"
    radius = 0.264977
    motion = {{ kind = "shake", amplitude = [0.0160765, -0.00784157, -0.00902513], rate = -26.6556 }}
    [start]
    position = [-0.0770138, -0.0517556]
    velocity = [-0.155306, -0.263807, -0.308237]
    attitude = [-0.025498, -0.493775, 0.167696]
    time = 0.128214
    """
    run = tr.Scenario.loads(text).run()
    assert run.events[-1].kind == "edge"
    assert run.card().passed, str(run.card())
