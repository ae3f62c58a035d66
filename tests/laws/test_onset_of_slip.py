"""The first moment of slip, which is worked out by hand, is one in which nothing has changed much."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import trundle as tr
from trundle.mechanics.algebra import E_Z, Vector
from trundle.mechanics.system import State
from trundle.solve import corners, integrators, runge_kutta, taylor, transitions
from trundle.solve.coming_off import lift_at_hand
from trundle.solve.contact_state import ContactState
from trundle.solve.creeping import SEEN, CreepingLaw
from trundle.solve.laws import Law, RollingLaw, SlippingLaw
from trundle.solve.lowering import Lowered
from trundle.solve.slip_onset import slip_onset
from trundle.solve.tracing import python_law
from trundle.solve.transitions import PhaseStart

RADIUS = 0.327145
# A ring that fell on its side in a bowl, which is all but as hollow there: the contact runs round the ring within
# microseconds, at 6 km/s, while the body itself is slow.
BEGINS_TO_SLIP = State(
    position=(0.0003951134553605382, -0.0006256189655703291, 0.00025102506859040223),
    velocity=(0.0016841744961171431, -0.003043633115433175, 0.1804494004340376),
    angular_velocity=(19.84515554349772, -5.029266766609537, -0.2700436963166922),
    orientation=(0.9753469692100666, -0.0007925735595922178, -0.0008087810256041614, -0.2206739843142886),
    time=1.4856878371815403,
    support=(4.164188091545752e-06, 3.7962706654832477e-06),
)
POINT = Vector(-0.010746963997333244, -0.006894802410241252, 0.00024927428679377933)


CENTRE = E_Z * RADIUS


def ring_in_a_bowl(*loads: tr.Load) -> tuple[tr.RollingSystem, ContactState]:
    motion = tr.FreeAxle(0.110672, bearing_torque=0.000330105)
    bowl = tr.Support(tr.Bowl(RADIUS), friction=0.0222479, motion=motion)
    system = tr.RollingSystem(tr.Body.ring(0.0127847, 0.0118486), bowl, loads=loads)
    return system, ContactState.of(system, BEGINS_TO_SLIP, POINT)


def test_a_contact_that_runs_fast_stays_on_the_surface() -> None:
    begun: Any = slip_onset(*ring_in_a_bowl())
    point = begun.at.contact.point
    assert (point - POINT).norm() > 1e-10  # it has moved
    assert abs((point - CENTRE).norm() - RADIUS) < 1e-15


def looks_for_a_lift() -> None:
    system, at = ring_in_a_bowl()
    law = RollingLaw()
    lift_at_hand(system, law, at.state.time, law.state_vector(at), "slip", ())


def looks_beyond_a_corner() -> None:
    x, y, _ = BEGINS_TO_SLIP.position
    system, at = ring_in_a_bowl(tr.Potential(f"1e-6*sqrt((x - {x!r})**2 + (y + {-y!r})**2)"))
    now = PhaseStart.of(RollingLaw(), at)
    corners.directions(system, corners.beyond(system, now))


def looks_whether_the_contact_opens() -> None:
    transitions._opens(*ring_in_a_bowl())


@pytest.mark.parametrize(
    "looks",
    [looks_for_a_lift, looks_beyond_a_corner, looks_whether_the_contact_opens, lambda: slip_onset(*ring_in_a_bowl())],
)
def test_every_step_by_hand_is_so_short_that_its_halves_lead_to_the_same(
    looks: Callable[[], object], monkeypatch: pytest.MonkeyPatch
) -> None:
    plain, apart = Law.rk4_step, []

    def watched(law: Law, system: Any, time: Any, state: Any, step: Any, known: Any = None) -> list[Any]:
        whole = plain(law, system, time, state, step, known)
        half = plain(law, system, time, state, step / 2, known)
        halves = plain(law, system, time + step / 2, half, step / 2, known)
        apart.append(max(abs(one - other) for one, other in zip(whole[:10], halves[:10], strict=True)))
        return whole

    monkeypatch.setattr(Law, "rk4_step", watched)
    looks()
    assert max(apart) <= 1e-9


SHAKEN = tr.Support(tr.Plane(), motion=tr.Shake(amplitude=(0.05, 0.02, 0.0), rate=20.0), friction=0.2)
GIVES_WAY = {
    "an egg": tr.Body.ellipsoid((0.02, 0.025, 0.03), 0.1),
    "a flat stone": tr.Body.ellipsoid((0.03, 0.025, 0.01), 0.1),
}


@pytest.mark.parametrize("which", GIVES_WAY)
def test_the_first_moment_of_slip_is_followed_in_few_steps(which: str, monkeypatch: pytest.MonkeyPatch) -> None:
    # In a hundred slips it took half of the run: three or four steps were tried that were far too long.
    counts = list[dict[str, int]]()
    plain = runge_kutta.python_law

    def counted(system: Any, law: Law, *given: Any) -> Any:
        traced = plain(system, law, *given)
        if not isinstance(law, CreepingLaw):
            return traced
        counts.append(count := {"rates": 0, "event_functions": 0})

        def counting(name: str) -> Callable[..., Any]:
            def called(*state: Any) -> Any:
                count[name] += 1
                return getattr(traced, name)(*state)

            return called

        return replace(traced, **{name: counting(name) for name in count})

    monkeypatch.setattr(runge_kutta, "python_law", counted)
    system = tr.RollingSystem(GIVES_WAY[which], SHAKEN)
    tr.simulate(system, system.place(), duration=0.4, every=0.1, method="runge-kutta")
    assert counts
    assert max(count["rates"] for count in counts) <= 47  # of which a step takes fifteen
    # Nine looks at each of one to three steps: where it is handed on needs no more digits than the law itself has left.
    assert max(count["event_functions"] for count in counts) <= 35


@pytest.mark.parametrize("which", GIVES_WAY)
def test_where_the_first_moment_is_handed_on_does_not_show(which: str, monkeypatch: pytest.MonkeyPatch) -> None:
    system = tr.RollingSystem(GIVES_WAY[which], SHAKEN)

    def run() -> tr.Trajectory:
        return tr.simulate(system, system.place(), duration=0.1, every=0.01, method="runge-kutta")

    about = run()
    monkeypatch.setattr(CreepingLaw, "handed_on", ())
    to_the_last_digit = run()
    assert "slip" in {event.kind for event in about.events}
    for name in ("position", "velocity", "angular_velocity", "orientation"):
        apart = abs(about.data[name] - to_the_last_digit.data[name]).max() / abs(about.data[name]).max()
        assert float(apart) <= 1e-12


def first_slip(system: tr.RollingSystem, patch: pytest.MonkeyPatch) -> tuple[CreepingLaw, PhaseStart]:
    """Return the law that a slip begins with, and what follows it."""
    found, plain = list[PhaseStart](), taylor.integrate

    def watched(system: Any, now: PhaseStart, *given: Any, **named: Any) -> Any:
        found.append(now)
        return plain(system, now, *given, **named)

    patch.setattr(taylor, "integrate", watched)
    tr.simulate(system, system.place(), duration=0.1, every=0.01, method="taylor")
    which = next(i for i, now in enumerate(found) if isinstance(now.law, CreepingLaw))
    law = found[which].law
    assert isinstance(law, CreepingLaw)
    return law, found[which + 1]


@pytest.mark.parametrize("which", GIVES_WAY)
def test_the_direction_that_friction_keeps_is_the_one_to_which_slip_settles(
    which: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Followed with its direction, the same slip shows what is left out of it: about what the law says itself."""
    system = tr.RollingSystem(GIVES_WAY[which], SHAKEN)
    creeping, following = first_slip(system, monkeypatch)
    leg = taylor.dense(system, following, following.time + 1.0, 1e-15, 100_000)
    since, first = creeping.since, following.time - creeping.since
    seen = list[tuple[float, float]]()
    for after in np.geomspace(1.2 * first, min(30 * first, 0.06 * creeping.step / SEEN), 25):
        (state,) = leg.states(np.array([since + after])).tolist()
        slip = Vector(*state[10:13])
        numbers = [*state[:10], slip.norm(), *state[13:]]
        hat, settling, left_out = creeping._way(system, since + after, numbers)
        if settling * after > 60 * slip.norm():  # so many times it has settled: with fewer, further terms count
            seen.append(((slip / slip.norm() - hat).norm(), abs(left_out)))
    assert len(seen) > 15
    trembles = 2e-10  # by what series leave of so fast a settling
    assert all(off <= trembles + 3 * left_out for off, left_out in seen), seen


