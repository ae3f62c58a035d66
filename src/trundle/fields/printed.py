"""What is printed in the language of a backend: functions whose parameters and outputs have names and units."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from ..display import Displayed, Headline, Markup, markup
from ..errors import InvalidValueError, UnknownNameError
from ..mechanics.parameters import numbers, parameters
from ..mechanics.system import State
from ..units import UNITS
from .backends import BACKENDS, Backend
from .printers import c
from .routines import Routine

Listed = tuple[str, Sequence[str], Sequence[str], Any]  # a title, names, units, and values where there are any


class Printed(Displayed):
    """Functions in the language of a backend, with the names and units of what they take."""

    backend: str
    _outputs: tuple[tuple[str, str], ...]  # names and units

    @property
    def _numbered(self) -> Any:
        """What has the numbers that are the parameters."""
        raise NotImplementedError

    @property
    def _title(self) -> str:
        """What it is, in a few words."""
        raise NotImplementedError

    def _listed(self, start: State | None = None) -> Iterator[Listed]:
        """List what the functions take and return; the state with the values of a start, if one is given."""
        raise NotImplementedError

    def _check_backend(self) -> None:
        if self.backend not in BACKENDS:
            raise UnknownNameError("backend", str(self.backend), BACKENDS)

    @property
    def _language(self) -> Backend:
        return BACKENDS[self.backend]

    @property
    def parameter_names(self) -> tuple[str, ...]:
        """The names of the numbers of p."""
        return tuple(name for name, _ in parameters(self._numbered))

    @property
    def parameter_units(self) -> tuple[str, ...]:
        """Their units; numbers in a formula are in SI, and have none here."""
        return tuple(UNITS[dimension][0] for _, dimension in parameters(self._numbered))

    @property
    def parameters(self) -> Any:
        """P as it is, an array."""
        return np.array(numbers(self._numbered))

    @property
    def output_names(self) -> tuple[str, ...]:
        """The names of the outputs."""
        return tuple(name for name, _ in self._outputs)

    @property
    def output_units(self) -> tuple[str, ...]:
        """Their units."""
        return tuple(unit for _, unit in self._outputs)

    def routines(self) -> list[Routine]:
        """Return the functions as they are printed.

        Returns
        -------
        list of Routine
            In the order of the text.
        """
        raise NotImplementedError

    def source(self, name: str = "field", start: State | None = None) -> str:
        """Return the text of all functions, with what their arguments are.

        Parameters
        ----------
        name : str
            With which the functions of C begin: letters, digits and underscores.
        start : State, optional
            Its numbers are told with their names.

        Returns
        -------
        str
            A module of Python, of JAX or of JavaScript, or a file of C.

        Examples
        --------
        >>> import trundle as tr
        >>> level = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()))
        >>> "void ball_rolling_rates(" in level.vector_field("c").source("ball")
        True
        """
        if not name.isidentifier() or not name.isascii():
            raise InvalidValueError("name", "must consist of letters, digits and underscores", name)
        return self._language.source(self.routines(), name, self._said(start))

    def header(self, name: str = "field") -> str:
        """Return the header that declares the functions of C.

        Parameters
        ----------
        name : str
            As of `source`.

        Returns
        -------
        str
            C.

        Examples
        --------
        >>> import trundle as tr
        >>> level = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()))
        >>> "#ifndef BALL_H" in level.vector_field("c").header("ball")
        True
        """
        return c.header(self.routines(), name, self._said())

    def _said(self, start: State | None = None) -> str:
        """Say in plain text what the functions take."""
        lines = [f"{self._title}, as trundle wrote it. All numbers are in SI.", "", "t: time (s)"]
        for title, names, units, values in self._listed(start):
            lines += [f"{title}:"] * (len(names) > 0)
            values = [None] * len(names) if values is None else values.tolist()
            for i, (name, unit, value) in enumerate(zip(names, units, values, strict=True)):
                told = "" if value is None else f" = {value!r}"
                lines.append(f"    [{i}] {name}{f' ({unit})' if unit else ''}{told}")
        return "\n".join(lines)

    def __str__(self) -> str:
        return self._said()

    def _headline(self) -> Headline:
        return Headline(self._title, f"for {self.backend}")

    def _parts(self) -> Iterator[Markup]:
        for title, names, units, values in self._listed():
            values = [None] * len(names) if values is None else values.tolist()
            rows = [
                (str(i), name, unit, "" if value is None else repr(value))
                for i, (name, unit, value) in enumerate(zip(names, units, values, strict=True))
            ]
            yield markup.fold(title, markup.table(rows, ["", "name", "unit", "value"], numbers=[3]))
