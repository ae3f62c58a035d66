"""What a figure says in words: the title where none is given, and the line of key numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING

from trundle.mechanics.scalars import is_zero
from trundle.wording import as_ratio, degrees, short

if TYPE_CHECKING:
    from trundle.mechanics.bodies import Body
    from trundle.mechanics.system import RollingSystem

SEPARATOR = "  ·  "


def title_of(system: RollingSystem) -> str:
    """Say what rolls on what.

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
    ways = [support.motion.way]
    if support.tilt and support.surface.wall_radius is None:
        ways.append("tilted")
    words = f"{', '.join(way for way in ways if way)} {support.surface.noun}"
    article = "an" if words[0] in "aeiou" else "a"
    noun = system.body.shape.noun_of(system.body)
    return f"{noun[0].upper()}{noun[1:]} {support.surface.where} {article} {words}"


def key_numbers(system: RollingSystem, coordinates: tuple[float, ...] | None = None) -> str:
    """Write the line of key numbers: of the support's motion, its surface, the body, friction and the loads.

    Examples
    --------
    >>> import trundle as tr
    >>> ball = tr.Body.solid_sphere(radius=0.02, mass=0.05)
    >>> table = tr.Support(tr.Plane(), motion=tr.FreeAxle(0.03, rate=3.0), friction=0.2)
    >>> key_numbers(tr.RollingSystem(ball, table, loads=(tr.RollingResistance(0.0005),))).split(SEPARATOR)[:2]
    ['free table of 0.03 kg m², at first 3 rad/s (28.65 rpm)', 'inertia ratio k = 2/5']
    """
    support = system.support
    wall = support.surface.wall_radius is not None
    first = tuple(map(float, support.motion.initial_coordinates())) if coordinates is None else coordinates
    parts = support.motion.key_numbers(support.surface.ground, first) + support.surface.key_numbers()
    if support.tilt and not wall:
        parts.append(f"tilt {degrees(support.tilt)}")
    parts += _of_body(system.body)
    if support.friction is not None:
        kinetic = support.kinetic_friction
        also = "" if kinetic is None or kinetic == support.friction else f", slipping {short(float(kinetic), 3)}"
        parts.append(f"friction μ = {short(float(support.friction), 3)}{also}")
    for e, what in ((support.restitution, "restitution e"), (support.tangential_restitution, "of the slip e_t")):
        if not is_zero(e):
            parts.append(f"{what} = {short(float(e), 3)}")
    return SEPARATOR.join(parts + [text for load in system.loads for text in load.key_numbers()])


def _of_body(body: Body) -> list[str]:
    ratio = [f"inertia ratio k = {as_ratio(float(body.inertia_ratio))}"] if body.is_isotropic_sphere else []
    return ratio + body.shape.key_numbers()
