"""What theory promises of a run beside what its samples show, each number taken in two ways that share nothing."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from ...mechanics.system import RollingSystem, State
from ...solve.exact import (
    BallInLeaningCylinder,
    BallInUprightCylinder,
    ChaplyginBall,
    ClosedForm,
    CylinderOnCylinder,
    SlidingSphere,
    SphereComingToRest,
    SphereInFlight,
    SphereInMovingAir,
    SphereOnFreePlane,
    SphereOnPlane,
    SphereOnSphere,
    SphereOnUnsteadyPlane,
    UprightChaplyginBall,
)
from ...solve.samples import Samples
from . import chaplygin, ends, plane, round, witnesses  # noqa: A004  what goes round
from .finding import Finding
from .fits import Seen

__all__ = ["Finding", "findings_of"]


def findings_of(system: RollingSystem, start: State, samples: Samples, form: ClosedForm | None) -> list[dict[str, Any]]:
    """Return predicted and measured numbers of a run."""
    seen = Seen.of(samples)
    found = list(_of_form(system, samples, form, seen)) if seen.time.size > 3 else []
    if not any(one.name == "Friction needed" for one in found):
        found += [*witnesses.friction(system, seen), *witnesses.sliding_friction(system, seen)]
    found += witnesses.integrals(system, start, samples)
    return [one.as_dict() for one in found]


def _of_form(system: RollingSystem, samples: Samples, form: ClosedForm | None, seen: Seen) -> Iterator[Finding]:
    match form:
        case SphereOnPlane():
            yield from plane.on_plane(form, system, seen)
        case SphereInMovingAir():
            yield from plane.in_air(form, seen)
        case SphereOnUnsteadyPlane():
            yield from plane.on_unsteady_plane(form, system, seen)
        case SphereOnFreePlane():
            yield from plane.on_free_plane(form, seen)
        case CylinderOnCylinder():
            yield from round.across_cylinder(form, system, seen, samples)
        case BallInUprightCylinder():
            yield from round.upright(form, seen)
        case BallInLeaningCylinder():
            yield from round.along_cylinder(form, seen)
        case SphereOnSphere():
            yield from round.on_sphere(form, system, seen, samples)
        case ChaplyginBall() | UprightChaplyginBall():
            yield from chaplygin.nodding(form, seen)
        case SlidingSphere():
            yield from ends.gripping(form, system, samples)
        case SphereInFlight():
            yield from ends.landing(form, seen, samples)
        case SphereComingToRest():
            yield from ends.stopping(form, samples)