def test_an_end_of_slip_that_heyoka_passes_over_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    """It lay at the very end of a step: from there on steps get shorter without end."""
    system = tr.RollingSystem(GIVES_WAY["a flat stone"], SHAKEN)

    def run() -> tr.Trajectory:
        return tr.simulate(system, system.place(), duration=0.01, every=0.001, method="taylor")

    right, plain = run(), Lowered.heyoka

    def blind(lowered: Lowered) -> tuple[list[Any], list[Any]]:
        equations, stops = plain(lowered)
        names = lowered.event_functions
        return equations, [1 + stop**2 if "near" in name else stop for name, stop in zip(names, stops, strict=True)]

    memory = integrators._Memory()
    monkeypatch.setattr(integrators, "_memory", lambda: memory)
    monkeypatch.setattr(Lowered, "heyoka", blind)
    found = run()
    assert [event.kind for event in found.events] == [event.kind for event in right.events]
    assert "grip" in {event.kind for event in found.events}
    assert float(abs(found.data.position - right.data.position).max()) < 1e-14


def test_slip_that_keeps_its_direction_for_long_is_followed_in_few_steps() -> None:
    """A half-cylinder slips straight down a wave: what differences leave of slopes across is no error of a step."""
    text = """
body = { kind = "half-cylinder", radius = 0.014281, mass = 0.64954, length = 0.0453759, moment_of_inertia = 4.24994e-5 }
start = { position = [0.0109204, 0.55767], velocity = "co-rotating", time = 1.67707 }
run = { duration = 0.45, every = 0.01 }
[support]
kind = "height-field"
formula = "0.00827175*sin(4.36936*x)*cos(11.7081*x)"
friction = 0.0498866
motion = { kind = "move", position = ["0.00157133 + 0.00178206*t", 0.0, -0.00246865] }
"""
    steps, one_by_one = [0], runge_kutta._one_by_one

    def counted(*given: Any) -> Any:
        for path in one_by_one(*given):
            steps[0] += path.count
            yield path

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(runge_kutta, "_one_by_one", counted)
        run = tr.Scenario.loads(text).run()
    assert "slip" in [event.kind for event in run.events]
    assert steps[0] < 500 * len(run.events)
    assert run.card().passed


