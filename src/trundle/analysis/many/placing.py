"""Many bodies put down in one call."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Any, overload

import numpy as np

from ...display import Displayed, Headline, Markup, pairs
from ...errors import InvalidValueError
from ...mechanics import checks
from ...mechanics.finiteness import check_finite, varies
from ...mechanics.overlap import fits_anywhere
from ...mechanics.placing import VELOCITY_WORDS
from ...mechanics.placing_many import ManyPlacing, Placed
from ...mechanics.system import RollingSystem, State
from ...solve.ensemble import together
from .running import check_structures, listed

# Of the parts of `place` that may be given for each member: how many components, and of which kind.
PARTS: dict[str, tuple[tuple[int, ...], str]] = {
    "position": ((2,), "length"),
    "velocity": ((2, 3), "velocity"),
    "spin": ((), "angular velocity"),
    "angular_velocity": ((3,), "angular velocity"),
    "orientation": ((4,), "number"),
    "attitude": ((3,), "angle"),
    "roll": ((), "angle"),
    "height": ((), "length"),
}


class Starts(Displayed, Sequence[State]):
    """Many starts, as a list of `State` would have them.

    Parameters
    ----------
    states : iterable of State
        One for each member.

    Examples
    --------
    >>> import trundle as tr
    >>> ball = tr.RollingSystem(tr.Body.solid_sphere(0.025, 0.065), tr.Support(tr.Plane()))
    >>> starts = tr.place_many(ball, [[0.1, 0.0], [0.2, 0.0]])
    >>> starts, starts[1].position, starts[::-1][0] == starts[1]
    (<Starts: 2 members>, (0.2, 0.0, 0.025), True)
    """

    def __init__(self, states: Iterable[State]) -> None:
        self._states = tuple(states)

    def __len__(self) -> int:
        return len(self._states)

    @overload
    def __getitem__(self, which: int) -> State: ...

    @overload
    def __getitem__(self, which: slice) -> Starts: ...

    def __getitem__(self, which: int | slice) -> State | Starts:
        return Starts(self._states[which]) if isinstance(which, slice) else self._states[which]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, (Starts, list, tuple)) and self._states == tuple(other)

    __hash__ = None  # type: ignore[assignment]

    def __str__(self) -> str:
        return f"{self._headline().words}: {', '.join(f'{name} {span}' for name, span in self._spans())}"

    def _headline(self) -> Headline:
        return Headline(words=f"{len(self)} members")

    def _parts(self) -> Iterator[Markup]:
        yield pairs(self._spans())

    def _spans(self) -> list[tuple[str, str]]:
        """Return from where to where the starts reach."""
        r, V = (np.array([getattr(each, name) for each in self]) for name in ("position", "velocity"))
        across = [(f"{axis}", column, "m") for axis, column in zip("xyz", r.T, strict=True)]
        rows = [*across, ("|V|", np.linalg.norm(V, axis=1), "m/s")]
        return [(name, f"{column.min():.6g} to {column.max():.6g} {unit}") for name, column, unit in rows]


def place_many(
    systems: RollingSystem | Sequence[RollingSystem],
    position: Any,
    *,
    velocity: Any = None,
    spin: Any = None,
    angular_velocity: Any = None,
    orientation: Any = None,
    attitude: Any = None,
    roll: Any = 0.0,
    height: Any = 0.0,
    time: Any = 0.0,
    support: Any = None,
) -> Starts:
    """Put many bodies down as `RollingSystem.place` does one, twenty times faster.

    Each part is what `place` takes, for all members, or an array of that with one row for each. What `place` would
    refuse is refused, by the first member of which it is true.

    Parameters
    ----------
    systems : RollingSystem or sequence of RollingSystem
        One for all, or one for each member, of the same parts.
    position : array (members, 2) or sequence of 2 floats or quantities
        Of the contact or the centre, as of `place`: lengths in m, angles in rad.
    velocity : array (members, 2 or 3), or for all, "co-rotating" or "rolling", optional
        Along the directions in which the two coordinates grow and along the normal, m/s.
    spin : array (members,), or for all, optional
        Ω·n, rad/s.
    angular_velocity : array (members, 3), or for all, optional
        Ω, support frame, rad/s.
    orientation : array (members, 4), or for all, optional
        Quaternions (w, x, y, z), body frame to support frame.
    attitude : array (members, 3), or for all, optional
        Heading, lean and turn, rad.
    roll : array (members,), or for all
        Of a cylinder, rad.
    height : array (members,), or for all
        Over the support, m.
    time : float or quantity
        The same for all, s.
    support : sequence of floats or quantities, optional
        The coordinates of the support's own motion, the same for all.

    Returns
    -------
    Starts
        A sequence of `State`, one for each member.

    Raises
    ------
    InvalidValueError
        If a member cannot be put down so, with its number; or if there are not as many of one part as of another.

    Examples
    --------
    >>> import numpy as np
    >>> import trundle as tr
    >>> table = tr.RollingSystem(tr.Body.solid_sphere(0.025, 0.065), tr.Support(tr.Plane(), motion=tr.Spin(2.0)))
    >>> places = np.column_stack([np.linspace(0.1, 0.5, 1000), np.zeros(1000)])
    >>> starts = tr.place_many(table, places, velocity="co-rotating")
    >>> len(starts), starts[-1].velocity
    (1000, (0.0, 1.0, 0.0))
    """
    named = {
        "position": position,
        "velocity": velocity,
        "spin": spin,
        "angular_velocity": angular_velocity,
        "orientation": orientation,
    }
    named |= {"attitude": attitude, "roll": roll, "height": height}
    many = [systems] if isinstance(systems, RollingSystem) else listed(systems, "systems", RollingSystem)
    check_structures(many)
    kinds = {name: (kind,) for name, (_, kind) in PARTS.items()} | {"position": many[0].support.surface.coordinates}
    parts = {name: _rows(value, name, PARTS[name][0], kinds[name]) for name, value in named.items()}
    count = _count({"systems": many if len(many) > 1 else None, **parts})
    members = many if len(many) > 1 else many * count
    now, given = checks.real(time, "time", "time") + 0.0, {"time": time, "support": support}
    placed = _together(many, members, parts, count, now, support)

    def alone(member: int) -> State:
        own = {name: value[member] if _is_rows(value) else value for name, value in parts.items()}
        try:
            return members[member].place(**own, **given)
        except InvalidValueError as error:
            name, bracket, rest = error.key.partition("[")
            key = f"{name}[{member}]{bracket}{rest}" if _is_rows(parts.get(name)) else error.key
            raise InvalidValueError(key, error.rule, error.received, error.remedy) from None

    if placed is None:
        return Starts(alone(member) for member in range(count))
    own = tuple(map(float, many[0].support.motion.initial_coordinates() if support is None else support))
    columns = (placed.position, placed.velocity, placed.angular_velocity, placed.orientation)
    rows = zip(*(column.tolist() for column in columns), placed.sound.tolist(), strict=True)
    return Starts(
        State(tuple(r), tuple(V), tuple(Omega), tuple(q), now, own) if sound else alone(member)
        for member, (r, V, Omega, q, sound) in enumerate(rows)
    )


def _together(
    many: list[RollingSystem], members: list[RollingSystem], parts: dict[str, Any], count: int, now: float, support: Any
) -> Placed | None:
    """Put down all members at once; None where these are starts that only `place` knows how to make."""
    system, surface = many[0], many[0].support.surface
    laid = system.body.shape.axis is not None or any(
        np.any(np.asarray(parts[name]) != 0) for name in ("roll", "height")
    )
    twice = any(parts[one] is not None and parts[other] is not None for one, other in _EITHER)
    turned = parts["attitude"] is not None and not (surface.flat and len(many) == 1)
    moved = bool(system.support.motion.coordinates) and (len(many) > 1 or support is not None)
    if laid or twice or turned or moved or not surface.analytic:
        return None
    free = np.array([fits_anywhere(one) for one in many])
    if not free.any() or any(_singular(one, now) for one in (many if varies(system) else many[:1])):
        return None
    try:
        arrays = {name: _for_all(name, value, count) for name, value in parts.items() if name not in ("roll", "height")}
    except InvalidValueError:  # said better by `place`
        return None
    own = tuple(map(float, system.support.motion.initial_coordinates()))
    whole = together(members) if len(many) > 1 else system
    return ManyPlacing(whole, np.broadcast_to(free, count), **arrays, time=now, support=own).starts()


_EITHER = (("spin", "angular_velocity"), ("orientation", "attitude"))


def _singular(system: RollingSystem, now: float) -> bool:
    try:
        check_finite(system, now, now)
    except InvalidValueError:
        return True
    return False


def _for_all(name: str, value: Any, count: int) -> Any:
    """Return a part as an array over members."""
    if value is None or _is_rows(value) or (name == "velocity" and isinstance(value, str) and value in VELOCITY_WORDS):
        return value
    sizes, kind = PARTS[name]
    if not sizes:
        return np.full(count, checks.real(value, kind, name))
    size = len(value) if hasattr(value, "__len__") and len(value) in sizes else sizes[0]
    given = tuple(value) if name == "position" else checks.components(value, kind, name, size)
    return np.broadcast_to(np.array(given, dtype=float), (count, size))


def _is_rows(value: Any) -> bool:
    return isinstance(value, np.ndarray)


def _rows(value: Any, name: str, sizes: tuple[int, ...], kinds: Sequence[str]) -> Any:
    """Return an array, SI, where there is a row for each member; else what is meant for all, as it was given."""
    if value is None or isinstance(value, str):
        return value
    plain = isinstance(value, np.ndarray) and value.dtype.kind in "fiu"
    rows = value if plain else np.array(_listed(value), dtype=object)
    if rows.ndim != 1 + bool(sizes):
        return value
    if sizes and rows.shape[1] not in sizes:
        rule = f"must have {' or '.join(map(str, sizes))} components in each row"
        raise InvalidValueError(name, rule, f"an array of {rows.shape[0]} by {rows.shape[1]}")
    if plain:
        return rows.astype(float)
    known = [
        checks.real(
            part, kinds[index[-1] % len(kinds)] if sizes else kinds[0], f"{name}{''.join(f'[{i}]' for i in index)}"
        )
        for index, part in np.ndenumerate(rows)
    ]
    return np.array(known, dtype=float).reshape(rows.shape)


def _listed(value: Any) -> Any:
    """Return lists of lists, also where quantities hold arrays."""
    parts = isinstance(value, (list, tuple)) or np.ndim(getattr(value, "magnitude", value)) > 0
    return [_listed(part) for part in value] if parts else value


def _count(parts: dict[str, Any]) -> int:
    """Return how many members there are, the same wherever it is said."""
    counts = {name: len(value) for name, value in parts.items() if _is_rows(value) or isinstance(value, list)}
    if not counts:
        return 1
    first, count = next(iter(counts.items()))
    for name, other in counts.items():
        if other != count:
            raise InvalidValueError(name, f"must have as many rows as there are of `{first}`, {count}", other)
    if count == 0:
        raise InvalidValueError(first, "must have at least one member", "none")
    return count
