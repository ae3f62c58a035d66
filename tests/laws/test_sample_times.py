"""Samples at awkward instants: on events, a rounding beside them and each other, on a clock far from 0."""

import numpy as np
import pytest
from tests.tolerances import SOLVER

import trundle as tr
from trundle.mechanics.algebra import Vector
from trundle.scenario import files
from trundle.solve import phases, taylor
from trundle.solve.methods import METHODS, Method
from trundle.solve.patience import Patience

BALL = tr.Body.solid_sphere(radius="28.6 mm", mass="170 g")
NUMERICAL = ("taylor", "runge-kutta")


def falling(time=0.0, support=None):
    """Dropped on a turning table: it lands, bounces, slips, grips and settles within a second."""
    table = support or tr.Support(tr.Plane(), motion=tr.Spin(3.0), friction=0.15, restitution=0.5)
    system = tr.RollingSystem(BALL, table)
    return system, system.place((0.2, 0.0), height=0.1, time=time)


def beside(instants, most=3):
    """Return the instants with their neighbours among the floats on either side, ascending."""
    near = [instants]
    for way in (-np.inf, np.inf):
        step = instants
        for _ in range(most):
            step = np.nextafter(step, way)
            near.append(step)
    return np.unique(np.concatenate(near))


@pytest.mark.parametrize("method", METHODS)
def test_instants_on_events_and_a_rounding_beside_them_are_all_sampled(method):
    system, start = falling()
    chosen = Method.of(method)
    events = [event.time for event in chosen.solve(system, start, np.linspace(0.0, 1.0, 101)).events]
    assert len(events) > 8
    times = np.append(beside(np.array(events)), 1.0)
    at = chosen.solve(system, start, times)
    assert np.array_equal(at.time, times)
    assert [event.time for event in at.events] == pytest.approx(events, abs=1e-12)
    groups = np.searchsorted(events, times[:-1] - 1e-9)
    for group in np.unique(groups):  # the centre goes no way in a rounding of time, whatever happens to its velocity
        assert np.ptp(at.position[:-1][groups == group], axis=0).max() < 1e-13


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("seed", range(4))
def test_instants_that_only_rounding_tells_apart_are_all_sampled(method, seed):
    random = np.random.default_rng(seed)
    begin = random.uniform(0.0, 0.1)
    system, start = falling(begin)
    middle = begin + np.sort(random.uniform(0.0, 1.0, 200))  # several of the parts in which a run is followed
    times = np.concatenate([[begin], beside(middle, most=1 + seed)])
    at = Method.of(method).solve(system, start, times)
    assert np.array_equal(at.time, times)
    assert np.isfinite(at.position).all()
    plain = Method.of(method).solve(system, start, middle)
    where = np.searchsorted(times, middle)
    assert np.abs(at.position[where] - plain.position).max() < 1e-11


@pytest.mark.parametrize("method", NUMERICAL)
@pytest.mark.parametrize("time", [-1e6, 1e3, 1e6])
def test_a_clock_far_from_zero_shows_the_same_motion(method, time):
    bowl = tr.Support(tr.Bowl(1.0), friction=0.3, restitution=0.5)
    shell = tr.Body.ellipsoid(semi_axes=(0.1, 0.08, 0.06), mass=1.0)
    system = tr.RollingSystem(shell, bowl)
    runs = [
        tr.simulate(system, system.place((0.2, 0.1), height=0.05, time=begin), 0.4, 0.01, method)
        for begin in (0.0, time)
    ]
    early, late = runs
    assert np.array_equal(late.data.time, time + early.data.time)
    assert [event.kind for event in late.events] == [event.kind for event in early.events]
    rounding = 100 * np.spacing(abs(time))  # of an instant; the body moves at 2 m/s at most
    for name in ("position", "orientation"):
        assert np.abs(late.data[name].values - early.data[name].values).max() < 10 * rounding + 1e-9


@pytest.mark.parametrize("method", NUMERICAL)
def test_a_support_that_goes_by_the_clock_is_where_the_clock_says(method):
    # Over 2π·10⁵/3 s, to the last digit that such a float has, the table has turned 10⁵ times and is where it was.
    turns = 2 * np.pi * 1e5 / 3
    table = tr.Support(tr.Plane(), motion=tr.SpinBy("3 + sin(3*t)"), friction=0.15, restitution=0.5)
    runs = []
    for begin in (0.0, turns):
        system, start = falling(begin, table)
        runs.append(tr.simulate(system, start, 1.0, 0.01, method).data)
    assert np.abs(runs[1].position.values - runs[0].position.values).max() < 1e-8