# A ball in a narrow cone that rocks grips and slips three hundred times a second; most of each slip goes straight.
GRIPS_AND_SLIPS = """
body = { kind = "sphere-with-moment", radius = 0.0471654, mass = 0.5034, moment_of_inertia = 0.000307893 }
start = { position = [0.0416348, -0.0283524], velocity = [1.66523, 0.0749157, 0.0], spin = 0.13775 }
[support]
kind = "cone"
half_angle = 0.0321068
friction = 0.056663
motion = { kind = "rock", amplitude = 1.02199, rate = -0.103909 }
"""


def gripping_and_slipping(method: str, duration: float) -> tr.Trajectory:
    run = f'run = {{ method = "{method}", duration = {duration}, every = {duration / 20} }}'
    return tr.Scenario.loads(run + GRIPS_AND_SLIPS).run()


def test_series_come_to_the_end_of_slip_after_slip_as_runge_kutta_does() -> None:
    """They hardly got on after 60 slips: each took 1600 steps, since it was handed on to them too soon."""
    ours, theirs = (gripping_and_slipping(method, 0.55) for method in ("taylor", "runge-kutta"))
    assert [event.kind for event in ours.events] == [event.kind for event in theirs.events]
    assert len(ours.events) > 100
    apart = [abs(mine.time - other.time) for mine, other in zip(ours.events, theirs.events, strict=True)]
    assert max(apart) <= 1e-10
    assert float(abs(ours.data.position - theirs.data.position).max()) <= 1e-10


def test_where_slip_is_handed_on_late_shows_no_more_than_its_law_leaves_out(monkeypatch: pytest.MonkeyPatch) -> None:
    runs = []
    for many in (0, 10**9):
        monkeypatch.setattr(runge_kutta, "_TOO_MANY_IN_SERIES", many)
        runs.append(gripping_and_slipping("taylor", 0.43))
    late, soon = runs
    assert [event.kind for event in late.events] == [event.kind for event in soon.events]
    assert max(abs(a.time - b.time) for a, b in zip(late.events, soon.events, strict=True)) <= 1e-12
    assert float(abs(late.data.position - soon.data.position).max()) <= 1e-12


LIGHT_AXLE = """
body = { kind = "torus", radius = 0.177358, rim_radius = 0.158556, density = 2553.34 }
run = { duration = 1.96, every = 1e-4 }
[support]
kind = "bowl"
radius = 1.04251
friction = 0.0757639
motion = { kind = "free-axle", inertia = 0.00123197, bearing_drag = 0.196233 }
[start]
position = [-0.039184, 0.0]
spin = 2.44272
orientation = [0.258017, 0.0637062, -0.292278, -0.0264674]
height = 0.00306037
"""


