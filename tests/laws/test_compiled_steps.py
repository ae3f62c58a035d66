"""DOP853 in one compiled loop: the same method as SciPy's, on exact solutions, at events, and where numba is not."""

from __future__ import annotations

import itertools
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tomli_w

import trundle as tr
from trundle.errors import SolverError
from trundle.solve import compiled_steps, integrator_cache, runge_kutta
from trundle.solve.machine_code import machine_code
from trundle.solve.tape import Tape
from trundle.solve.tracing import CompiledLaw

pytest.importorskip("numba")

BALL = tr.Body.solid_sphere(radius=0.025, mass=0.065)


@pytest.fixture
def compiling(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Compile every law after its first steps, and count the calls of the loop."""
    monkeypatch.setattr(runge_kutta, "WORTH_THE_LOOP", 0.0)
    calls: list[int] = []
    loop = compiled_steps._loop

    def counted() -> Any:
        calls.append(1)
        return loop()

    monkeypatch.setattr(compiled_steps, "_loop", counted)
    return calls


@pytest.fixture
def without_numba(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(runge_kutta, "available", lambda: False)


def followed(rates: Any, events: Any, y0: list[float], end: float, tolerance: float = 1e-12) -> list[Any]:
    """Follow y' = f(t, y), given on a tape, by the loop alone after SciPy's first step."""
    from scipy.integrate import DOP853

    tape = Tape()
    t, *y = tape.inputs(1 + len(y0))
    law = CompiledLaw(*(machine_code(tape, of(t, y)) for of in (rates, events)), len(events(t, y)), ())
    plain = tape.function(rates(t, y))
    begun = DOP853(lambda t, y: np.array(plain([t, *y])), 0.0, np.array(y0), end, rtol=tolerance, atol=tolerance)
    begun.step()
    return list(compiled_steps.CompiledDOP853(law, begun, 0.0, tolerance, np.full(len(y0), tolerance)))


def oscillator(t: Any, y: Any) -> list[Any]:  # noqa: ARG001
    return [y[1], -y[0]]


def nothing(t: Any, y: Any) -> list[Any]:  # noqa: ARG001
    return []


@pytest.mark.parametrize("end", [0.9, 40.0, 2000.0])
def test_an_oscillator_to_its_tolerance(end: float) -> None:
    parts = followed(oscillator, nothing, [1.0, 0.0], end)
    assert parts[-1].t == end
    assert all(first.t == second.t_old for first, second in itertools.pairwise(parts))
    for part in parts:
        times = np.linspace(part.t_old, part.t, 777)
        error = np.abs(part(times) - [np.cos(times), -np.sin(times)]).max()
        assert error < 1e-12 * (3 + end)


def test_it_takes_the_steps_that_scipy_takes() -> None:
    from scipy.integrate import solve_ivp

    parts = followed(oscillator, nothing, [1.0, 0.0], 200.0)
    theirs = solve_ivp(oscillator, (0.0, 200.0), [1.0, 0.0], "DOP853", rtol=1e-12, atol=1e-12)
    ours = np.concatenate([part.times[:-1] for part in parts] + [[parts[-1].t]])
    assert abs(ours.size - (theirs.t.size - 1)) <= 1
    np.testing.assert_allclose(ours[:100], theirs.t[1:101], rtol=1e-6)


def test_a_step_is_rejected_where_the_rates_jump() -> None:
    def jump(t: Any, y: Any) -> list[Any]:
        from trundle.mechanics.scalars import namespace

        return [namespace(t).where(t < 1.0, y[0] * 0.0 + 1.0, y[0] * 0.0 - 2.0)]

    parts = followed(jump, nothing, [0.0], 3.0)
    assert float(parts[-1](3.0)[0]) == pytest.approx(1.0 - 4.0, abs=1e-10)


def test_it_is_stuck_before_a_pole() -> None:
    with pytest.raises(compiled_steps.StuckError) as stuck:
        followed(lambda t, y: [y[0] * y[0]], nothing, [1.0], 2.0)  # noqa: ARG005
    assert stuck.value.t == pytest.approx(1.0, abs=1e-6)


def test_the_root_of_a_negative_number_is_no_step() -> None:
    def root(t: Any, y: Any) -> list[Any]:  # noqa: ARG001
        from trundle.mechanics.scalars import namespace

        return [-namespace(y[0]).sqrt(y[0])]  # y = (1 - t/2)², then nothing

    with pytest.raises(compiled_steps.StuckError) as stuck:
        followed(root, nothing, [1.0], 5.0)
    assert stuck.value.t == pytest.approx(2.0, abs=1e-3)


@pytest.mark.parametrize("depth", [1e-3, 1e-6, 1e-8])
def test_no_dip_between_the_looks_is_passed_over(depth: float) -> None:
    """An event function that falls below zero by little and rises again at once: each dip is in a step that is told."""
    parts = followed(oscillator, lambda t, y: [y[0] + (1.0 - depth)], [1.0, 0.0], 400.0)  # noqa: ARG005
    dips = np.pi * np.arange(1, 128, 2)
    dips = dips[dips < 400.0]
    told = [(part.t_old, part.t) for part in parts if not part.plain]
    assert all(part.count == 1 for part in parts if not part.plain)
    assert all(any(begin <= dip <= end for begin, end in told) for dip in dips)
    assert len(told) < 8 * len(dips)


@pytest.mark.parametrize("rate", [3.5, -3.5])
@pytest.mark.parametrize("tilt", [0.0, 0.02])
def test_it_agrees_with_the_closed_form(rate: float, tilt: float, compiling: list[int]) -> None:
    system = tr.RollingSystem(BALL, tr.Support(tr.Plane(), motion=tr.Spin(rate), tilt=tilt))
    start, times = system.place((0.1, 0.0), (0.0, 0.2)), np.linspace(0.0, 200.0, 4001)
    ours, exact = (tr.simulate(system, start, 200.0, 0.05, method=method).data for method in ("runge-kutta", "exact"))
    assert compiling
    assert ours.time.size == times.size
    assert np.abs(ours.position - exact.position).max() < 1e-9 * np.abs(exact.position).max()
    assert np.abs(ours.velocity - exact.velocity).max() < 1e-9 * np.abs(exact.velocity).max()


@pytest.mark.parametrize("samples", [1, 2, 3, 499, 500, 501, 12345])
def test_any_number_of_samples(samples: int, compiling: list[int]) -> None:
    system = tr.RollingSystem(BALL, tr.Support(tr.Bowl(0.5), motion=tr.Spin(2.0)))
    start, times = system.place((0.1, 0.0), (0.0, 0.3)), np.linspace(0.0, 30.0, samples)
    ours = runge_kutta.solve(system, start, times)
    whole = runge_kutta.solve(system, start, np.linspace(0.0, 30.0, 3))
    assert ours.time.size == samples
    assert samples == 1 or compiling
    if samples > 1:
        np.testing.assert_allclose(ours.position[-1], whole.position[-1], atol=1e-15, rtol=0)


def test_an_event_after_many_steps(compiling: list[int]) -> None:
    """A ball on a tilted table drifts over the rim: when, the closed form says."""
    system = tr.RollingSystem(BALL, tr.Support(tr.Plane(rim=0.5), motion=tr.Spin(-3.49), tilt=0.005))
    start = system.place((0.1, 0.0), (0.0, 0.1))
    ours, exact = (tr.simulate(system, start, 300.0, 0.5, method=method) for method in ("runge-kutta", "exact"))
    assert compiling
    assert [event.kind for event in ours.events] == [event.kind for event in exact.events] == ["rim"]
    assert ours.events[0].time == pytest.approx(exact.events[0].time, rel=1e-10)
    assert ours.card().passed


def test_a_ball_that_slips_before_it_rolls(compiling: list[int]) -> None:
    """Grip at 2 v / (7 μ g), after as many steps as one likes."""
    system = tr.RollingSystem(BALL, tr.Support(tr.Plane(), friction=1e-3))
    start = system.place(velocity=(1.0, 0.0), angular_velocity=(0.0, 0.0, 0.0))
    run = tr.simulate(system, start, 40.0, 0.1, method="runge-kutta", tolerance=1e-13)
    assert [event.kind for event in run.events] == ["grip"]
    assert run.events[0].time == pytest.approx(2.0 / (7 * 1e-3 * 9.80665), rel=1e-10)
    assert run.card().passed
    del compiling


def test_with_and_without_numba_it_is_the_same_motion(without_numba: None) -> None:
    scenario = tr.Scenario.load("rattleback")
    system, start, times = scenario.system(), scenario.start_state(), np.linspace(0.0, 3.0, 31)
    alone = runge_kutta.solve(system, start, times, 1e-13)
    del without_numba
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(runge_kutta, "available", lambda: True)
        both = runge_kutta.solve(system, start, times, 1e-13)
    assert not np.array_equal(alone.position, both.position)  # the compiled loop has had a part in it
    np.testing.assert_allclose(both.position, alone.position, atol=1e-11, rtol=0)
    np.testing.assert_allclose(both.contact_force, alone.contact_force, rtol=1e-9)


def test_the_same_run_twice_is_the_same_to_the_last_bit() -> None:
    system = tr.RollingSystem(BALL, tr.Support(tr.Bowl(0.5), motion=tr.Spin(2.0)))
    start, times = system.place((0.1, 0.0), (0.0, 0.3)), np.linspace(0.0, 30.0, 301)
    first, second = (runge_kutta.solve(system, start, times) for _ in range(2))
    assert np.array_equal(first.position, second.position)
    assert np.array_equal(first.orientation, second.orientation)


@pytest.mark.parametrize("worth", [0.0, 1e30])
def test_a_pole_of_a_formula_is_told_in_the_same_words(worth: float, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(runge_kutta, "WORTH_THE_LOOP", worth)
    push = tr.Force(("0.01 / (20 - t)**2", 0.0, 0.0))
    system = tr.RollingSystem(BALL, tr.Support(tr.Plane()), loads=[push])
    with pytest.raises(SolverError, match=r"hardly gets on at t = 19\.99"):
        runge_kutta.solve(system, system.place(), np.linspace(0.0, 30.0, 3))


CURVED = {  # runs that end where the support is as hollow as the body is round, long before they were to end
    "torus": """
body = { kind = "torus", radius = 0.0547724, rim_radius = 0.0185524, density = 1450.6 }
start = { position = [-0.0389219, -0.100906], velocity = [-1.0191, 0.0256822], height = 0.0 }
run = { duration = 2.91484, every = 0.02 }
[support]
kind = "ellipsoidal-bowl"
semi_axes = [0.780151, 0.121782, 1.22505]
friction = 0.376703
kinetic_friction = 0.0876492
restitution = 0.0
motion = { kind = "precessing-tilt", angle = "180 deg", rate = 19.4172 }
""",
    "ring": """
body = { kind = "ring", radius = 0.0166339, mass = 1.2189 }
start = { position = [-0.0139648, 0.204229], spin = 2.17452, height = 0.00669226 }
run = { duration = 3.0, every = 0.01 }
[support]
kind = "height-field"
formula = "0.0205452*sin(29.6566*x)*cos(2.94579*x)"
friction = 0.914354
kinetic_friction = 0.0
restitution = 0.135226
motion = { kind = "uneven-spin", rate = 1.15237, variation = -0.492798, variation_rate = 0.193096 }
""",
    "slip whose steps grow before they shrink": """
loads = [{ kind = "rolling-resistance", offset = 0.00148 }]
start = { position = [0.0120094, -0.547027], spin = -0.322788, height = 0.0411317 }
run = { duration = 2.0, every = 0.0125588 }
[body]
kind = "torus"
radius = 0.0196534
rim_radius = 0.0150842
mass = 1.24498
products = [-2.12132e-05, 1.53195e-05, 1.72678e-05]
[support]
kind = "ellipsoidal-bowl"
semi_axes = [1.8455, 0.627171, 0.461982]
friction = 0.358805
motion = { kind = "tilt", angle = -0.0183536 }
""",
    "slip of a long law that settles after some dozens of steps": """
loads = [
    { kind = "pivot-friction", offset = 0.000261909, below = 9.22363 },
    { kind = "rolling-resistance", offset = 3.03991e-05 },
]
body = { kind = "hollow-sphere", radius = 0.0233189, mass = 0.0430259 }
run = { duration = 2.0, every = 0.01 }
[support]
kind = "cone"
half_angle = 0.0277551
side = "inside"
friction = 0.0621594
motion = { kind = "move", position = [0.0, "0.0240545*cos(0.412206*t) + 0.0402936", 0.0143341] }
[start]
position = [0.0367765, 0.0210314]
angular_velocity = [5.0983, 26.7958, 0.338171]
orientation = [-0.821432, 0.255377, 0.282854, 0.0]
""",
}


@pytest.mark.usefixtures("through_walls")
@pytest.mark.parametrize("name", CURVED)
@pytest.mark.parametrize("worth", [0.0, 1e30])
def test_a_law_followed_to_where_it_ends_the_run(name: str, worth: float, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(runge_kutta, "WORTH_THE_LOOP", worth)
    run = tr.Scenario.loads(CURVED[name]).run()
    assert run.events[-1].kind == "curved", run.events


def slipping_again_and_again(duration: float) -> tr.Scenario:
    """A flat stone that slides down a slope and spins: it slips and rolls in turns, and each slip begins slowly."""
    body = {"kind": "ellipsoid", "semi_axes": [0.2, 0.03, 0.02], "mass": 1.0, "moments": [2e-4, 1.6e-3, 1.7e-3]}
    start = {"position": [0, 0], "angular_velocity": [0, -0.0617, 5.0], "attitude": ["0 deg", "0.7071 deg", "45 deg"]}
    tables = {
        "body": body | {"products": [2e-5, 0, 0], "centre": [0, 0, 0.01]},
        "support": {"kind": "plane", "tilt": "12 deg", "friction": 0.4},
        "start": start | {"velocity": "rolling"},
        "run": {"duration": duration, "every": 0.1, "method": "runge-kutta"},
    }
    return tr.Scenario.loads(tomli_w.dumps(tables))


@pytest.mark.parametrize("duration", [1.0, 1.4])
def test_what_a_run_has_had_compiled_is_there_for_each_later_stretch(
    duration: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    scenario, steps, one_by_one = slipping_again_and_again(duration), [0], runge_kutta._one_by_one

    def counted(*given: Any) -> Any:
        for path in one_by_one(*given):
            steps[0] += path.count
            yield path

    with monkeypatch.context() as patch:
        patch.setattr(runge_kutta, "_one_by_one", counted)
        run = scenario.run()
    slips = sum(event.kind == "slip" for event in run.events)
    assert slips >= 12
    assert steps[0] < 65 * slips  # 100 where each of them sets out one by one
    assert run.card().passed
    # What this process has compiled meanwhile has no part in it.
    assert np.array_equal(scenario.run().samples.position, run.samples.position)


@pytest.mark.parametrize("rate", [0.5, -2.0])
@pytest.mark.parametrize("tolerance", [1e-13, 1e-12, 1e-9])
@pytest.mark.parametrize("worth", [0.0, 1e30])
@pytest.mark.parametrize("carried", [(), (tr.Shake((0.0, 0.0, 0.002), 20.0),)], ids=["alone", "shaken"])
def test_an_axle_that_a_dry_bearing_stops_is_still_then(
    carried: tuple[tr.Motion, ...], worth: float, tolerance: float, rate: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """I ω̇ = −τ ω/√(ω² + b²): t = I (F(ω₀) − F(ω))/τ, F = √(ω² + b²) + b ln(ω/(b + √(ω² + b²))), b = 0.01 rad/s.

    It dies out 400 times a second in the end: were steps as long as the motion alone allows, the rate would tremble.
    """
    monkeypatch.setattr(runge_kutta, "WORTH_THE_LOOP", worth)
    inertia, torque, ease = 0.002, 0.008, 0.01
    axle = tr.FreeAxle(inertia, rate=rate, bearing_torque=torque, below=ease)
    table = tr.Support(tr.Plane(), motion=tr.Combined((*carried, axle)) if carried else axle, friction=0.0)
    system = tr.RollingSystem(BALL, table)
    run = tr.simulate(
        system, system.place((0.1, 0.0), (0.0, 0.1)), 2.0, 0.01, method="runge-kutta", tolerance=tolerance
    )
    found = run.samples.support_coordinates[:, -1] / rate * abs(rate)

    def F(w: Any) -> Any:
        root = np.hypot(w, ease)
        return root + ease * np.log(w / (ease + root))

    turning = found > 1e-5 * abs(rate)
    wanted = inertia * (F(abs(rate)) - F(found[turning])) / torque
    np.testing.assert_allclose(wanted, run.samples.time[turning], rtol=0, atol=1e4 * tolerance + 1e-12)
    assert turning.sum() > 10
    assert np.abs(found[run.samples.time > 1.5]).max() < 1e-13
    assert run.card().passed


HIDDEN = """
import sys
sys.modules["heyoka"] = None
import importlib.util
found = importlib.util.find_spec
importlib.util.find_spec = lambda name, *more: None if name == "heyoka" else found(name, *more)
import warnings
import trundle as tr
with warnings.catch_warnings(record=True) as said:
    warnings.simplefilter("always")
    run = tr.Scenario.load(sys.argv[1]).run()
    card = run.card()
assert "heyoka" in str(said[0].message), [str(one.message) for one in said]
print(run.method, card.passed, card)
"""


@pytest.mark.parametrize("name", ["rattleback", "coin-in-a-circle", "ball-in-a-turning-bowl", "tippe-top"])
def test_without_heyoka_every_scenario_passes_its_card(name: str, tmp_path: Path) -> None:
    (tmp_path / "hidden.py").write_text(HIDDEN)
    done = subprocess.run(  # noqa: S603
        [sys.executable, tmp_path / "hidden.py", name], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("runge-kutta True"), done.stdout
    assert "DOP853" in done.stdout


def test_where_there_are_no_owners_the_cache_is_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As on Windows, where every file seems to be anybody's to write."""
    folder = tmp_path / "cache"
    monkeypatch.delattr(os, "getuid", raising=False)
    monkeypatch.setattr(integrator_cache, "cache_folder", lambda: folder)
    integrator_cache.store("a", {"some": "thing"})
    for path in (folder, *folder.iterdir()):
        path.chmod(0o777)
    assert integrator_cache.load("a") == {"some": "thing"}