def test_a_clock_too_far_from_zero_to_tell_the_samples_apart_is_refused():
    system, start = falling(1e9)
    with pytest.raises(tr.InvalidValueError, match=r"`start.time` must .* got 1000000000.0.*nearer to 0"):
        tr.simulate(system, start, 1.0, 0.01)
    with pytest.raises(tr.InvalidValueError, match=r"`start\.time`"):
        tr.simulate_many([system], [start], 1.0, 0.01)


@pytest.mark.parametrize("method", NUMERICAL)
@pytest.mark.parametrize("seed", range(3))
def test_a_tippe_top_that_slips_hops_and_rolls_is_sampled_whatever_its_numbers(method, seed):
    # Events among samples on its way: for some of these numbers an event fell on one, and the run broke down.
    random = np.random.default_rng(seed)
    for spin in (73.33, *random.uniform(73.2, 73.4, 1)):
        least, other = 5.23e-6 * (1 + random.uniform(-2e-3, 2e-3)), 2.994285714285714e-6
        top = tr.Body(0.02, tr.Principal(least, other, 3.2e-6), tr.Sphere(0.02, Vector(0.0, 0.0, 0.006)))
        system = tr.RollingSystem(top, tr.Support(tr.Plane(), friction=0.3))
        start = system.place(
            angular_velocity=(0.0, 0.0, spin), attitude=(0.0, 0.1, 0.0), time=random.choice([0.0, 7.3])
        )
        run = tr.simulate(system, start, 1.0, 0.02, method)
        assert run.data.time.size == 51
        assert (np.diff(run.data.time) > 0).all()


@pytest.mark.parametrize("time", [0.0, 3.0])
@pytest.mark.parametrize("length", [1e-3, 1e-9, 1e-14])
@pytest.mark.parametrize("method", METHODS)
def test_short_runs_are_sampled(method, length, time):
    if time and length < 1e-9:
        return  # the clock is too coarse: see above
    system = tr.RollingSystem(BALL, tr.Support(tr.Plane(), motion=tr.Spin(3.0)))
    run = tr.simulate(system, system.place((0.2, 0.0), (0.0, 0.3), time=time), length, length / 7, method)
    way = np.linalg.norm(run.data.position.values[-1] - run.data.position.values[0])
    assert run.data.time.size == 8
    assert way == pytest.approx(0.3 * length, rel=1e-5, abs=1e-16)


@pytest.mark.parametrize("most", [50_000, 40, 0])  # steps that are kept: all, some, none
@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
def test_a_run_that_is_gone_through_once_can_be_asked_for_any_instants(method, most, monkeypatch):
    # It falls, bounces, slips and grips: each look, in whatever order, is at the same motion.
    monkeypatch.setattr("trundle.solve.dense._MOST_STEPS", most)
    run = tr.Scenario.load("turntable-drop").run(method)
    ends = run.samples.time[[0, -1]]
    read = Method.of(method).dense(run.system, run.start, float(ends[1]))
    for times in (ends, np.linspace(*ends, 7), np.linspace(ends[0], 0.3 * ends[1], 50), np.linspace(*ends, 301)):
        found, wanted = read(times), Method.of(method).solve(run.system, run.start, times)
        assert [event.kind for event in found.events] == [event.kind for event in wanted.events]
        assert np.array_equal(found.time, wanted.time)
        assert np.array_equal(found.phase, wanted.phase)
        for field in ("position", "velocity", "angular_velocity", "orientation", "contact_force"):
            apart = np.abs(getattr(found, field) - getattr(wanted, field)).max()
            assert apart <= 1e-9 * max(1.0, np.abs(getattr(wanted, field)).max())


@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
def test_the_work_until_an_instant_is_that_of_the_steps_and_events_until_then(method):
    system, start = falling()
    read = Method.of(method).dense(system, start, 3.0)
    read(np.array([0.0, 3.0]))
    edges = np.array([0.0, *read.ends])
    an_event = (read.work - sum(leg.work for leg in read.legs)) / len(read.legs)
    whole = np.cumsum([an_event + leg.work for leg in read.legs]) - an_event
    passed = np.append(whole[:-1] + an_event, whole[-1])  # at an event it is done
    assert read.work_until(np.array([0.0, *read.ends])) == pytest.approx([0.0, *passed])
    for leg, begin, done in zip(read.legs, edges, [0.0, *(whole + an_event)], strict=False):
        assert leg.begins.size == leg.steps > 0
        assert (np.diff([begin - 1e-12, *leg.begins, read.ends[-1]]) > 0).all()
        each = done + leg.work * np.arange(leg.steps) / leg.steps
        assert read.work_until(leg.begins[1:]) == pytest.approx(each[1:])
    assert (np.diff(read.work_until(np.linspace(-1.0, 4.0, 2001))) >= 0).all()


