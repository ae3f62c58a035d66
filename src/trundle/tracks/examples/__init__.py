"""Measured motion to try things with, made by the project: the truth is known, and so is the noise."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...errors import UnknownNameError

if TYPE_CHECKING:
    from ..track import Track

PREFIX = "example:"
_FOLDER = Path(__file__).parent


@dataclass(frozen=True)
class Example:
    """A measured track that comes with trundle, what moved in it, and what a fit should find.

    Parameters
    ----------
    name : str
        As in ``trundle fit example:ball-on-a-turntable``.
    title : str
        What was filmed.
    about : str
        How, and what is asked, in a few sentences.
    scenario : mapping
        The tables of the scenario that a fit begins with, for `trundle.Scenario.read`.
    free : tuple of str
        The numbers that are asked for.
    noise : str
        The standard deviation of a measured place.
    truth : mapping
        The numbers that the data were made with, by key.

    Examples
    --------
    >>> import trundle as tr
    >>> ramp = tr.tracks.example("ball-on-a-ramp")
    >>> found = tr.fit(ramp.track(), tr.Scenario.read(ramp.scenario), free=ramp.free, noise=ramp.noise)
    >>> print(f"{found['body.inertia_ratio'].value:.2f}")  # of a thin shell 2/3: the ball is hollow
    0.65
    """

    name: str
    title: str
    about: str = field(repr=False)
    scenario: Mapping[str, Any] = field(repr=False)
    free: tuple[str, ...]
    noise: str
    truth: Mapping[str, Any] = field(repr=False)

    @property
    def path(self) -> Path:
        """The file with the track, a CSV."""
        return _FOLDER / f"{self.name}.csv"

    def track(self) -> Track:
        """Read the track.

        Returns
        -------
        Track
            As `trundle.read_track` reads ``"example:NAME"``.

        Examples
        --------
        >>> import trundle as tr
        >>> len(tr.tracks.example("ball-on-a-turntable").track())
        597
        """
        from ..reading import read_track

        return read_track(self.path)


@cache
def example_names() -> tuple[str, ...]:
    """Return the names of the tracks that come with trundle.

    Returns
    -------
    tuple of str
        In the order of the alphabet.

    Examples
    --------
    >>> example_names()
    ('ball-in-a-bowl', 'ball-on-a-ramp', 'ball-on-a-turntable')
    """
    return tuple(sorted(path.stem for path in _FOLDER.glob("*.toml")))


def example(name: str) -> Example:
    """Return a measured track that comes with trundle.

    Parameters
    ----------
    name : str
        One of `example_names`.

    Returns
    -------
    Example
        With its track, the scenario that a fit begins with, and the truth.

    Raises
    ------
    UnknownNameError
        If there is none of this name.

    Examples
    --------
    >>> example("ball-in-a-bowl").free
    ('support.radius', 'loads[0].coefficient')
    """
    if name not in example_names():
        raise UnknownNameError("example of a track", name, example_names())
    tables = tomllib.loads((_FOLDER / f"{name}.toml").read_text(encoding="utf-8"))
    about = " ".join(tables["about"].split())
    return Example(
        name, tables["title"], about, tables["scenario"], tuple(tables["free"]), tables["noise"], tables["truth"]
    )


def example_of(source: object) -> Example | None:
    """Return the example that a source such as "example:ball-on-a-ramp" names; None where it names a file.

    Examples
    --------
    >>> example_of("example:ball-on-a-ramp").title, example_of("ramp.csv")
    ('A ball on a ramp', None)
    """
    told = str(source)
    return example(told.removeprefix(PREFIX)) if told.startswith(PREFIX) else None
