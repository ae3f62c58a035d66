"""Complex pairs and the entire functions φ₁, φ₂ that carry linear equations of motion without loss of digits.

Everything is written on (real, imaginary) pairs so that any scalar of `mechanics.scalars` can be used.
"""

from __future__ import annotations

from math import factorial, pi
from typing import Any

from ...mechanics.records import frozen_record
from ...mechanics.scalars import Scalar, is_number, is_zero, less, namespace

# φ₂ = Σ zⁿ/(n + 2)!: below |z| = 1 these terms leave less than 1e-17.
_TERMS = [1 / factorial(n + 2) for n in range(18)]
_TURN, _TURN_REST = 2 * pi, 2.4492935982947064e-16  # 2π as a float, and what that leaves


def _times(a: Scalar, b: Scalar) -> Scalar:
    """Multiply, keeping a known zero: a real or imaginary number stays one, and symbols stay short."""
    return 0.0 if is_zero(a) or is_zero(b) else a * b


def _plus(a: Scalar, b: Scalar) -> Scalar:
    return b if is_zero(a) else a if is_zero(b) else a + b


def _minus(a: Scalar, b: Scalar) -> Scalar:
    return a if is_zero(b) else -b if is_zero(a) else a - b


@frozen_record()
class Complex:
    """A point ζ = x + i y of the support's plane.

    Examples
    --------
    >>> Complex(0.0, 2.0) * Complex(0.0, 3.0)
    Complex(re=-6.0, im=0.0)
    """

    re: Scalar
    im: Scalar

    __array_ufunc__ = None

    def __add__(self, other: Complex) -> Complex:
        return Complex(_plus(self.re, other.re), _plus(self.im, other.im))

    def __sub__(self, other: Complex) -> Complex:
        return Complex(_minus(self.re, other.re), _minus(self.im, other.im))

    def __mul__(self, other: Complex) -> Complex:
        a, b, c, d = self.re, self.im, other.re, other.im
        return Complex(_minus(_times(a, c), _times(b, d)), _plus(_times(a, d), _times(b, c)))

    def scaled(self, factor: Scalar) -> Complex:
        """Return the product with a real factor."""
        return Complex(_times(self.re, factor), _times(self.im, factor))

    def over(self, other: Complex) -> Complex:
        """Return the quotient; a known zero part of the divisor is never squared."""
        if is_zero(other.re):
            return Complex(self.im / other.im, -(self.re / other.im))
        if is_zero(other.im):
            return Complex(self.re / other.re, self.im / other.re)
        product, square = self * Complex(other.re, -other.im), other.re * other.re + other.im * other.im
        return Complex(product.re / square, product.im / square)

    @property
    def times_i(self) -> Complex:
        """The point turned by a right angle, from the first axis towards the second."""
        return Complex(_minus(0.0, self.im), self.re)


def exponentials(x: Scalar, y: Scalar, turned: Scalar | None = None) -> tuple[Complex, Complex, Complex]:
    """Return eᶻ, φ₁(z) = (eᶻ − 1)/z and φ₂(z) = (φ₁(z) − 1)/z for z = x + i y with x ≤ 0.

    Below |z| = 1 a power series serves, so nothing is lost as z → 0; above, 1 − cos y is taken as 2 sin²(y/2)
    and eˣ − 1 from expm1, so nothing is lost where y comes near a full turn. Exact kinds of scalars (SymPy,
    mpmath) use the definitions.

    Examples
    --------
    >>> exponentials(0.0, 0.0)[2]
    Complex(re=0.5, im=0.0)
    """
    if is_zero(x) and is_zero(y):
        return Complex(1.0, 0.0), Complex(1.0, 0.0), Complex(0.5, 0.0)
    xp = namespace(x, y)
    if getattr(xp, "exact", False):
        return _by_definition(xp, x, y)
    size = _plus(_times(x, x), _times(y, y))
    small = less(size, 1.0)
    away = Complex(_choose(xp, small, 1.0, x), _choose(xp, small, 1.0, y))  # keeps 0/0 out of the unused branch

    sine, cosine = _half_angle(xp, y if turned is None else turned)
    growth, shrink = (0.0, 1.0) if is_zero(x) else (xp.expm1(x), xp.exp(x))
    versine = _times(2.0, _times(sine, sine))
    turned = Complex(_minus(1.0, versine), _times(2.0, _times(sine, cosine)))
    exponential = turned.scaled(shrink)
    less_one = Complex(_minus(_times(growth, turned.re), versine), exponential.im)
    phi1_far = less_one.over(away)
    phi2_far = Complex(phi1_far.re - 1.0, phi1_far.im).over(away)

    z = Complex(
        *(0.0 if is_zero(part) else xp.where(small, part, 0.5) for part in (x, y))
    )  # no powers of what is large
    phi2_near = _series(z)
    phi1_near = Complex(1.0, 0.0) + z * phi2_near
    phi1 = Complex(*(_choose(xp, small, a, b) for a, b in _parts(phi1_near, phi1_far)))
    phi2 = Complex(*(_choose(xp, small, a, b) for a, b in _parts(phi2_near, phi2_far)))
    return exponential, phi1, phi2


