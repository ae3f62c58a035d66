"""What a figure says in words: the title where none is given, and the line of key numbers."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from trundle.mechanics import loads, motions, shapes, surfaces
from trundle.mechanics.expressions import Expression
from trundle.mechanics.scalars import is_zero

from .scales import as_ratio, short, with_unit

if TYPE_CHECKING:
    from trundle.mechanics.bodies import Body
    from trundle.mechanics.loads import Load
    from trundle.mechanics.motions import Motion
    from trundle.mechanics.surfaces import Surface
    from trundle.mechanics.system import RollingSystem

LONGEST = 34  # letters of a formula that are shown
SEPARATOR = "  ·  "


def title_of(system: RollingSystem) -> str:
    """Say what rolls on what.

    Parameters
    ----------
    system : RollingSystem
        What moved.

    Returns
    -------
    str
        For instance "Ball in a turning bowl".

    Examples
    --------
    >>> import trundle as tr
    >>> ball = tr.Body.solid_sphere(radius=0.02, mass=0.05)
    >>> title_of(tr.RollingSystem(ball, tr.Support(tr.Bowl(0.5), motion=tr.Spin(4.0))))
    'Ball in a turning bowl'
    >>> title_of(tr.RollingSystem(ball, tr.Support(tr.Plane(), motion=tr.SpinBy("3.5*(1 - exp(-t/2))"), tilt=0.1)))
    'Ball on an unevenly turning, tilted plane'
    """
    support = system.support
    where, name = _place(support.surface)
    ways = [moves(support.motion)]
    if support.tilt and not isinstance(support.surface, surfaces.Cylinder):
        ways.append("tilted")
    words = f"{', '.join(way for way in ways if way)} {name}"
    article = "an" if words[0] in "aeiou" else "a"
    noun = noun_of(system.body)
    return f"{noun[0].upper()}{noun[1:]} {where} {article} {words}"


def noun_of(body: Body) -> str:
    """Name a body by its shape.

    Parameters
    ----------
    body : Body
        What rolls.

    Returns
    -------
    str
        Such as "ball".

    Examples
    --------
    >>> import trundle as tr
    >>> noun_of(tr.Body.ring(0.1, 1.0)), noun_of(tr.Body.hemisphere(0.1, 1.0))
    ('ring', 'half-ball')
    """
    shape = body.shape
    if isinstance(shape, shapes.Disc):
        third, radius = getattr(body.inertia, "z", 0.0), shape.radius
        return "ring" if third > 0.8 * body.mass * radius**2 else "disc"
    for kind, noun in _NOUNS:
        if isinstance(shape, kind):
            return noun
    return "cylinder" if shape.axis is not None else "body"


_NOUNS: tuple[tuple[type, str], ...] = (
    (shapes.HalfCylinder, "half-cylinder"),
    (shapes.Roller, "cylinder"),
    (shapes.Hemisphere, "half-ball"),
    (shapes.Sphere, "ball"),
    (shapes.Torus, "ring"),
    (shapes.Ellipsoid, "ellipsoid"),
)


def moves(motion: Motion) -> str:
    """Say in a word or two how a support moves.

    Parameters
    ----------
    motion : Motion
        Of the support.

    Returns
    -------
    str
        Such as "turning".

    Examples
    --------
    >>> import trundle as tr
    >>> moves(tr.Spin(0.0)), moves(tr.Combined((tr.Shake((0.01, 0, 0), 6.0), tr.Spin(3.0))))
    ('fixed', 'shaken, turning')
    """
    if isinstance(motion, motions.Combined):
        return ", ".join(dict.fromkeys(moves(part) for part in motion.parts if moves(part) != "fixed")) or "fixed"
    if motion.steady_rate is not None:
        return "turning" if motion.steady_rate else "fixed"
    for kind, word in _MOVES:
        if isinstance(motion, kind):
            return word
    return "moving"


_MOVES: tuple[tuple[type, str], ...] = (
    (motions.SpinBy, "unevenly turning"),
    (motions.FreeAxle, "freely turning"),
    (motions.UnevenSpin, "unevenly turning"),
    (motions.Wobble, "turning"),
    (motions.Rock, "rocking"),
    (motions.Shake, "shaken"),
    (motions.Tilt, "tilting"),
    (motions.PrecessingTilt, "swirled"),
    (motions.Move, "moving"),
)


def ground_of(surface: Surface) -> str:
    """Name what is rolled on, in one word.

    Parameters
    ----------
    surface : Surface
        Of the support.

    Returns
    -------
    str
        Such as "table".

    Examples
    --------
    >>> import trundle as tr
    >>> ground_of(tr.Plane()), ground_of(tr.Cylinder(0.5)), ground_of(tr.EllipsoidalBowl((0.5, 0.4, 0.3)))
    ('table', 'wall', 'bowl')
    """
    named: dict[type, str] = {surfaces.Plane: "table", surfaces.Cylinder: "wall"}
    return named.get(type(surface)) or _place(surface)[1].replace("surface of revolution", "surface").split()[-1]


def _place(surface: Surface) -> tuple[str, str]:
    """Return preposition and name of a surface."""
    if isinstance(surface, surfaces.Cylinder | surfaces.Cone | surfaces.TorusTrack):
        names = {surfaces.Cylinder: "cylinder", surfaces.Cone: "cone", surfaces.TorusTrack: "torus"}
        return surface.side, names[type(surface)]
    if isinstance(surface, surfaces.Paraboloid):
        return ("in", "paraboloid") if surface.radius > 0 else ("on", "mound")
    for kind, place in _PLACES:
        if isinstance(surface, kind):
            return place
    return "on", "surface"


_PLACES: tuple[tuple[type, tuple[str, str]], ...] = (
    (surfaces.Plane, ("on", "plane")),
    (surfaces.Bowl, ("in", "bowl")),
    (surfaces.Dome, ("on", "dome")),
    (surfaces.EllipsoidalBowl, ("in", "elliptic bowl")),
    (surfaces.Revolution, ("on", "surface of revolution")),
    (surfaces.RevolutionTable, ("on", "surface of revolution")),
)


def key_numbers(system: RollingSystem, own: tuple[float, ...] | None = None) -> str:
    """Write the line of key numbers: of the support's motion, its surface, the body, friction and the loads.

    Parameters
    ----------
    system : RollingSystem
        What moved.
    own : tuple of float, optional
        The coordinates of the support's own motion at the start; absent: as the motion itself starts.

    Returns
    -------
    str
        Parts with dots between.

    Examples
    --------
    >>> import trundle as tr
    >>> ball = tr.Body.solid_sphere(radius=0.02, mass=0.05)
    >>> table = tr.Support(tr.Plane(), motion=tr.FreeAxle(0.03, rate=3.0), friction=0.2)
    >>> key_numbers(tr.RollingSystem(ball, table, loads=(tr.RollingResistance(0.0005),))).split(SEPARATOR)[:2]
    ['free table of 0.03 kg m², at first 3 rad/s (28.65 rpm)', 'inertia ratio k = 2/5']
    """
    support = system.support
    wall = isinstance(support.surface, surfaces.Cylinder)
    first = tuple(map(float, support.motion.own_start())) if own is None else own
    parts = _moving(support.motion, ground_of(support.surface), first)
    parts += _of_surface(support.surface)
    if support.tilt and not wall:
        parts.append(f"tilt {_degrees(support.tilt)}")
    parts += _of_body(system.body)
    if support.friction is not None:
        kinetic = support.kinetic_friction
        also = "" if kinetic is None or kinetic == support.friction else f", slipping {short(float(kinetic), 3)}"
        parts.append(f"friction μ = {short(float(support.friction), 3)}{also}")
    for e, what in ((support.restitution, "restitution e"), (support.tangential_restitution, "of the slip e_t")):
        if not is_zero(e):
            parts.append(f"{what} = {short(float(e), 3)}")
    return SEPARATOR.join(parts + [text for load in system.loads for text in _of_load(load)])


def _moving(motion: Motion, what: str, own: tuple[float, ...]) -> list[str]:
    if isinstance(motion, motions.Combined):
        return [text for part in motion.parts for text in _moving(part, what, own)]
    if motion.steady_rate is not None:
        return [f"{what} {_rate(float(motion.steady_rate))}"] if motion.steady_rate else []
    if isinstance(motion, motions.SpinBy):
        return [f"{what} {_formula(motion.rate, 'ω', 'rad/s')}"]
    if isinstance(motion, motions.FreeAxle):
        return [f"free {what} of {short(float(motion.inertia), 3)} kg m², at first {_rate(own[-1])}"]
    if isinstance(motion, motions.UnevenSpin):
        uneven = f"uneven by {short(100 * float(motion.variation), 3)} %"
        return [f"{what} {_rate(float(motion.rate))}", uneven]
    if isinstance(motion, motions.Wobble):
        return [f"{what} {_rate(float(motion.rate))}", f"askew by {_degrees(motion.angle)}"]
    if isinstance(motion, motions.Rock):
        return [f"rocking by {_degrees(motion.amplitude)} at {short(float(motion.rate), 4)} rad/s"]
    if isinstance(motion, motions.Shake):
        size = float(motion.amplitude.norm())
        return [f"shaken by {with_unit(size, 'length')} at {short(float(motion.rate), 4)} rad/s"]
    if isinstance(motion, motions.Tilt):
        return [f"{what} tilts by {_formula(motion.angle, 'θ', 'rad')}"]
    if isinstance(motion, motions.PrecessingTilt):
        return [f"swirled: leaning {_degrees(motion.angle)}, round at {short(float(motion.rate), 4)} rad/s"]
    return []


def _of_surface(surface: Surface) -> list[str]:
    if isinstance(surface, surfaces.Cylinder):
        return [f"wall of radius {_length(surface.radius)}"]
    if isinstance(surface, surfaces.Bowl | surfaces.Dome):
        return [f"{ground_of(surface)} of radius {_length(surface.radius)}"]
    if isinstance(surface, surfaces.Cone):
        return [f"half-angle {_degrees(surface.half_angle)}"]
    if isinstance(surface, surfaces.TorusTrack):
        return [f"ring {_length(surface.ring_radius)}, tube {_length(surface.tube_radius)}"]
    if isinstance(surface, surfaces.Paraboloid):
        return [f"radius at the vertex {_length(abs(surface.radius))}"]
    if isinstance(surface, surfaces.EllipsoidalBowl):
        return [f"semi-axes {_lengths(surface.semi_axes)}"]
    if isinstance(surface, surfaces.Revolution | surfaces.HeightField):
        return [f"z = {_cut(surface.formula.text)}"]
    return []


def _of_body(body: Body) -> list[str]:
    if body.is_isotropic_sphere:
        radius = float(getattr(body.shape, "radius", 0.0))
        return [f"inertia ratio k = {as_ratio(float(body.inertia_ratio))}", f"radius {_small(radius)}"]
    shape = body.shape
    if isinstance(shape, shapes.Ellipsoid):
        return [f"body {_lengths((shape.a, shape.b, shape.c))}"]
    if isinstance(shape, shapes.Torus):
        return [f"radius {_small(float(shape.radius))}, rim {_small(float(shape.rim_radius))}"]
    return [f"radius {_small(float(shape.radius))}"] if hasattr(shape, "radius") else []


def _of_load(load: Load) -> list[str]:
    if isinstance(load, loads.Force | loads.Torque | loads.Motor):
        name, kind = next((name, kind) for cls, name, kind in _GIVEN if isinstance(load, cls))
        size = with_unit(math.hypot(*map(float, load.value)), kind) if _constant(load) else "that varies"
        return [f"{name} {size}"]
    if isinstance(load, loads.Drag):
        return [f"drag {with_unit(float(load.coefficient), 'damping')}{_air(load)}"]
    if isinstance(load, loads.QuadraticDrag):
        return [f"quadratic drag {short(float(load.coefficient), 3)} kg/m{_air(load)}"]
    if isinstance(load, loads.Magnus):
        return [f"Magnus force, {short(float(load.coefficient), 3)} kg"]
    if isinstance(load, loads.RollingResistance):
        return [f"rolling resistance δ = {_length(load.offset)}"]
    if isinstance(load, loads.PivotFriction):
        return [f"pivot friction ε = {_length(load.offset)}"]
    if isinstance(load, loads.RollingCouple):
        return [f"rolling couple {short(float(load.coefficient), 3)} N m s"]
    if isinstance(load, loads.Potential):
        return [f"potential U = {_cut(load.formula.text)}"]
    return []


_GIVEN: tuple[tuple[type, str, str], ...] = (
    (loads.Force, "force", "force"),
    (loads.Torque, "torque", "torque"),
    (loads.Motor, "motor torque", "torque"),
)


def _constant(load: Any) -> bool:
    return not any(isinstance(part, Expression) for part in load.value)


def _air(load: Any) -> str:
    return "" if is_zero(load.air) else ", air turning"


def _formula(value: Any, name: str, unit: str) -> str:
    if isinstance(value, Expression):
        return f"{name}(t) = {_cut(value.text)}"
    return f"{name} = {short(float(value), 4)} {unit}"


def _cut(text: str) -> str:
    tidy = text.replace("**", "^").replace("*", "·").replace("-", "−")
    return tidy if len(tidy) <= LONGEST else f"{tidy[: LONGEST - 1]}…"


def _rate(rate: float) -> str:
    per_minute = rate * 30 / math.pi
    text = f"{short(rate, 4)} rad/s"
    return f"{text} ({short(per_minute, 4)} rpm)" if 0.1 <= abs(per_minute) < 1e5 else text


def _degrees(angle: Any) -> str:
    return f"{short(math.degrees(float(angle)), 4)}°"


def _length(value: Any) -> str:
    return with_unit(float(value), "length")


def _small(radius: float) -> str:
    """Write a radius in millimetres where balls are sold by them."""
    return f"{radius * 1e3:.4g} mm" if 1e-3 <= radius < 0.1 else with_unit(radius, "length")


def _lengths(values: Any) -> str:
    return " × ".join(_length(value) for value in values)
