"""First derivatives of anything that the mechanics works out: dual numbers, which carry their slopes along.

A dual is a value with its slopes in some parameters. The parts may be any scalars: floats, arrays of samples, or steps
on a tape, so that what comes of duals on a tape is the variational equations (Griewank and Walther 2008, chapter 3).
A slope that is 0 stays the number 0 and costs nothing.

Jets differentiate a formula of a surface or a body by its own variables. A jet may hold duals; duals leave arithmetic
with jets to the jets, so that the two kinds of slope are never mixed up.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import fields, is_dataclass
from functools import cache
from typing import Any

from .scalars import Scalar, is_number, is_zero, less, namespace

_STRICT: ContextVar[bool] = ContextVar("strict", default=False)  # whether comparisons must hold beside the value, too


class NoSlopeError(TypeError):
    """Something was asked of a dual that has no slope: a float, or a decision that its slopes would turn."""


class Dual:
    """A value and its slopes in some parameters; comparisons look at the value alone.

    It becomes a float only where it has no slopes: what is decided by a number is decided by `value_of` it.

    Parameters
    ----------
    value : Scalar
        f.
    slopes : tuple of Scalar
        ∂f/∂θ_j.

    Examples
    --------
    >>> x, y = duals((3.0, 2.0))
    >>> (x * x * y).value, (x * x * y).slopes
    (18.0, (12.0, 9.0))
    """

    __slots__ = ("slopes", "value")
    __array_ufunc__ = None  # so that array * Dual asks Dual

    def __init__(self, value: Scalar, slopes: tuple[Scalar, ...]) -> None:
        self.value, self.slopes = value, slopes

    def __repr__(self) -> str:
        return f"Dual({self.value!r}, {self.slopes!r})"

    def through(self, f: Scalar, first: Scalar) -> Dual:
        """Return f of this dual, from f and f′ at its value: the chain rule."""
        return Dual(f, tuple([_times(slope, first) for slope in self.slopes]))

    def __add__(self, other: Any) -> Any:
        if isinstance(other, Dual):
            return Dual(self.value + other.value, tuple(map(_plus, self.slopes, other.slopes)))
        return Dual(self.value + other, self.slopes) if _is_scalar(other) else NotImplemented

    __radd__ = __add__

    def __neg__(self) -> Dual:
        return Dual(-self.value, tuple(0.0 if is_zero(slope) else -slope for slope in self.slopes))

    def __sub__(self, other: Any) -> Any:
        if isinstance(other, Dual):
            return Dual(self.value - other.value, tuple(map(_minus, self.slopes, other.slopes)))
        return Dual(self.value - other, self.slopes) if _is_scalar(other) else NotImplemented

    def __rsub__(self, other: Any) -> Any:
        return Dual(other - self.value, (-self).slopes) if _is_scalar(other) else NotImplemented

    def __mul__(self, other: Any) -> Any:
        if isinstance(other, Dual):
            a, b = self.value, other.value
            pairs = zip(self.slopes, other.slopes, strict=True)
            return Dual(a * b, tuple([_sum(x, b, y, a) for x, y in pairs]))
        return self.through(self.value * other, other) if _is_scalar(other) else NotImplemented

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> Any:
        if isinstance(other, Dual):
            f, b = self.value / other.value, other.value
            pairs = zip(self.slopes, other.slopes, strict=True)
            return Dual(f, tuple(_over(_minus(x, _times(y, f)), b) for x, y in pairs))
        if not _is_scalar(other):
            return NotImplemented
        return Dual(self.value / other, tuple(_over(slope, other) for slope in self.slopes))

    def __rtruediv__(self, other: Any) -> Any:
        if not _is_scalar(other):
            return NotImplemented
        f = other / self.value
        return self.through(f, -f / self.value)

    def __pow__(self, power: int) -> Any:
        if power == 0:
            return 1.0
        x = self.value
        return self if power == 1 else self.through(x**power, power * (x if power == 2 else x ** (power - 1)))

    def __abs__(self) -> Any:
        return DualFunctions.abs(self)

    def __float__(self) -> float:
        if not all(map(is_zero, self.slopes)):
            raise NoSlopeError(
                "A float has no slopes: take `value_of` to decide something by a number, or keep the dual."
            )
        return float(self.value)

    def __format__(self, spec: str) -> str:
        return format(self.value, spec)

    def _compared(self, other: Any) -> Any:
        """Return the value of what it is compared with; strictly, refuse what is equal here and nowhere beside."""
        value = value_of(other)
        if _STRICT.get():
            equal = self.value == value
            if _any(equal) and any(_any(equal & (slope != 0)) for slope in (self - other).slopes):
                raise NoSlopeError("A case of a formula holds for this very number, and for none beside it.")
        return value

    def __bool__(self) -> bool:
        return bool(self.value != self._compared(0.0))

    def __eq__(self, other: Any) -> Any:
        return self.value == self._compared(other)

    def __ne__(self, other: Any) -> Any:
        return self.value != self._compared(other)

    __hash__ = None  # type: ignore[assignment]

    def __lt__(self, other: Any) -> Any:
        return self.value < self._compared(other)

    def __le__(self, other: Any) -> Any:
        return self.value <= self._compared(other)

    def __gt__(self, other: Any) -> Any:
        return self.value > self._compared(other)

    def __ge__(self, other: Any) -> Any:
        return self.value >= self._compared(other)


@contextmanager
def strictly() -> Iterator[None]:
    """Refuse, within, comparisons that hold for the values alone: slopes that follow from them are not those beside.

    Examples
    --------
    >>> (x,) = duals((0.0,))
    >>> x == 0.0
    True
    >>> with strictly():
    ...     x == 0.0
    Traceback (most recent call last):
    trundle.mechanics.duals.NoSlopeError: A case of a formula holds for this very number, and for none beside it.
    """
    token = _STRICT.set(True)
    try:
        yield
    finally:
        _STRICT.reset(token)


class DualFunctions:
    """The functions of `scalars.namespace` for duals, over those of the duals' own parts.

    Examples
    --------
    >>> (x,) = duals((0.0,))
    >>> namespace(x).sin(x).slopes
    (1.0,)
    """

    @staticmethod
    def sqrt(x: Any) -> Any:
        """Return √x; at 0, where it has no slope, that is not a number."""
        return _of(x, "sqrt", lambda _xp, _v, f: float("nan") if is_zero(f) else 0.5 / f)

    @staticmethod
    def sin(x: Any) -> Any:
        """Return sin x."""
        return _of(x, "sin", lambda xp, v, _f: xp.cos(v))

    @staticmethod
    def cos(x: Any) -> Any:
        """Return cos x."""
        return _of(x, "cos", lambda xp, v, _f: -xp.sin(v))

    @staticmethod
    def tan(x: Any) -> Any:
        """Return tan x."""
        return _of(x, "tan", lambda _xp, _v, f: 1.0 + f * f)

    @staticmethod
    def exp(x: Any) -> Any:
        """Return e to the x."""
        return _of(x, "exp", lambda _xp, _v, f: f)

    @staticmethod
    def expm1(x: Any) -> Any:
        """Return e to the x, less 1."""
        return _of(x, "expm1", lambda _xp, _v, f: f + 1.0)

    @staticmethod
    def log(x: Any) -> Any:
        """Return the natural logarithm."""
        return _of(x, "log", lambda _xp, v, _f: 1.0 / v)

    @staticmethod
    def round(x: Any) -> Any:
        """Return the nearest whole number, which has no slope."""
        value = value_of(x)
        return namespace(value).round(value)

    @staticmethod
    def abs(x: Any) -> Any:
        """Return |x|; its slope at 0 is that to the right."""
        return _of(x, "abs", lambda xp, v, _f: xp.where(less(v, x._compared(0.0)), -1.0, 1.0))

    @staticmethod
    def hypot(x: Any, y: Any) -> Any:
        """Return √(x² + y²); at 0, where it has no slope, that is not a number."""
        a, b = value_of(x), value_of(y)
        f = namespace(a, b).hypot(a, b)
        if is_zero(f):
            return Dual(f, tuple(0.0 if is_zero(p) and is_zero(q) else float("nan") for p, q in _pairs(x, y)))
        return Dual(f, tuple(_over(_plus(_times(p, a), _times(q, b)), f) for p, q in _pairs(x, y)))

    @staticmethod
    def atan2(y: Any, x: Any) -> Any:
        """Return the angle of the point (x, y)."""
        b, a = value_of(y), value_of(x)
        square = a * a + b * b
        turns = tuple(_over(_minus(_times(q, a), _times(p, b)), square) for p, q in _pairs(x, y))
        return Dual(namespace(a, b).atan2(b, a), turns)

    @staticmethod
    def where(condition: Any, yes: Any, no: Any) -> Any:
        """Return one of two duals, part by part."""
        if isinstance(condition, bool):
            return yes if condition else no
        a, b = value_of(yes), value_of(no)
        xp = namespace(condition, a, b)
        if not (isinstance(yes, Dual) or isinstance(no, Dual)):
            return xp.where(condition, a, b)
        slopes = (0.0 if is_zero(p) and is_zero(q) else xp.where(condition, p, q) for p, q in _pairs(yes, no))
        return Dual(xp.where(condition, a, b), tuple(slopes))


def duals(values: Sequence[Scalar]) -> tuple[Dual, ...]:
    """Return parameters to compute with: each with slope 1 in itself.

    Examples
    --------
    >>> duals((2.0, 3.0))[1].slopes
    (0.0, 1.0)
    """
    return tuple(Dual(v, tuple(float(i == j) for j in range(len(values)))) for i, v in enumerate(values))


def value_of(x: Any) -> Any:
    """Return the value of a dual, or any other scalar as it is.

    Examples
    --------
    >>> value_of(duals((2.0,))[0]), value_of(3.0)
    (2.0, 3.0)
    """
    return x.value if isinstance(x, Dual) else x


def values_of(thing: Any) -> Any:
    """Return a structure in duals with their values.

    Examples
    --------
    >>> values_of((Dual(1.0, (2.0,)), 3.0))
    (1.0, 3.0)
    """
    return _with(thing, value_of)


def beside(thing: Any, j: int, step: float) -> Any:
    """Return a structure in duals with the values that follow from a step of one parameter, to first order.

    Examples
    --------
    >>> beside((Dual(1.0, (2.0,)), 3.0), 0, 0.5)
    (2.0, 3.0)
    """
    return _with(thing, lambda x: x.value + step * x.slopes[j] if isinstance(x, Dual) else x)


def _with(thing: Any, other: Callable[[Any], Any]) -> Any:
    """Return a structure with other scalars in it."""
    if is_dataclass(thing) and not isinstance(thing, type):
        return type(thing)(**{field.name: _with(getattr(thing, field.name), other) for field in fields(thing)})
    if isinstance(thing, tuple):
        return tuple(_with(part, other) for part in thing)
    return other(thing)


def has_duals(thing: Any) -> bool:
    """Tell whether any number of a structure is a dual.

    Examples
    --------
    >>> has_duals((1.0, 2.0)), has_duals((1.0, Dual(2.0, (1.0,))))
    (False, True)
    """
    kind: Any = type(thing)
    if kind is float:  # most are
        return False
    if isinstance(thing, Dual):
        return True
    if isinstance(thing, tuple):
        return any(map(has_duals, thing))
    return any(has_duals(getattr(thing, name)) for name in _names(kind))


@cache
def _names(kind: type) -> tuple[str, ...]:
    """Return the names of what a structure is made of: none where it is a number, or a class."""
    return tuple(field.name for field in fields(kind)) if is_dataclass(kind) else ()


def converted(x: Any, number: Callable[[Any], Any]) -> Any:
    """Return a scalar of another kind; of a dual its value and its slopes, which may be arrays.

    Examples
    --------
    >>> converted(Dual(1, (2,)), float), converted(3, float)
    (Dual(1.0, (2.0,)), 3.0)
    """
    if isinstance(x, Dual):
        return Dual(number(x.value), tuple(converted(slope, number) for slope in x.slopes))
    if getattr(x, "shape", ()):
        import numpy as np

        return np.array([number(one) for one in x.ravel().tolist()]).reshape(x.shape)
    return number(x)


def slopes_of(x: Any, count: int) -> tuple[Any, ...]:
    """Return the slopes of a dual; of any other scalar none.

    Examples
    --------
    >>> slopes_of(3.0, 2)
    (0.0, 0.0)
    """
    return x.slopes if isinstance(x, Dual) else (0.0,) * count


def stacked(several: Sequence[Any], count: int) -> list[Any]:
    """Return duals as plain scalars: their values, then their slopes by the first parameter, and so on.

    Examples
    --------
    >>> stacked([Dual(1.0, (2.0, 3.0)), 4.0], 2)
    [1.0, 4.0, 2.0, 0.0, 3.0, 0.0]
    """
    slopes = [slopes_of(one, count) for one in several]
    return [*map(value_of, several), *(row[j] for j in range(count) for row in slopes)]


def unstacked(scalars: Sequence[Any], size: int) -> list[Dual]:
    """Return as many duals again.

    Examples
    --------
    >>> unstacked([1.0, 4.0, 2.0, 0.0, 3.0, 0.0], 2)
    [Dual(1.0, (2.0, 3.0)), Dual(4.0, (0.0, 0.0))]
    """
    return [Dual(scalars[i], tuple(scalars[i + size :: size])) for i in range(size)]


def gathered(thing: Any) -> Any:
    """Return a structure whose duals have all their slopes as one, a column: each operation does all of them at once.

    Examples
    --------
    >>> gathered((Dual(1.0, (2.0, 3.0)), 4.0))[0].slopes[0].tolist()
    [[2.0], [3.0]]
    """
    if isinstance(thing, Dual):
        import numpy as np

        return Dual(thing.value, (np.array(thing.slopes, dtype=float)[:, None],))
    if is_dataclass(thing) and not isinstance(thing, type):
        return type(thing)(**{part.name: gathered(getattr(thing, part.name)) for part in fields(thing)})
    return tuple(map(gathered, thing)) if type(thing) is tuple else thing


def _of(x: Any, name: str, slope: Callable[[Any, Any, Any], Any]) -> Any:
    if not isinstance(x, Dual):
        return getattr(namespace(x), name)(x)
    xp = namespace(x.value)
    f = getattr(xp, name)(x.value)
    return x.through(f, slope(xp, x.value, f))


def _any(holds: Any) -> bool:
    """Tell whether something holds of a number, or anywhere in an array."""
    return bool(holds.any()) if hasattr(holds, "any") else bool(holds)


def _pairs(x: Any, y: Any) -> Any:
    count = len((x if isinstance(x, Dual) else y).slopes) if isinstance(x, Dual) or isinstance(y, Dual) else 0
    return zip(slopes_of(x, count), slopes_of(y, count), strict=True)


def _is_scalar(x: Any) -> bool:
    """Tell a scalar from vectors, matrices and jets, which know better what a dual times them is."""
    if is_number(x) or hasattr(x, "__array_namespace__") or hasattr(type(x), "scalar_functions"):
        return True
    return type(x).__module__.partition(".")[0] == "mpmath"


# All that is done with slopes comes by here. Of a float it is seen at once whether it is 0; is_zero asks any other.


def _sum(x: Any, b: Any, y: Any, a: Any) -> Any:
    """Return x b + y a of slopes x and y."""
    if (x == 0.0) if type(x) is float else is_zero(x):
        return _times(y, a)
    if (y == 0.0) if type(y) is float else is_zero(y):
        return x * b
    return x * b + y * a


def _times(slope: Any, factor: Any) -> Any:
    return 0.0 if ((slope == 0.0) if type(slope) is float else is_zero(slope)) else slope * factor


def _over(slope: Any, divisor: Any) -> Any:
    return 0.0 if ((slope == 0.0) if type(slope) is float else is_zero(slope)) else slope / divisor


def _plus(a: Any, b: Any) -> Any:
    if (a == 0.0) if type(a) is float else is_zero(a):
        return b
    return a if ((b == 0.0) if type(b) is float else is_zero(b)) else a + b


def _minus(a: Any, b: Any) -> Any:
    if (b == 0.0) if type(b) is float else is_zero(b):
        return a
    return -b if ((a == 0.0) if type(a) is float else is_zero(a)) else a - b
