"""What a part is: any class below the base of its kind, as the classes themselves say it. No list of them is kept."""

from __future__ import annotations

from dataclasses import dataclass

from trundle.mechanics.bodies import Inertia
from trundle.mechanics.loads.base import Load
from trundle.mechanics.motions.base import Motion
from trundle.mechanics.shapes.base import Shape
from trundle.mechanics.surfaces.base import Surface
from trundle.solve.exact.base import ClosedForm


@dataclass(frozen=True)
class Kind:
    """A kind of part: what all of them derive from, and the package in which they may be told apart."""

    name: str
    home: str
    base: type | tuple[type, ...]

    def has(self, thing: object) -> bool:
        """Return whether this is a class of the kind, and not its base."""
        return isinstance(thing, type) and thing is not self.base and issubclass(thing, self.base)


# The kinds of body differ by their inertia, which has no base: the tuple of all of them stands for it.
KINDS = (
    Kind("surface", "trundle.mechanics.surfaces", Surface),
    Kind("shape", "trundle.mechanics.shapes", Shape),
    Kind("body", "trundle.mechanics.bodies", Inertia),
    Kind("motion", "trundle.mechanics.motions", Motion),
    Kind("load", "trundle.mechanics.loads", Load),
    Kind("closed form", "trundle.solve.exact", ClosedForm),
)


def kind_of(thing: object) -> Kind | None:
    """Return the kind of a concrete part; None for a base, and for whatever is no part."""
    return next((kind for kind in KINDS if kind.has(thing)), None)
