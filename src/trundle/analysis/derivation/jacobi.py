"""Jacobi's elliptic functions sn, cn and dn as SymPy functions: their derivatives, and their two identities."""

from __future__ import annotations

from typing import Any

import sympy as sp


class sn(sp.Function):  # noqa: N801  the names of the field
    """The elliptic sine sn(u, m).

    Examples
    --------
    >>> u, m = sp.symbols("u m")
    >>> sn(u, m).diff(u)
    cn(u, m)*dn(u, m)
    """

    nargs = 2

    @classmethod
    def eval(cls, u: Any, m: Any) -> Any:
        """Return 0 at 0; an odd function, the sine for m = 0 and the hyperbolic tangent for m = 1."""
        if u == 0 or m == 0 or m == 1:
            return sp.Integer(0) if u == 0 else sp.sin(u) if m == 0 else sp.tanh(u)
        return -cls(-u, m) if u.could_extract_minus_sign() else None

    def fdiff(self, argindex: int = 1) -> Any:
        """Return cn dn, the derivative by u; the one by m is not needed here."""
        u, m = self.args
        if argindex != 1:
            raise sp.ArgumentIndexError(self, argindex)
        return cn(u, m) * dn(u, m)


class cn(sp.Function):  # noqa: N801
    """The elliptic cosine cn(u, m).

    Examples
    --------
    >>> u, m = sp.symbols("u m")
    >>> cn(u, m).diff(u)
    -dn(u, m)*sn(u, m)
    """

    nargs = 2

    @classmethod
    def eval(cls, u: Any, m: Any) -> Any:
        """Return 1 at 0; an even function, the cosine for m = 0 and the hyperbolic secant for m = 1."""
        if u == 0 or m == 0 or m == 1:
            return sp.Integer(1) if u == 0 else sp.cos(u) if m == 0 else 1 / sp.cosh(u)
        return cls(-u, m) if u.could_extract_minus_sign() else None

    def fdiff(self, argindex: int = 1) -> Any:
        """Return −sn dn."""
        u, m = self.args
        if argindex != 1:
            raise sp.ArgumentIndexError(self, argindex)
        return -sn(u, m) * dn(u, m)


class dn(sp.Function):  # noqa: N801
    """The delta amplitude dn(u, m).

    Examples
    --------
    >>> u, m = sp.symbols("u m")
    >>> dn(u, m).diff(u)
    -m*cn(u, m)*sn(u, m)
    """

    nargs = 2

    @classmethod
    def eval(cls, u: Any, m: Any) -> Any:
        """Return 1 at 0 and for m = 0; an even function, the hyperbolic secant for m = 1."""
        if u == 0 or m == 0 or m == 1:
            return sp.Integer(1) if u == 0 or m == 0 else 1 / sp.cosh(u)
        return cls(-u, m) if u.could_extract_minus_sign() else None

    def fdiff(self, argindex: int = 1) -> Any:
        """Return −m sn cn."""
        u, m = self.args
        if argindex != 1:
            raise sp.ArgumentIndexError(self, argindex)
        return -m * sn(u, m) * cn(u, m)


def squares_of(function: Any) -> list[tuple[Any, Any]]:
    """Return the squares that the identities of a function give: sn² = 1 − cn², dn² = 1 − m + m cn².

    Examples
    --------
    >>> u, m = sp.symbols("u m")
    >>> squares_of(dn(u, m))
    [(dn(u, m), m*cn(u, m)**2 - m + 1)]
    """
    if isinstance(function, sn):
        return [(function, 1 - cn(*function.args) ** 2)]
    if isinstance(function, dn):
        m = function.args[1]
        return [(function, 1 - m + m * cn(*function.args) ** 2)]
    if isinstance(function, sp.sinh):
        return [(function, sp.cosh(function.args[0]) ** 2 - 1)]
    return []
