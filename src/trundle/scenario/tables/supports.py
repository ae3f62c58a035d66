"""Tables of supports: a surface, how it leans and moves."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Any, Self

from pydantic import Field, model_validator

from ...errors import InvalidValueError
from ...mechanics.parts import fields_of, kinds_of
from ...mechanics.surfaces import Surface
from ..fields import Measure, Quantity, bare, written
from .motions import MOTIONS, Motions
from .of_parts import PartTable, one_of, table_of
from .values import Friction, Restitution, Table

if TYPE_CHECKING:
    from ...mechanics.system import Support


class OnSurface(PartTable):
    """The keys of every support: each lists its own first and then these."""

    if TYPE_CHECKING:
        kind: str
        tilt: float

    friction: Friction | None = Field(
        default=None, title="Friction coefficient", description="Coulomb coefficient; absent: never slips."
    )
    kinetic_friction: Friction | None = Field(
        default=None,
        title="While it slips",
        description="Coefficient while it slips, at most `friction`; absent: the same.",
    )
    restitution: Restitution = Field(
        default=0.0, description="Of a landing, 0 to 1: e, of which e² of the energy comes back."
    )
    tangential_restitution: Restitution = Field(
        default=0.0,
        title="Restitution of the slip",
        description="Of a landing, 0 to 1: e_t, of which e_t² of what friction took comes back.",
    )
    motion: Motions = Field(default=MOTIONS["fixed"].model_validate({"kind": "fixed"}), title="Motion of the support")

    @classmethod
    def __pydantic_init_subclass__(cls, **_: Any) -> None:
        for key in OnSurface.model_fields:  # pydantic puts what is inherited first
            cls.model_fields[key] = cls.model_fields.pop(key)

    def surface(self) -> Surface:
        """Return the surface, from what the user wrote: whoever refuses it says that again."""
        part: Any = self.part
        if part.points and not _by_formula(self, tuple(part.points)):
            return part.through(*(written(getattr(self, key)) for key in part.points))
        return part(**{name: _as_given(getattr(self, name)) for name in fields_of(part)})

    @model_validator(mode="after")
    def _check(self) -> Self:
        self.surface()  # it knows what its numbers must be to each other
        try:
            self.build()
        except InvalidValueError as error:
            received = written(getattr(self, error.key, error.received))
            raise InvalidValueError(error.key, error.rule, received, error.remedy) from None
        return self

    def build(self) -> Support:
        """Return the support."""
        return self._support

    @cached_property
    def _support(self) -> Support:
        from ...mechanics.system import Support

        return Support(
            self.surface(),
            motion=self.motion.build(),
            tilt=_as_given(self.tilt),
            friction=bare(self.friction),
            kinetic_friction=bare(self.kinetic_friction),
            restitution=bare(self.restitution),
            tangential_restitution=bare(self.tangential_restitution),
        )


def _as_given(value: Any) -> Any:
    """Return a value as the user wrote it, for the message of whoever refuses it."""
    return written(value) if isinstance(value, (Quantity, tuple)) else value


def _by_formula(table: Any, keys: tuple[str, ...]) -> bool:
    """Tell a formula from a table of numbers, and refuse both together, half of one, and neither."""
    given = [key for key in keys if getattr(table, key) is not None]
    names = f"{', '.join(keys[:-1])} and {keys[-1]}"
    if table.formula is not None:
        if given:
            remedy = f"Give the formula, or {names}."
            raise InvalidValueError(given[0], "must not stand beside `formula`", table.formula, remedy)
        return True
    missing = [key for key in keys if key not in given]
    if not given:
        raise InvalidValueError("formula", "must be given", "no formula and no table", f"Or give {names}.")
    if missing:
        raise InvalidValueError(missing[0], f"must be given beside `{given[0]}`", "nothing", "Or give a `formula`.")
    if table.rim is not None:
        remedy = "The surface ends where its table does."
        raise InvalidValueError("rim", "belongs to a surface by a formula", written(table.rim), remedy)
    return False


def _table(part: type[Surface]) -> type[Table]:
    """Return the class of the tables of supports with a surface."""
    lean = (Annotated[float, Measure("angle", example='"3 deg"')], Field(default=0.0, description=part.tilt.said))
    return table_of(part, base=OnSurface, name=f"{part.__name__}Support", instead=part.points, more={"tilt": lean})


SUPPORTS: dict[str, type[Table]] = {kind: _table(part) for kind, part in kinds_of(Surface).items()}
if TYPE_CHECKING:
    Supports = Any
else:
    Supports = one_of(tuple(SUPPORTS.values()))