@pytest.mark.parametrize("many", [0, 10**9])
def test_slip_over_a_light_axle_moves_a_heavy_body_as_its_forces_do(many: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its direction was that of the slip near which it was looked for: 2e-7 rad, of which the axle makes 3 mm/s^2."""
    monkeypatch.setattr(runge_kutta, "_TOO_MANY_IN_SERIES", many)
    run = tr.Scenario.loads(LIGHT_AXLE).run("taylor")
    V, m, h = run.data.velocity.values, float(run.system.body.mass), 1e-4
    slope = (45 * (V[4:-2] - V[2:-4]) - 9 * (V[5:-1] - V[1:-5]) + V[6:] - V[:-6]) / (60 * h)
    acting = run.data.contact_force.values[3:-3] / m - [0.0, 0.0, 9.80665]
    times, apart = run.data.time.values[3:-3], np.abs(slope - acting).max(axis=1)
    clear = np.ones(times.size, dtype=bool)
    for event in run.events:  # where slip has just begun, or all but ended, it changes within a step of the clock
        clear &= abs(times - event.time) > 0.012
    assert clear.sum() > 15_000
    assert apart[clear].max() <= 1e-8


def test_rates_want_no_numbers_of_event_functions_also_where_one_text_gives_all() -> None:
    """A ball in a cone: all outputs are the same work. It was an IndexError where a load has a corner."""
    run = tr.Scenario.loads('run = { method = "auto", duration = 0.1, every = 0.1 }' + GRIPS_AND_SLIPS)
    system = replace(run.system(), loads=(tr.QuadraticDrag(0.01),))
    law = CreepingLaw(step=1e-6, since=-1.0, near=(0.0, 0.0, 1.0))
    start = SlippingLaw().pack(system, system.place((0.0416348, -0.0283524)))[:10]
    whole = python_law(system, law, (0.0,) * (law.event_parameters + 1))
    bare = python_law(system, law)
    for name in ("rates", "event_functions", "found", "corners"):
        assert getattr(bare, name)(0.0, [*start, 0.01]) == getattr(whole, name)(0.0, [*start, 0.01])
    assert len(bare.event_functions(0.0, [*start, 0.01])) == len(bare.names)


@pytest.mark.parametrize("force", [0.3, 0.03, 1e-3, 1e-6])
@pytest.mark.parametrize("lifts", [0.2, 0.43, 0.5, 0.81])
@pytest.mark.parametrize("lift", [0, 1])
def test_friction_gives_way_before_a_body_lifts_off_in_one_step(force: float, lifts: float, lift: int) -> None:
    """N falls through zero in a step, and (μN)² − f² is positive again behind it: it was below zero at no look."""

    def stops(t: float, y: Any) -> Any:  # noqa: ARG001
        N, still = lifts - t, 0.2 * (2 - t)
        found = [0.25 * N * N - force**2, N, still]
        return np.array(found if lift else [found[1], found[0], still])

    path = runge_kutta._OneStep(0.0, 1.0, lambda t: np.array([t]))
    found = runge_kutta._first_stop(path, stops)
    assert found is not None
    if 2 * force < lifts:
        assert found == (pytest.approx(lifts - 2 * force, rel=1e-14), 1 - lift)
    else:  # it gave way before this step
        assert found == (pytest.approx(lifts, rel=1e-14), lift)


def test_what_falls_from_nothing_at_the_beginning_of_a_step_is_first_whatever_else_is_below_zero() -> None:
    path = runge_kutta._OneStep(0.0, 1.0, lambda t: np.array([t]))
    found = runge_kutta._first_stop(path, lambda t, _: np.array([-t, -1.0, 0.5 - t]))
    assert found is not None
    assert found[1] == 0
    assert found[0] <= 1e-300


def test_runge_kutta_finds_the_slip_before_a_lift() -> None:
    """A ball rolls over the crest of a wave: friction gives way 90 µs before it comes off."""
    text = """
    body = { kind = "solid-sphere", radius = 0.0124319, mass = 0.0617134 }
    loads = [{ kind = "drag", coefficient = 0.00142037 },
             { kind = "force", value = [-0.116737, "0.0174263*(1 - exp(-t))", "0.0307089*sin(0.713206*t)"] }]
    run = { duration = 1.5, every = 0.02, method = "runge-kutta" }
    [support]
    kind = "height-field"
    formula = "0.0352762*sin(27.9903*y)*cos(3.67254*x) + 0.0706528*y**2"
    friction = 0.34325
    tangential_restitution = 0.0362293
    motion = { kind = "spin", rate = 1.4503 }
    [start]
    position = [-0.162126, 0.0782844]
    velocity = [-0.142948, -0.598411, -0.0207497]
    spin = -1.26652
    time = -0.815222
    """
    scenario = tr.Scenario.loads(text)
    ours, theirs = scenario.run(), scenario.run("taylor")
    assert [event.kind for event in ours.events] == [event.kind for event in theirs.events]
    assert [event.kind for event in ours.events][-3:] == ["grip", "slip", "lift"]
    assert ours.card().passed, str(ours.card())
    assert ours.events[-2].time == pytest.approx(theirs.events[-2].time, abs=1e-10)
