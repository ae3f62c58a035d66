"""Short runs that between them come to every phase, event, surface and load: on them the mutants are tried."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import trundle as tr
from trundle.simulation.trajectory import Trajectory

BALL = {"radius": 0.03, "mass": 0.2}


def _egg(**support: Any) -> tuple[tr.Body, tr.Support]:
    body = tr.Body.ellipsoid((0.03, 0.04, 0.05), 0.2, moments=(1.5e-4, 1.3e-4, 1.0e-4), centre=(0.001, -0.002, 0.003))
    return body, tr.Support(**support)


def _run(system: tr.RollingSystem, start: tr.State, duration: float, method: str = "runge-kutta") -> Trajectory:
    return tr.simulate(system, start, duration, duration / 40, method=method)


def egg_rolls() -> Trajectory:
    """A body that is no ball rolls on a tilted turning table."""
    system = tr.RollingSystem(*_egg(surface=tr.Plane(), motion=tr.Spin(2.0), tilt=0.1))
    return _run(system, system.place((0.1, 0.0), (0.1, 0.3), spin=3.0, attitude=(0.3, 0.4, 0.5)), 0.4)


def egg_in_rocking_bowl() -> Trajectory:
    """The same in a bowl that is rocked and shaken."""
    motion = tr.Combined((tr.Rock(0.2, 5.0), tr.Shake((0.0, 0.01, 0.005), 9.0)))
    system = tr.RollingSystem(*_egg(surface=tr.Bowl(0.5), motion=motion))
    return _run(system, system.place((0.1, 0.1), (0.3, 0.2), spin=3.0, attitude=(0.3, 0.4, 0.5)), 0.3)


def egg_slips_in_bowl() -> Trajectory:
    """The same, slipping in a bowl that turns unevenly."""
    system = tr.RollingSystem(*_egg(surface=tr.Bowl(0.5), motion=tr.UnevenSpin(4.0, 0.3, 5.0), friction=0.1))
    start = system.place((0.1, 0.1), (0.5, 0.2), angular_velocity=(3.0, -4.0, 5.0), attitude=(0.3, 0.4, 0.5))
    return _run(system, start, 0.15)


def egg_slips_off_dome() -> Trajectory:
    """The same slips off a dome."""
    system = tr.RollingSystem(*_egg(surface=tr.Dome(0.5), friction=0.1, kinetic_friction=0.08))
    start = system.place((0.1, 0.1), (1.2, 0.2), angular_velocity=(3.0, -4.0, 5.0), attitude=(0.3, 0.4, 0.5))
    return _run(system, start, 0.4)


def ball_turns_back_in_pipe() -> Trajectory:
    """A ball is dragged to and fro round an upright pipe that rocks about its axis: N is 0 where it turns back."""
    pipe = tr.Support(tr.Cylinder(0.25), motion=tr.Rock(0.7, 3.0, axis=(0.0, 0.0, 1.0)))
    system = tr.RollingSystem(tr.Body.solid_sphere(**BALL), pipe)
    return _run(system, system.place((0.0, 0.0), (0.15, 0.0)), 1.5)


def egg_bounces() -> Trajectory:
    """The same is thrown down, and its slip turns at each landing."""
    system = tr.RollingSystem(*_egg(surface=tr.Plane(), motion=tr.Spin(3.0), friction=0.3, restitution=0.6))
    start = system.place(
        (0.1, 0.0), (1.0, 0.3, -1.0), height=0.02, attitude=(0.3, 0.4, 0.5), angular_velocity=(3.0, -9, 5)
    )
    return _run(system, start, 0.25)


def egg_over_bowl(duration: float = 0.13) -> Trajectory:
    """The same is thrown through the air over a bowl that turns and is shaken, and lands on it."""
    motion = tr.Combined((tr.Spin(3.0), tr.Shake((0.0, 0.01, 0.005), 9.0)))
    system = tr.RollingSystem(*_egg(surface=tr.Bowl(0.5), motion=motion, friction=0.3))
    start = system.place(
        (0.1, 0.0), (1.0, 0.3, 0.5), height=0.02, attitude=(0.3, 0.4, 0.5), angular_velocity=(3.0, -9, 5)
    )
    return _run(system, start, duration)


def egg_grips_in_bowl() -> Trajectory:
    """And slips there until it grips."""
    return egg_over_bowl(0.16)


def billiard() -> Trajectory:
    """A ball with draw slips, and grips."""
    system = tr.RollingSystem(tr.Body.solid_sphere(**BALL), tr.Support(tr.Plane(), friction=0.2))
    return _run(system, system.place((0.0, 0.0), (1.0, 0.2), angular_velocity=(5.0, -30.0, 8.0)), 0.6)


def ball_bounces() -> Trajectory:
    """A ball is dropped with backspin, bounces, and is set down."""
    system = tr.RollingSystem(tr.Body.solid_sphere(**BALL), tr.Support(tr.Plane(), friction=0.3, restitution=0.4))
    return _run(system, system.place((0.0, 0.0), (0.5, 0.0), height=0.05, angular_velocity=(5.0, -30.0, 8.0)), 0.6)


def ball_on_free_table() -> Trajectory:
    """A ball is dropped on a table that turns freely, with a motor and a bearing."""
    axle = tr.FreeAxle(1e-3, rate=5.0, motor_torque="0.002*cos(9*t)", bearing_drag=1e-4)
    support = tr.Support(tr.Plane(), motion=axle, friction=0.3, restitution=0.3)
    loads = (tr.RollingCouple(1e-4), tr.PivotFriction(1e-3, 0.5))
    system = tr.RollingSystem(tr.Body.solid_sphere(**BALL), support, loads)
    return _run(system, system.place((0.1, 0.05), (0.2, 0.0), height=0.01, angular_velocity=(3.0, -9.0, 5.0)), 0.2)


def egg_on_free_table() -> Trajectory:
    """A body that is no ball rolls on such a table."""
    axle = tr.FreeAxle(1e-3, rate=5.0, motor_torque="0.002*cos(9*t)", bearing_drag=1e-4)
    body, support = _egg(surface=tr.Plane(), motion=axle)
    system = tr.RollingSystem(body, support, (tr.RollingCouple(1e-4), tr.PivotFriction(1e-3, 0.5)))
    return _run(system, system.place((0.1, 0.05), (0.2, 0.0), spin=5.0, attitude=(0.3, 0.4, 0.5)), 0.3)


def ball_off_dome() -> Trajectory:
    """A ball rolls off a dome without slipping."""
    system = tr.RollingSystem(tr.Body.solid_sphere(**BALL), tr.Support(tr.Dome(0.3)))
    return _run(system, system.place((0.02, 0.0), (0.3, 0.0)), 0.5)


def ball_slips_off_dome() -> Trajectory:
    """A ball rolls on a dome, slips, and lifts off."""
    system = tr.RollingSystem(tr.Body.solid_sphere(**BALL), tr.Support(tr.Dome(0.3), friction=0.3))
    return _run(system, system.place((0.02, 0.0), (0.3, 0.05)), 0.45)


def ball_on_rocking_table() -> Trajectory:
    """A ball rolls, slips and grips on a table that is rocked."""
    support = tr.Support(tr.Plane(), motion=tr.Rock(0.3, 12.0), friction=0.2)
    system = tr.RollingSystem(tr.Body.solid_sphere(**BALL), support)
    return _run(system, system.place((0.05, 0.0), (0.0, 0.2)), 0.4)


def ball_comes_to_rest() -> Trajectory:
    """A ball comes to rest against rolling resistance, and is driven on by a push that grows."""
    loads = (tr.RollingResistance(2e-3), tr.Force(("0.3*t", 0.0, 0.0)))
    system = tr.RollingSystem(tr.Body.solid_sphere(**BALL), tr.Support(tr.Plane(), friction=0.5), loads)
    return _run(system, system.place((0.0, 0.0), (-0.05, 0.0)), 0.6)


def ball_slows_down() -> Trajectory:
    """A ball comes to rest against rolling resistance, and stays."""
    loads = (tr.RollingResistance(2e-3),)
    system = tr.RollingSystem(tr.Body.solid_sphere(**BALL), tr.Support(tr.Plane(), friction=0.5), loads)
    return _run(system, system.place((0.0, 0.0), (-0.05, 0.0)), 0.6)


def ball_over_a_crest() -> Trajectory:
    """A ball rolls over a crest so fast that it only just slips."""
    system = tr.RollingSystem(tr.Body.solid_sphere(**BALL), tr.Support(tr.HeightField("0.02*cos(8*x)"), friction=1.0))
    return _run(system, system.place((-0.3, 0.0), (2.90456, 0.0)), 0.12)


def egg_under_loads() -> Trajectory:
    """Most loads at once."""
    loads = (
        tr.Drag(0.05, air=2.0),
        tr.QuadraticDrag(0.1, air=-1.0),
        tr.Magnus(0.01),
        tr.Potential("2*x**2 + 3*y**2 + 0.1*x*y"),
        tr.Force((0.1, 0.05, 0.02)),
        tr.Torque((1e-3, "2e-3*sin(9*t)", 1e-3)),
        tr.Motor((1e-3, 2e-3, "1e-3*cos(5*t)")),
        tr.RollingCouple(1e-4, 2e-4),
        tr.PivotFriction(1e-3, 0.5),
        tr.RollingResistance(1e-4),
    )
    body, support = _egg(surface=tr.Plane(), tilt=0.05)
    system = tr.RollingSystem(body, support, loads)
    return _run(system, system.place((0.1, 0.05), (0.5, 0.2), spin=5.0, attitude=(0.3, 0.4, 0.5)), 0.3)


def cylinder_in_pipe() -> Trajectory:
    """A cylinder rolls to and fro in a pipe that turns."""
    support = tr.Support(tr.Cylinder(0.5), motion=tr.Spin(2.0), tilt="90 deg")
    system = tr.RollingSystem(tr.Body.cylinder(0.03, 0.2), support)
    return _run(system, system.place((0.5, 0.0), (0.2, 0.0)), 0.5)


def off_the_rim() -> Trajectory:
    """A ball runs off a table."""
    system = tr.RollingSystem(tr.Body.solid_sphere(**BALL), tr.Support(tr.Plane(rim=0.2), motion=tr.Spin(3.0)))
    return _run(system, system.place((0.1, 0.0), (0.3, 0.2)), 0.6)


def over_its_edge() -> Trajectory:
    """A hemisphere rocks over its edge."""
    system = tr.RollingSystem(tr.Body.hemisphere(0.05, 0.3), tr.Support(tr.Plane()))
    return _run(system, system.place((0.0, 0.0), (0.9, 0.1)), 0.5)


def ball_pushed() -> Trajectory:
    """A ball rolls on a table, pushed by a constant force."""
    system = tr.RollingSystem(tr.Body.solid_sphere(**BALL), tr.Support(tr.Plane()), (tr.Force((0.1, 0.05, 0.02)),))
    return _run(system, system.place((0.1, 0.05), (0.5, 0.2)), 0.3)


def ball_in_air() -> Trajectory:
    """A ball rolls on a turning table in still air."""
    support = tr.Support(tr.Plane(), motion=tr.Spin(2.0))
    system = tr.RollingSystem(tr.Body.solid_sphere(**BALL), support, (tr.Drag(0.05),))
    return _run(system, system.place((0.1, 0.05), (0.5, 0.2)), 0.3)


def incline_too_steep() -> Trajectory:
    """A ball is put down on a slope that is too steep for it to roll."""
    support = tr.Support(tr.Plane(), tilt=0.6, friction=0.15)
    system = tr.RollingSystem(tr.Body.solid_sphere(**BALL), support)
    return _run(system, system.place(), 0.3)


def ball_lands_on_ice() -> Trajectory:
    """A ball lands where there is hardly any friction, and goes on slipping."""
    system = tr.RollingSystem(tr.Body.solid_sphere(**BALL), tr.Support(tr.Plane(), friction=0.02))
    return _run(system, system.place((0.0, 0.0), (0.5, 0.0), height=0.02), 0.2)


def egg_lands(friction: float) -> Trajectory:
    """A body that is no ball is dropped without any slip at first."""
    system = tr.RollingSystem(*_egg(surface=tr.Plane(), friction=friction, restitution=0.5))
    return _run(system, system.place((0.0, 0.0), height=0.02, attitude=(0.3, 0.9, 0.5)), 0.15)


def egg_grips_as_it_lands() -> Trajectory:
    """The slip ends in a landing, and stays so."""
    return egg_lands(2.0)


def egg_slips_as_it_lands() -> Trajectory:
    """The slip begins in a landing."""
    return egg_lands(0.02)


def egg_jerked() -> Trajectory:
    """A body that is no ball rolls on a floor that jerks up and aside."""
    motion = tr.Move(("0.2*abs(t - 0.05)", "0.1*t", "0.1*abs(t - 0.05)"))
    system = tr.RollingSystem(*_egg(surface=tr.Plane(), motion=motion, friction=0.3, restitution=0.4))
    return _run(system, system.place((0.1, 0.0), (0.1, 0.3), spin=3.0, attitude=(0.3, 0.4, 0.5)), 0.1)


def _ball_moved(*position: Any, friction: float | None = None) -> Trajectory:
    support = tr.Support(tr.Plane(), motion=tr.Move(position), friction=friction)
    system = tr.RollingSystem(tr.Body.solid_sphere(**BALL), support)
    return _run(system, system.place(velocity=(0.2, 0.1)), 0.3, "taylor")


def ball_jerked_sideways() -> Trajectory:
    """A floor on which nothing can slip jerks sideways under a ball."""
    return _ball_moved("0.2*abs(t - 0.05)", 0.0, 0.0)


def ball_left_behind() -> Trajectory:
    """A floor drops away from under a ball."""
    return _ball_moved(0.0, 0.0, "-0.2*abs(t - 0.05)", friction=0.3)


def ball_on_table_that_speeds_up() -> Trajectory:
    """A ball rolls on a turntable, until all at once that speeds up more than friction can follow."""
    motion = tr.SpinBy("5 + 15*(abs(t - 0.1) + t - 0.1)")
    system = tr.RollingSystem(tr.Body.solid_sphere(**BALL), tr.Support(tr.Plane(), motion=motion, friction=0.1))
    return _run(system, system.place((0.3, 0.0)), 0.3, "taylor")


def cylinder_exactly() -> Trajectory:
    """A cylinder rolls to and fro in a pipe, by its closed form."""
    system = tr.RollingSystem(tr.Body.cylinder(**BALL), tr.Support(tr.Cylinder(0.5), tilt="90 deg"))
    return _run(system, system.place((0.5, 0.0), (0.2, 0.0)), 1.0, "exact")


def turntable_exactly() -> Trajectory:
    """A ball on a tilted turntable, by its closed form."""
    system = tr.RollingSystem(tr.Body.solid_sphere(**BALL), tr.Support(tr.Plane(), motion=tr.Spin(3.5), tilt=0.05))
    return _run(system, system.place((0.1, 0.03), (0.05, 0.2), spin=2.0), 2.0, "exact")


def billiard_exactly() -> Trajectory:
    """A ball slips and grips, by closed forms."""
    system = tr.RollingSystem(tr.Body.solid_sphere(**BALL), tr.Support(tr.Plane(), friction=0.2))
    return _run(system, system.place((0.0, 0.0), (1.0, 0.2), angular_velocity=(5.0, -30.0, 8.0)), 0.6, "exact")


RUNS: dict[str, Callable[[], Trajectory]] = {
    function.__name__: function
    for function in list(globals().values())
    if callable(function)
    and getattr(function, "__module__", "") == __name__
    and function.__name__[0] != "_"
    and function.__code__.co_argcount <= len(function.__defaults__ or ())
}
