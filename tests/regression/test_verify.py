"""The card must be able to fail: faults are planted in the package, in a method's results and in stored numbers.

The faults in the package are in tests/mutation, each with the short run that shows it; `make mutation` prints them.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.mutation.mutants import PLANTED, SHARED
from tests.mutation.planting import Mutant, planted
from tests.mutation.runs import RUNS
from tests.mutation.trying import tried

import trundle as tr
from trundle import verify
from trundle.mechanics import contact
from trundle.mechanics.shapes import Sphere
from trundle.mechanics.system import RollingSystem, State
from trundle.simulation.trajectory import Trajectory
from trundle.solve import methods
from trundle.solve.methods import Method
from trundle.solve.samples import FLIGHT, Samples
from trundle.verify import Card
from trundle.verify.course import Course
from trundle.verify.growth import _lasts
from trundle.verify.nudging import nudged

PAGE = Path(__file__).parents[2] / "docs" / "what-the-card-can-show.md"
BALL = tr.Body.solid_sphere(radius=0.025, mass=0.065)
TABLE = tr.Support(tr.Plane(), motion=tr.Spin(3.5), tilt=0.05)
SYSTEM = tr.RollingSystem(BALL, TABLE)
START = SYSTEM.place((0.1, 0.03), (0.05, 0.2), spin=2.0)
TIMES = np.linspace(0.0, 2.0, 101)
Fault = Callable[..., Samples]


def solved(system: RollingSystem = SYSTEM, start: State = START, method: str = "exact") -> Samples:
    return Method.of(method).solve(system, start, TIMES)


def failures(card: Card) -> set[str]:
    assert card.passed == (not card.failures)
    return {figure.name for figure in card.failures}


# --- faults in the package ------------------------------------------------------------------------------


@cache
def run_of(name: str) -> Trajectory:
    return RUNS[name]()


@pytest.mark.parametrize("name", RUNS)
def test_the_runs_pass_as_they_are(name: str) -> None:
    card = run_of(name).card()
    assert card.passed, str(card)


@pytest.mark.parametrize("mutant", PLANTED, ids=lambda mutant: mutant.name)
def test_a_planted_fault_is_told(mutant: Mutant) -> None:
    failed, refused = tried(mutant)
    if mutant.refused:  # the run comes to no result at all
        assert mutant.refused in refused
    else:
        assert failed, refused or "the card passes"


def test_the_page_counts_the_faults() -> None:
    refused = sum(bool(mutant.refused) for mutant in PLANTED)
    said = f"{len(PLANTED) + len(SHARED)} faults", f"tells {len(PLANTED) - refused} of them", f"with {refused} the run"
    page = PAGE.read_text(encoding="utf-8")
    assert [words for words in (*said, f"; {len(SHARED)} pass") if words not in page] == []


@pytest.mark.parametrize("mutant", SHARED, ids=lambda mutant: mutant.name)
def test_what_solver_and_check_share_is_on_the_page(mutant: Mutant) -> None:
    assert tried(mutant) == ([], ""), "it is told now: move it to those that are"
    page = PAGE.read_text(encoding="utf-8")
    assert f"| {mutant.name} |" in page
    assert mutant.shared in page.replace("\n", " ")


def test_a_planted_fault_is_taken_out_again() -> None:
    mutant = next(mutant for mutant in PLANTED if mutant.module == "mechanics.contact")
    honest = contact.Contact.rates.__code__
    with planted(mutant):
        assert contact.Contact.rates.__code__ is not honest
    assert contact.Contact.rates.__code__ is honest


# --- numbers that are not the solution's ----------------------------------------------------------------

MIXED = ("ball_bounces", "ball_comes_to_rest", "billiard_exactly", "egg_on_free_table")


def altered(name: str, **fields: Any) -> Card:
    """Return the card of a run whose stored numbers were changed."""
    run = run_of(name)
    data = run.data.assign({key: run.data[key].copy(data=value) for key, value in fields.items()})
    return replace(run, data=data, _kept={}).card()


@pytest.mark.parametrize("name", MIXED)
@pytest.mark.parametrize(
    "field", ["position", "contact", "velocity", "angular_velocity", "orientation", "contact_force", "slip_velocity"]
)
def test_altered_numbers_fail(name: str, field: str) -> None:
    values = run_of(name).data[field].values
    wrong = values + 1e-6 if field == "slip_velocity" else values * (1 + 1e-6)
    assert not altered(name, **{field: wrong}).passed


@pytest.mark.parametrize("name", MIXED)
@pytest.mark.parametrize("phase", range(4))
def test_another_phase_fails(name: str, phase: int) -> None:
    right = run_of(name).data.phase.values
    if (right == phase).all():
        return
    assert "phase" in failures(altered(name, phase=np.full_like(right, phase)))
    one = right.copy()
    one[np.flatnonzero(right != phase)[-1]] = phase
    assert "phase" in failures(altered(name, phase=one))


@pytest.mark.parametrize("value", [0.0, 1.0, np.nan])
def test_any_slip_velocity_fails(value: float) -> None:
    slips = run_of("billiard_exactly").data.slip_velocity.values
    assert "samples fit together" in failures(altered("billiard_exactly", slip_velocity=np.full_like(slips, value)))


def test_slip_in_flight_is_no_number() -> None:
    run = run_of("ball_bounces")
    slips = np.where(np.isnan(run.data.slip_velocity.values), 0.0, run.data.slip_velocity.values)
    assert (run.data.phase.values == FLIGHT).any()
    assert "samples fit together" in failures(altered("ball_bounces", slip_velocity=slips))


def test_the_support_s_own_numbers_are_compared() -> None:
    run = run_of("egg_on_free_table")
    for name in ("support_angle", "support_rate"):
        assert not altered("egg_on_free_table", **{name: run.data[name].values * (1 + 1e-6)}).passed, name


@pytest.mark.parametrize("name", ["billiard_exactly", "billiard"])
def test_a_billiard_run_is_held_to_more_than_a_hundredth(name: str) -> None:
    # The bounds were once those of a ball that rolls from the start: of 33 rad, or three times the force.
    run = run_of(name)
    half = math.cos(0.005), math.sin(0.005)
    w, x, y, z = run.data.orientation.values.T
    turned = np.stack(
        [half[0] * w - half[1] * z, half[0] * x - half[1] * y, half[0] * y + half[1] * x, half[0] * z + half[1] * w], 1
    )
    assert "the method run again" in failures(altered(name, orientation=turned))
    assert "the method run again" in failures(altered(name, contact_force=run.data.contact_force.values * 1.05))


def test_one_altered_sample_fails() -> None:
    right = solved()
    bumped = right.velocity.copy()
    bumped[83] += 1e-9
    card = verify.card(SYSTEM, START, replace(right, velocity=bumped), Method.of("exact"))
    assert "samples fit together" in failures(card)


def with_events(name: str, change: Callable[[Any], Any]) -> Card:
    run = run_of(name)
    return replace(run, events=tuple(map(change, run.events)), _kept={}).card()


@pytest.mark.parametrize("name", ["ball_comes_to_rest", "billiard_exactly", "ball_bounces"])
def test_altered_events_fail(name: str) -> None:
    assert not with_events(name, lambda event: replace(event, time=event.time * (1 + 1e-6))).passed
    assert not with_events(name, lambda event: replace(event, kind="slip" if event.kind == "grip" else "grip")).passed
    for field in ("velocity", "orientation"):

        def moved(state: State, field: str = field) -> State:
            return replace(state, **{field: tuple(part + 1e-6 for part in getattr(state, field))})

        assert not with_events(name, lambda event, moved=moved: replace(event, before=moved(event.before))).passed
        assert not with_events(name, lambda event, moved=moved: replace(event, after=moved(event.after))).passed


@pytest.mark.parametrize("name", ["ball_bounces", "ball_comes_to_rest", "billiard_exactly"])
def test_events_left_out_fail(name: str) -> None:
    run = run_of(name)
    assert not replace(run, events=run.events[1:], _kept={}).card().passed
    assert not replace(run, events=run.events[:-1], _kept={}).card().passed


# --- results of a method that are wrong, by little ------------------------------------------------------


def scaled(field: str, by: float) -> Fault:
    def fault(solve: Any, system: RollingSystem, start: State, times: Any) -> Samples:
        right = solve(system, start, times)
        return replace(right, **{field: getattr(right, field) * by})

    return fault


def shifted(solve: Any, system: RollingSystem, start: State, times: Any) -> Samples:
    right, by = solve(system, start, times), np.array([1e-9, 0.0, 0.0])
    return replace(right, position=right.position + by, contact=right.contact + by)


def swapped(solve: Any, system: RollingSystem, start: State, times: Any) -> Samples:
    """Take the body's turning for that of the frame: the inverse rotation."""
    right = solve(system, start, times)
    return replace(right, orientation=right.orientation * np.array([1.0, -1.0, -1.0, -1.0]))


