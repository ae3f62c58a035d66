"""A scenario file of a ball rolled along a path, from which it can be rolled."""

from __future__ import annotations

from typing import Any

from ...errors import InvalidValueError, ScenarioError
from ...scenario.path_file import ArcPiece, CurvePiece, PathFile, StraightPiece
from .along import roll_along
from .pieces import Arc, Curve, Piece, Straight
from .rolled import RolledPath


class PathScenario(PathFile):
    """A scenario file with [[path]] tables, from which a ball can be rolled along the path.

    Examples
    --------
    >>> import trundle as tr
    >>> rolled = tr.PathScenario.load("roll-x-then-y").run()
    >>> rolled.north_pole.round(9) + 0.0
    array([1., 0., 0.])
    """

    def run(self) -> RolledPath:
        """Roll the ball along the path.

        Returns
        -------
        RolledPath
            With the scenario's title and text.

        Raises
        ------
        ScenarioError
            If a piece does not begin where the one before it ends, or goes nowhere.

        Examples
        --------
        >>> import trundle as tr
        >>> tr.PathScenario.load("roll-home-turned").run().is_closed
        True
        """
        start = None if self.start.position is None else tuple(map(float, self.start.position))
        orientation = tuple(map(float, self.start.orientation))
        pieces = [_piece(piece) for piece in self.path]
        try:
            return roll_along(
                pieces,
                float(self.body.radius),
                start=start,
                orientation=orientation,
                title=self.title,
                scenario=self.to_toml(),
            )
        except InvalidValueError as error:
            raise ScenarioError(error.key, error.rule, error.received, error.remedy) from None


def _piece(piece: StraightPiece | ArcPiece | CurvePiece) -> Piece:
    given = {name: _plain(value) for name, value in piece if name != "kind" and value is not None}
    if isinstance(piece, StraightPiece):
        return Straight(**given)
    return Arc(**given) if isinstance(piece, ArcPiece) else Curve(**given)


def _plain(value: Any) -> Any:
    if isinstance(value, tuple):
        return tuple(_plain(part) for part in value)
    return value if isinstance(value, bool) else float(value)