def _parts(a: Complex, b: Complex) -> list[tuple[Scalar, Scalar]]:
    return [(a.re, b.re), (a.im, b.im)]


def _choose(xp: Any, condition: Any, yes: Scalar, no: Scalar) -> Scalar:
    """Select, but keep a known zero known."""
    return 0.0 if is_zero(no) else xp.where(condition, yes, no)


def _half_angle(xp: Any, y: Scalar) -> tuple[Scalar, Scalar]:
    if is_zero(y):
        return 0.0, 1.0
    half = 0.5 * y
    return xp.sin(half), xp.cos(half)


def _series(z: Complex) -> Complex:
    """Sum φ₂ by its even and odd powers, so that a purely real or imaginary z needs only real products."""
    square: Any = z * z
    terms: list[Any] = [Complex(term, 0.0) for term in _TERMS]
    real = is_zero(square.im)
    if real:
        square, terms = square.re, _TERMS
    even, odd = terms[16], terms[17]
    for n in range(14, -2, -2):
        even, odd = even * square + terms[n], odd * square + terms[n + 1]
    return Complex(even, 0.0) + z * Complex(odd, 0.0) if real else even + z * odd


def _by_definition(xp: Any, x: Scalar, y: Scalar) -> tuple[Complex, Complex, Complex]:
    z, one = Complex(x, y), Complex(1, 0)
    growth = 1 if is_zero(x) else xp.exp(x)
    exponential = Complex(growth * xp.cos(y), growth * xp.sin(y))
    phi1 = (exponential - one).over(z)
    return exponential, phi1, (phi1 - one).over(z)


def quotient_times(factor: Scalar, k: Scalar) -> tuple[Scalar, Scalar]:
    """Return factor·k/(1 + k) as a float and the remainder that the float leaves, about 32 digits together.

    A phase κt keeps its last digit only if κ does. Kinds of scalars without rounding leave no remainder.

    Examples
    --------
    >>> quotient_times(3.0, 0.5)
    (1.0, 0.0)
    """
    if not (_rounds(factor) and _rounds(k)):
        return factor * k / (1 + k), 0.0
    whole = 1.0 + k
    lost = k - (whole - 1.0)
    ratio = k / whole
    product, error = two_product(ratio, whole)
    ratio_rest = (((k - product) - error) - ratio * lost) / whole
    value, rest = two_product(factor, ratio)
    return value, rest + factor * ratio_rest


def phase(rate: tuple[Scalar, Scalar], t: Scalar) -> tuple[Scalar, Scalar]:
    """Return a phase κt, and the same less whole turns: the second has lost nothing even after a million turns.

    Examples
    --------
    >>> phase((1.0, 0.0), 7.0)[1]  # 7 − 2π = 0.716814692820413523...
    0.7168146928204135
    """
    high, low = rate
    if not _rounds(t):
        y = _plus(high * t, _times(low, t))
        return y, y
    product, error = two_product(high, t)
    rest = error + low * t
    turns = namespace(product).round(product / _TURN)
    whole, lost = two_product(turns, _TURN)
    return product + rest, (product - whole) + (rest - lost - turns * _TURN_REST)


def _rounds(value: Scalar) -> bool:
    return is_number(value) or hasattr(value, "__array_namespace__")


def two_product(a: Scalar, b: Scalar) -> tuple[Scalar, Scalar]:
    """Return a·b rounded, and exactly what the rounding lost (Dekker's product; |a|, |b| below 1e290).

    Examples
    --------
    >>> two_product(1 + 2.0**-40, 1 + 2.0**-40)[1] == 2.0**-80
    True
    """
    product = a * b
    (ah, al), (bh, bl) = _split(a), _split(b)
    return product, ((ah * bh - product) + ah * bl + al * bh) + al * bl


def _split(a: Scalar) -> tuple[Scalar, Scalar]:
    c = 134217729.0 * a  # 2^27 + 1
    high = c - (c - a)
    return high, a - high