def late(solve: Any, system: RollingSystem, start: State, times: Any) -> Samples:
    right = solve(system, start, times)
    return replace(right, orientation=solve(system, start, times + 1e-9).orientation)


def of(wrong: Callable[[RollingSystem], RollingSystem]) -> Fault:
    """Solve another system from the same start."""
    return lambda solve, system, start, times: solve(wrong(system), start, times)


def with_support(**changes: Any) -> Fault:
    return of(lambda system: replace(system, support=replace(system.support, **changes)))


AGAINST, SAMPLES, TURNING = "closed form against Taylor", "samples fit together", "Ω is the slope of the orientation"
FAULTS: dict[str, tuple[Fault, set[str]]] = {
    "velocity, 1e-9 too fast": (
        scaled("velocity", 1 + 1e-9),
        {SAMPLES, "velocity is the slope of the path", AGAINST},
    ),
    "angular velocity, 1e-9 too fast": (scaled("angular_velocity", 1 + 1e-9), {SAMPLES, TURNING, AGAINST}),
    "contact force, 1e-9 too large": (scaled("contact_force", 1 + 1e-9), {"law of motion", AGAINST}),
    "contact force backwards": (scaled("contact_force", -1.0), {"law of motion", "normal force"}),
    "another inertia ratio": (
        of(lambda system: replace(system, body=tr.Body.sphere(0.025, 0.065, 0.4 * (1 + 1e-8)))),
        {"law of motion", "virtual power of the reaction", AGAINST},
    ),
    "the table turning the other way": (with_support(motion=tr.Spin(-3.5)), {"no slip", "law of motion", AGAINST}),
    "the table turning a little faster": (with_support(motion=tr.Spin(3.5 * (1 + 1e-9))), {SAMPLES, AGAINST}),
    "another slope": (with_support(tilt=0.05 * (1 + 1e-8)), {"law of motion", AGAINST}),
    "another gravity": (of(lambda system: replace(system, gravity=9.81)), {"law of motion", AGAINST}),
    "an extra push": (of(lambda system: replace(system, loads=(tr.Force((1e-8, 0, 0)),))), {"law of motion", AGAINST}),
    "a little drag": (of(lambda system: replace(system, loads=(tr.Drag(1e-7),))), {"law of motion", AGAINST}),
    "path shifted by a nanometre": (shifted, {SAMPLES, AGAINST}),
    "orientation inverted": (swapped, {"no slip", TURNING, f"{AGAINST}, orientation"}),
    "orientation a nanosecond late": (late, {f"{AGAINST}, orientation"}),
}


