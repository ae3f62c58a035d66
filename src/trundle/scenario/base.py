"""What every kind of scenario file shares: title and notes, reading from TOML and writing back."""

from __future__ import annotations

import os
import unicodedata
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, ClassVar, Self

from pydantic import Field, ValidationError, field_validator

from ..display import Displayed, Headline, Markup, paragraph
from ..errors import InvalidValueError, ScenarioError
from . import files
from .layout import layout
from .tables import Table
from .validation_errors import Kinds, complain

_LONGEST_TITLE = 300  # characters; it heads figures


class Document(Displayed, Table):
    """A scenario file of some kind.

    Every number is a float in SI; it remembers the text that it was written as, and `to_toml` writes that.
    """

    kinds: ClassVar[Kinds]  # which class stands for which table, so that an error can list the keys that it has
    rolls_along_path: ClassVar[bool] = False  # whether it has [[path]] tables: they tell the kinds of file apart

    title: str = Field(default="", description="Heads the card and the figures; absent: the name of the file.")
    group: str = Field(default="", description="The heading under which a list of scenarios has it.")
    notes: str = Field(default="", description="What a lecturer says about it; `trundle show` prints it.")

    # --- reading -----------------------------------------------------------------------------------------

    @classmethod
    def load(cls, name_or_path: str | os.PathLike[str]) -> Self:
        """Read a scenario that ships with the package, or a file.

        Parameters
        ----------
        name_or_path : str or path
            One of `names()`, or the path of a TOML file.

        Returns
        -------
        The same class
            The validated scenario.

        Raises
        ------
        ScenarioError
            If there is no such file, or it is not as the format asks.

        Examples
        --------
        >>> import trundle as tr
        >>> tr.Scenario.load("level-turntable-nudged").body.kind
        'solid-sphere'
        """
        return cls.loads(files.read(name_or_path), os.fspath(name_or_path))

    @classmethod
    def loads(cls, text: str, source: str = "scenario") -> Self:
        """Read a scenario from TOML text.

        Parameters
        ----------
        text : str
            The whole file.
        source : str
            Its name, for error messages and, without its suffix, as the title of a scenario that has none.

        Returns
        -------
        The same class
            The validated scenario.

        Raises
        ------
        ScenarioError
            If the text is not as the format asks.

        Examples
        --------
        >>> import trundle as tr
        >>> text = tr.Scenario.load("ball-under-force").to_toml()
        >>> tr.Scenario.loads(text).title
        'Ball on a level plane under a constant force'
        """
        return cls.read(files.parse(text, source), source)

    @classmethod
    def read(cls, data: Mapping[str, Any], source: str = "scenario") -> Self:
        """Read a scenario from nested dictionaries, as a TOML file holds them.

        Parameters
        ----------
        data : mapping
            The tables of the file.
        source : str
            As for `loads`.

        Returns
        -------
        The same class
            The validated scenario.

        Raises
        ------
        ScenarioError
            If the data are not as the format asks.

        Examples
        --------
        >>> import trundle as tr
        >>> scenario = tr.Scenario.read(
        ...     {
        ...         "body": {"kind": "solid-sphere", "radius": "25 mm", "mass": "65 g"},
        ...         "support": {"kind": "plane"},
        ...         "start": {"position": [0, 0], "velocity": ["0.1 m/s", 0]},
        ...         "run": {"duration": "1 s", "every": "10 ms"},
        ...     }
        ... )
        >>> scenario.start_state().angular_velocity
        (0.0, 4.0, 0.0)
        """
        files.Bounds().check(data, source)
        if files.rolls_along_path(data) and not cls.rolls_along_path:
            remedy = "A ball rolled along a path feels no forces; in Python load it with `tr.PathScenario`."
            raise ScenarioError(
                "scenario", "must have a body that forces act on", "a path to roll along", remedy, source
            )
        try:
            return cls.model_validate({"title": _title_from(source), **data})
        except ValidationError as error:
            raise complain(error, cls, source) from None
        except RecursionError:
            raise ScenarioError("scenario", "must not nest this deep", "tables within tables", "", source) from None

    @classmethod
    def names(cls) -> list[str]:
        """Return the names of the scenarios of this kind that ship with the package.

        Returns
        -------
        list of str
            In alphabetical order.

        Examples
        --------
        >>> import trundle as tr
        >>> tr.Scenario.names()[0]
        'ball-in-a-funnel'
        """
        return [name for name in files.names() if files.is_shipped_path(name) == cls.rolls_along_path]

    @field_validator("title", "group", "notes")
    @classmethod
    def _printable(cls, text: str, info: Any) -> str:
        allowed = "\n\t" if info.field_name == "notes" else ""
        if not allowed and len(text) > _LONGEST_TITLE:
            raise InvalidValueError(
                "", f"must have at most {_LONGEST_TITLE} characters", text, "Put the rest into `notes`."
            )
        if any(unicodedata.category(letter) in ("Cc", "Cs") and letter not in allowed for letter in text):
            lines = "" if allowed else " on one line"
            raise InvalidValueError("", f"must be text{lines} without control characters", text, "Leave them out.")
        return text

    # --- showing -----------------------------------------------------------------------------------------

    def __str__(self) -> str:
        return self.to_toml().rstrip("\n")

    def _headline(self) -> Headline:
        return Headline(self.title)

    def _parts(self) -> Iterator[Markup]:
        from .shown import shown

        yield paragraph(" ".join(self.notes.split("\n")).strip())
        yield shown(self, self._kinds_of_components())

    def _kinds_of_components(self) -> dict[str, tuple[str, ...]]:
        """Return what the components of a key are where another key says so: each a length or an angle."""
        return {}

    # --- writing -----------------------------------------------------------------------------------------

    def to_toml(self) -> str:
        """Write the scenario as TOML: the keys that were given, as they were given.

        Returns
        -------
        str
            TOML that `loads` reads back to an equal scenario.

        Examples
        --------
        >>> import trundle as tr
        >>> text = tr.Scenario.load("tilted-turntable").to_toml()
        >>> text[text.index("rate =") :].splitlines()[0]
        'rate = "33.3 rpm"'
        """
        return layout(self.model_dump(exclude_unset=True, exclude_none=True, by_alias=True))


def _title_from(source: str) -> str:
    stem = Path(source).name.removesuffix(".toml")
    return "".join(letter for letter in stem if unicodedata.category(letter) not in ("Cc", "Cs"))