@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
def test_what_follows_its_events_is_worked_out_once_however_often_a_run_is_looked_at(method, monkeypatch):
    worked_out = []
    transitions = phases.transitions
    after, beyond = transitions.after, phases.corners.beyond
    monkeypatch.setattr(transitions, "after", lambda *those: [worked_out.append("after"), after(*those)][1])
    monkeypatch.setattr(phases.corners, "beyond", lambda *those: [worked_out.append("beyond"), beyond(*those)][1])
    system, start = falling()
    read, counts = Method.of(method).dense(system, start, 1.0), []
    for _ in range(3):
        read(np.linspace(0.0, 1.0, 50))
        counts.append((worked_out.count("after"), worked_out.count("beyond")))
    stops = sum(leg.stop is not None for leg in read.legs)
    assert stops > 4
    assert counts == [(stops, stops + looks) for looks in (1, 2, 3)]  # of each look only how it starts


@pytest.mark.parametrize("share", [2.0, 0.9, 0.5])  # of its steps that are kept
def test_a_stretch_of_more_steps_than_are_kept_is_gone_through_once_too(share, monkeypatch):
    taken, after = [], Patience.after
    monkeypatch.setattr(
        Patience, "after", lambda self, steps, *rest: [taken.append(steps), after(self, steps, *rest)][1]
    )
    system = tr.RollingSystem(BALL, tr.Support(tr.Plane(), motion=tr.Spin(3.0)))
    start, times = system.place((0.2, 0.0), (0.0, 0.3), spin=400.0), np.array([0.0, 2.0])
    Method.of("runge-kutta").solve(system, start, times)
    alone = sum(taken)
    taken.clear()
    monkeypatch.setattr("trundle.solve.dense._MOST_STEPS", int(share * alone))
    Method.of("runge-kutta").dense(system, start, 2.0)(times)
    assert alone > 300
    assert sum(taken) < 1.1 * alone


def test_a_step_that_ends_a_rounding_beyond_a_sample_has_that_sample() -> None:
    # Young slip is followed in steps of its age: from the first sample on they end on samples, but for rounding.
    pytest.importorskip("heyoka")
    body = tr.Body.weighted_cylinder(0.221515, 2.30374, 0.011858, 0.0143916)
    system = tr.RollingSystem(body, tr.Support(tr.Plane(), tilt="-79.4249 deg", friction=0.0490033))
    start = system.place(roll="-246.09 deg")
    every = 0.0294475
    often, once = (tr.simulate(system, start, 100 * every, step, method="taylor") for step in (every, 100 * every))
    assert often.data.time.size == 101
    apart = often.data.position.values[-1] - once.data.position.values[-1]
    assert np.abs(apart).max() <= SOLVER(1e3, 1e-15, 50.0)


@pytest.mark.parametrize("begin", [1e4, -3e4, 1e5])
@pytest.mark.parametrize(
    "name", ["tilted-turntable", "billiard-draw", "off-the-rim", "chaplygin-ball", "free-turntable-ellipse"]
)
def test_closed_forms_turn_a_body_by_the_time_since_they_began(name, begin):
    # By the clock itself Ω is known only to its last digit, and the orientation could not be followed.
    tables = files.tables_of(name)
    runs = [tr.Scenario.read(tables | {"start": tables["start"] | {"time": time}}, name).run() for time in (0.0, begin)]
    early, late = (run.data.orientation.values for run in runs)
    turned = np.spacing(abs(begin)) * np.abs(runs[0].data.angular_velocity.values).max()
    assert np.abs(late[:200] - early[:200]).max() < 10 * turned + 1e-11


@pytest.mark.parametrize("begin", [1e4, -3e5, 1e6])
@pytest.mark.parametrize("name", ["billiard-draw", "superball", "loop-the-loop-too-slow", "turntable-drop"])
def test_events_are_met_to_the_last_digit_of_the_clock(name, begin):
    tables = files.tables_of(name)
    run = tr.Scenario.read(tables | {"start": tables["start"] | {"time": begin}}, name).run()
    assert run.events
    assert run.card()["events at their instants"].passed


@pytest.mark.parametrize("tilt", [0.014399, -0.0144, 0.01])
def test_slip_that_goes_straight_ends_at_one_instant_however_it_is_sampled(tilt):
    """What rounding leaves of its slip across its way has no part in when a hoop grips."""
    pytest.importorskip("heyoka")
    table = tr.Support(tr.Plane(), motion=tr.Tilt(tilt), friction=0.052728)
    system = tr.RollingSystem(tr.Body.hoop(0.0111296, 0.0943819), table)
    start = system.place((0.056892, -0.183116), (-0.768696, 0.0, -1.06366), height=0.0370918, time=-1.47176)
    found = [taylor.solve(system, start, np.linspace(-1.47176, 0.2, count)).events for count in (3, 10, 30, 86, 200)]
    assert {tuple(event.kind for event in events) for events in found} == {("land", "grip")}
    times = [events[1].time for events in found]
    assert max(times) - min(times) <= 1e-14
