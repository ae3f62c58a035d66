"""The closed form's formula in LaTeX, and the same with the current numbers put in."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from ...mechanics.system import RollingSystem
from ...wording import as_ratio

if TYPE_CHECKING:
    from .base import ClosedForm

Lines = list[tuple[str, str]]  # a formula, and the same in numbers

NEWTON_AND_EULER = (r"m\dot V = F + R", r"J\dot\Omega + \Omega\times J\Omega = K + \rho\times R")

_ROLLING_LAW = (
    r"\big[J + m(\rho^2 1 - \rho\rho^{\mathsf T})\big]\,\dot\Omega = K - \Omega\times J\Omega - \rho\times F "
    r"+ m\,\rho\times(\dot u - \Omega\times\dot\rho)"
)


def formula_of(system: RollingSystem, form: ClosedForm | None) -> dict[str, str]:
    r"""Return the formula of a run's motion.

    Examples
    --------
    >>> import trundle as tr
    >>> table = tr.Support(tr.Plane(), motion=tr.Spin(3.5))
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.025, 0.065), table)
    >>> form = tr.solve.exact.closed_form(system, system.place((0.1, 0.0)))
    >>> formula_of(system, form)["numbers_latex"]
    '\\kappa = \\tfrac{2}{7}\\cdot 3.5\\,\\mathrm{rad/s} = 1\\,\\mathrm{rad/s}'
    """
    if form is None:
        return {"name": "The rolling law", "source": "T2", "latex": _ROLLING_LAW, "numbers_latex": body_numbers(system)}
    name = form.name[0].upper() + form.name[1:]
    formulas, numbers = zip(*form.formulas(system), strict=True)
    shown = [line for line in numbers if line]
    return {"name": name, "source": form.equation, "latex": _stacked(formulas), "numbers_latex": _stacked(shown)}


def number(value: Any, digits: int = 4) -> str:
    r"""Write a number in LaTeX.

    Examples
    --------
    >>> number(0.4), number(-1.5e-7), number(12.3456)
    ('\\tfrac{2}{5}', '-1.5\\times 10^{-7}', '12.35')
    """
    ratio = re.fullmatch(r"(-?)(\d+)/(\d+)", as_ratio(float(value)))
    if ratio and value:
        sign, above, below = ratio.groups()
        return rf"{sign}\tfrac{{{above}}}{{{below}}}"
    return decimal(value, digits)


def decimal(value: Any, digits: int = 4) -> str:
    r"""Write a number in LaTeX, never as a fraction.

    Examples
    --------
    >>> decimal(0.4), decimal(-1.5e-7)
    ('0.4', '-1.5\\times 10^{-7}')
    """
    text = f"{float(value) + 0.0:.{digits}g}"
    mantissa, _, power = text.partition("e")
    return rf"{mantissa}\times 10^{{{int(power)}}}" if power else mantissa


def quantity(value: Any, unit: str) -> str:
    r"""Write a number with its unit in LaTeX.

    Examples
    --------
    >>> quantity(0.25, "m/s^2"), quantity(3.0, "deg")
    ('0.25\\,\\mathrm{m/s^2}', '3^\\circ')
    """
    if unit == "deg":
        return rf"{decimal(value)}^\circ"
    return rf"{decimal(value)}\,\mathrm{{{unit}}}"


def _stacked(lines: Any) -> str:
    """Set several formulas under each other, aligned at their first relation."""
    if len(lines) < 2:
        return "".join(lines)
    rows = [re.sub(r"(=|\\ge|\\to)", r"&\1", line, count=1) for line in lines]
    return r"\begin{aligned} " + r" \\ ".join(rows) + r" \end{aligned}"


def body_numbers(system: RollingSystem) -> str:
    """Write the numbers of a system's body, for a law that holds for any."""
    mass = f"m = {quantity(system.body.mass, 'kg')}"
    if not system.body.is_isotropic_sphere:
        return mass
    k, a = system.body.inertia_ratio, system.body.radius
    return rf"{mass},\quad a = {quantity(a, 'm')},\quad J = k m a^2,\; k = {number(k)}"
