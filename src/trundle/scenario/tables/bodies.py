"""Tables of bodies."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

from pydantic import model_validator

from ...errors import InvalidValueError
from ...mechanics.bodies import Body
from ...mechanics.parts import fields_of
from ..fields import written
from ..validation_errors import Nothing
from .of_parts import PartTable, one_of, table_of
from .values import Table


class BodyTable(PartTable):
    """The table of a body: its keys are the words of a builder, which checks them."""

    @model_validator(mode="after")
    def _check(self) -> Any:
        try:
            self.build()
        except InvalidValueError as error:
            received = Nothing() if error.received is None else error.received
            raise InvalidValueError(error.key, error.rule, received, error.remedy) from None
        return self

    def build(self) -> Body:
        """Return the body."""
        return self._body

    @cached_property
    def _body(self) -> Body:
        # In the user's own words, so that the builder's messages show them.
        given = {name: written(getattr(self, name)) for name in fields_of(type(self).part)}
        make: Any = type(self).part
        body: Body = make(**{name: value for name, value in given.items() if value is not None})
        return body


BODIES: dict[str, type[Table]] = {
    kind: table_of(build, base=BodyTable, name=f"{kind.title().replace('-', '')}Body")
    for kind, build in Body.builders().items()
}
if TYPE_CHECKING:
    Bodies = Any
else:
    Bodies = one_of(tuple(BODIES.values()))
