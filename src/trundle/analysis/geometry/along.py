"""The one entry: pieces of path and a ball, checked, become a rolled path."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any

from ...errors import InvalidValueError
from ...mechanics.checks import positive
from .curves import first_place
from .pieces import Curve, Piece, point
from .rolled import RolledPath


def roll_along(
    path: Piece | Iterable[Piece],
    radius: Any,
    *,
    start: Sequence[Any] | None = None,
    orientation: Sequence[float] = (1.0, 0.0, 0.0, 0.0),
    title: str = "",
    scenario: str = "",
) -> RolledPath:
    """Roll a ball along a path on a plane, without slipping and without pivoting.

    Parameters
    ----------
    path : Straight, Arc or Curve, or several
        Each piece begins where the one before it ends; at a corner the ball stops, and starts in the new direction.
    radius : float or quantity
        Of the ball, m.
    start : pair of float or quantity, optional
        Where the contact point begins, m; absent: where a first `Curve` begins, else the origin.
    orientation : sequence of 4 floats
        Quaternion (w, x, y, z) at the beginning, body frame to support frame; it is normalised.
    title, scenario : str
        For figures, card and file.

    Returns
    -------
    RolledPath
        The ball at every stage and at any place of the path.

    Raises
    ------
    InvalidValueError
        If a value is refused, or a `Curve` begins elsewhere than the piece before it ends.

    Examples
    --------
    Round a square whose sides are half turns of the ball, and it comes home as it was:

    >>> import trundle as tr
    >>> side = [tr.Straight(heading=f"{angle} deg", turn="180 deg") for angle in (0, 90, 180, 270)]
    >>> round(tr.roll_along(side, radius="25 mm").rotation.angle, 9)
    0.0
    """
    pieces = (path,) if isinstance(path, Piece) else _pieces(path)
    size = float(positive(radius, "length", "radius"))
    beginning = None if start is None else point(start, "start")
    if beginning is None:
        first = pieces[0]
        beginning = first_place(first) if isinstance(first, Curve) else (0.0, 0.0)
    return RolledPath(pieces, size, beginning, _unit(orientation), title, scenario)


def _pieces(path: Any) -> tuple[Piece, ...]:
    remedy = "Give a Straight, an Arc or a Curve, or several in a list."
    try:
        pieces = tuple(path)
    except TypeError:
        raise InvalidValueError("path", "must be pieces of path", path, remedy) from None
    if not pieces:
        raise InvalidValueError("path", "must have at least one piece", pieces, remedy)
    for i, piece in enumerate(pieces):
        if not isinstance(piece, Piece):
            raise InvalidValueError(f"path[{i}]", "must be a piece of path", piece, remedy)
    return pieces


def _unit(orientation: Any) -> tuple[float, float, float, float]:
    remedy = "Write (1, 0, 0, 0) for a ball that is not turned."
    try:
        w, x, y, z = (float(part) for part in orientation)
    except (TypeError, ValueError):
        raise InvalidValueError("orientation", "must be a quaternion w, x, y, z", orientation, remedy) from None
    size = math.hypot(w, x, y, z)
    if not 1e-150 < size < 1e150:
        raise InvalidValueError("orientation", "must be a quaternion of unit length", orientation, remedy)
    return w / size, x / size, y / size, z / size