def faulty(fault: Fault, monkeypatch: pytest.MonkeyPatch, system: RollingSystem, start: State) -> Card:
    """Return the card of a run by closed forms whose results are changed wherever they are asked for."""
    pytest.importorskip("heyoka")
    honest = methods.solver

    def solver(method: str) -> Any:
        if method != "exact":
            return honest(method)
        return lambda system, start, times, *_: fault(honest("exact"), system, start, times)

    monkeypatch.setattr(methods, "solver", solver)
    return verify.card(system, start, solver("exact")(system, start, TIMES), Method.of("exact"))


@pytest.mark.parametrize("name", FAULTS)
def test_a_planted_fault_of_the_method_fails_its_figure(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    fault, wanted = FAULTS[name]
    card = faulty(fault, monkeypatch, SYSTEM, START)
    assert wanted <= failures(card), str(card)


OTHERS = {
    "gravity": replace(SYSTEM, gravity=9.81),
    "tilt": replace(SYSTEM, support=replace(TABLE, tilt=0.0501)),
    "rate": replace(SYSTEM, support=replace(TABLE, motion=tr.Spin(-3.5))),
    "inertia": replace(SYSTEM, body=tr.Body.hollow_sphere(0.025, 0.065)),
    "radius": replace(SYSTEM, body=tr.Body.solid_sphere(0.0251, 0.065)),
    "mass": replace(SYSTEM, body=tr.Body.solid_sphere(0.025, 0.066)),
    "load": replace(SYSTEM, loads=(tr.Force((1e-6, 0.0, 0.0)),)),
}


@pytest.mark.parametrize("name", OTHERS)
@pytest.mark.parametrize("method", ["exact", "runge-kutta"])
def test_the_samples_of_another_system_fail(name: str, method: str) -> None:
    card = verify.card(OTHERS[name], START, solved(method=method), Method.of(method))
    assert not card.passed, str(card)


def test_the_samples_of_another_body_fail_where_nothing_is_conserved() -> None:
    # No closed form, no energy, no moving energy: only the law itself can tell.
    def egg(moment: float) -> RollingSystem:
        body = tr.Body(0.065, tr.Principal(1.6e-5, 1.7e-5, moment), Sphere(0.025))
        return replace(SYSTEM, body=body)

    method = Method.of("runge-kutta")
    mine = method.solve(egg(1.8e-5), START, TIMES[:20])
    assert verify.card(egg(1.8e-5), START, mine, method).passed
    assert not verify.card(egg(1.9e-5), START, mine, method).passed


# --- motions that magnify a small difference ------------------------------------------------------------


def hoop(above: float, side: str) -> tuple[RollingSystem, State]:
    """A hoop let go on a log or in a pipe, a little off its highest line; on top of a log every rounding grows."""
    support = tr.Support(tr.Cylinder(0.5, side=side), tilt="90 deg")
    system = tr.RollingSystem(tr.Body.hoop(0.1, 1.0), support)
    return system, system.place((math.pi - above, 0.0))


@pytest.mark.parametrize(("above", "duration"), [(0.0, 4.0), (1e-9, 4.0), (1e-4, 3.0)])
@pytest.mark.parametrize("method", ["exact", "taylor"])
def test_an_unstable_motion_is_allowed_what_it_magnifies(above: float, duration: float, method: str) -> None:
    pytest.importorskip("heyoka")
    system, start = hoop(above, "outside")
    run = tr.simulate(system, start, duration, 0.02, method=method)
    assert not run.events
    assert run.card().passed, str(run.card())


@pytest.mark.parametrize("name", ["velocity, 1e-9 too fast", "another gravity"])
@pytest.mark.parametrize("above", [2.0, 1e-4])  # an ordinary swing, and one that begins near the top of a log
def test_what_a_motion_does_not_magnify_still_fails(name: str, above: float, monkeypatch: pytest.MonkeyPatch) -> None:
    system, start = hoop(above, "inside" if above > 1 else "outside")
    assert failures(faulty(FAULTS[name][0], monkeypatch, system, start))


def tumbling(turn: float, duration: float = 1.5, **method: Any) -> Trajectory:
    """A body that tumbles and bounces high, so that a rounding grows tenfold and more from bounce to bounce."""
    body = tr.Body.ellipsoid((0.02, 0.03, 0.08), 0.2)
    system = tr.RollingSystem(body, tr.Support(tr.Plane(), friction=0.3, restitution=0.95))
    given: dict[str, Any] = {"height": 0.3, "angular_velocity": (20.0, 9.0, 5.0)}
    start = system.place((0.0, 0.0), (0.5, 0.1, 0.0), attitude=(0.3, 0.4, turn), **given)
    return tr.simulate(system, start, duration, 0.02, **method)


def test_what_is_wrong_late_in_a_run_that_magnifies_is_told() -> None:
    coarse: dict[str, Any] = {"method": "runge-kutta", "tolerance": 1e-9}
    run, other = tumbling(0.5, **coarse), tumbling(0.5 + 1e-6, **coarse)
    assert run.card().passed, str(run.card())
    late = run.data.time > 1.4
    mixed = replace(run, data=other.data.where(late, run.data).assign_attrs(run.data.attrs), _kept={})
    assert mixed.card()["the method run again"].passed is False
    sooner = run.data.position.copy(deep=True)
    sooner[10] += 1e-4
    assert "the method run again" in failures(replace(run, data=run.data.assign(position=sooner), _kept={}).card())


@pytest.mark.parametrize("duration", [3.0, 4.0])
def test_where_a_rounding_grows_too_large_the_card_says_that_it_cannot_tell(duration: float) -> None:
    # What bounces on is another motion each time it is followed, and each of them keeps the balance of its energy.
    card = tumbling(0.5, duration, method="taylor").card()
    figure = card["the method run again"]
    assert card.passed, str(card)
    assert "nothing can be told beyond t = " in figure.note
    assert figure.bound is not None
    assert figure.bound <= 1e-2


def starts() -> dict[str, tuple[RollingSystem, State]]:
    """One start of each kind."""
    cloth = tr.RollingSystem(BALL, tr.Support(tr.Plane(), motion=tr.Spin(2.0), friction=0.2))
    pipe = tr.RollingSystem(tr.Body.hoop(0.1, 1.0), tr.Support(tr.Cylinder(0.5), tilt="90 deg", friction=0.2))
    return {
        "rolls": (cloth, cloth.place((0.1, 0.0), (1.0, 0.3), spin=4.0)),
        "slips": (cloth, cloth.place((0.1, 0.0), (2.0, 0.3), angular_velocity=(5.0, -60.0, 20.0))),
        "flies": (cloth, cloth.place((0.1, 0.0), (2.0, 0.3, 1.0), height=0.1, angular_velocity=(5.0, -60.0, 20.0))),
        "strikes": (cloth, cloth.place((0.1, 0.0), (2.0, 0.3, -1.0), angular_velocity=(5.0, -60.0, 20.0))),
        "a hoop rolls": (pipe, pipe.place((0.5, 0.0), (0.2, 0.0))),
    }


@pytest.mark.parametrize("kind", starts())
def test_a_nudge_keeps_the_phase_and_is_small(kind: str) -> None:
    system, start = starts()[kind]
    change = 1e-8
    found = nudged(system, start, change, change, change)
    # Each tells something of its own, and together they are all that can change in that phase.
    state = [[*s.position, *s.velocity, *s.angular_velocity, *s.orientation] for s in [start, *found]]
    ways = np.subtract(state[1:], state[0]) / change
    free = {"rolls": 8, "slips": 10, "flies": 12, "strikes": 11, "a hoop rolls": 4}[kind]
    assert len(found) == free
    assert np.linalg.svd(ways)[1].min() > 1e-4
    for other in found:
        assert 0 < np.abs(np.subtract(other.position, start.position)).max() + np.abs(ways).max() * change < 20 * change
        times = np.array([0.0, 1e-6])
        runs = [Method.of("runge-kutta").solve(system, state, times) for state in (start, other)]
        assert [event.kind for event in runs[0].events] == [event.kind for event in runs[1].events]
        assert (runs[0].phase == runs[1].phase).all()


# --- the course of a landing ----------------------------------------------------------------------------


@pytest.mark.parametrize("restitution", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("mu", [0.0, 0.1, 2.0, None])
def test_a_ball_s_landing_is_the_textbook_s(mu: float | None, restitution: float) -> None:
    # The normal velocity turns round times e; the slip changes by at most μ(1 + 1/k)(1 + e) times the approach.
    m, k, s, approach = 0.2, 0.4, np.array([0.6, -0.8]), 3.0
    M = np.diag([(1 + 1 / k) / m, (1 + 1 / k) / m, 1 / m])
    P = Course(M, mu, restitution, np.array([*s, -approach])).impulse()
    most = math.inf if mu is None else mu * (1 + 1 / k) * (1 + restitution) * approach
    wanted = [*(-s * min(1.0, most) * m / (1 + 1 / k)), (1 + restitution) * m * approach]
    assert np.abs(P - wanted).max() <= 1e-15 * 10


@pytest.mark.parametrize("back", [0.5, 1.0])
def test_a_superball_s_slip_comes_back(back: float) -> None:
    # Garwin and Cross: a ball that grips comes off with −e_t of its slip; where friction is too weak it slips through.
    m, k, s, approach = 0.2, 0.4, np.array([0.6, -0.8]), 3.0
    M = np.diag([(1 + 1 / k) / m, (1 + 1 / k) / m, 1 / m])
    for mu in (2.0, None):
        P = Course(M, mu, 1.0, np.array([*s, -approach]), back).impulse()
        assert np.abs((M @ P)[:2] + (1 + back) * s).max() <= 1e-14
    weak = Course(M, 0.02, 1.0, np.array([*s, -approach]), back).impulse()
    assert np.abs(weak - Course(M, 0.02, 1.0, np.array([*s, -approach])).impulse()).max() == 0


@pytest.mark.parametrize("seed", range(6))
def test_slip_that_turns_keeps_keller_s_equations(seed: int) -> None:
    # M P = Δs, and along the way ds/dP = M(n − μŝ): here by many small steps of the midpoint rule, and extrapolated.
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(3, 3))
    M, mu, s = root @ root.T + np.eye(3), 0.2, np.array([1.0, 0.7, -2.0])
    P = Course(M, mu, 0.0, s.copy()).impulse()

    def rate(at: np.ndarray) -> np.ndarray:
        return np.asarray(M @ [*(-mu * at[:2] / np.hypot(*at[:2])), 1.0])

    def stepped(count: int) -> np.ndarray:
        now, step = s.copy(), P[2] / count
        for _ in range(count):
            now = now + step * rate(now + 0.5 * step * rate(now))
        return now

    coarse, fine = stepped(1000), stepped(2000)
    ended = fine + (fine - coarse) / 3
    assert abs(ended[2]) < 1e-9
    assert np.abs(np.linalg.solve(M, ended - s) - P).max() < 1e-9 * np.linalg.norm(P)


def test_a_run_asked_for_other_instants_may_end_a_rounding_sooner() -> None:
    def sooner(start: State, times: Any) -> Samples:
        return Method.of("runge-kutta").solve(SYSTEM, start, np.append(times[:-1], times[-1] * (1 - 1e-15)))

    run = sooner(START, np.array([0.1, 0.2]))
    ((first, other),) = _lasts(sooner, 0.2, [(START, run)] * 2)
    assert first.time.tolist() == other.time.tolist()
