"""The closed form's formula in LaTeX, and the same with the current numbers put in."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from typing import Any

from trundle.wording import as_ratio

from ..mechanics.system import RollingSystem
from ..solve.exact import (
    BallInLeaningCylinder,
    BallInUprightCylinder,
    ChaplyginBall,
    ClosedForm,
    CylinderOnCylinder,
    OffADome,
    SlidingSphere,
    SphereComingToRest,
    SphereInFlight,
    SphereInMovingAir,
    SphereOnFreePlane,
    SphereOnPlane,
    SphereOnSphere,
    SphereOnUnsteadyPlane,
    UprightChaplyginBall,
)

Lines = list[tuple[str, str]]  # a formula, and the same in numbers

_LAW = (
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
    write = _FORMULAS.get(type(form)) if form is not None else None
    lines = write(form, system) if write is not None else []
    if form is None or not lines:
        return {"name": "The rolling law", "source": "T2", "latex": _LAW, "numbers_latex": _body(system)}
    name = form.name[0].upper() + form.name[1:]
    formulas, numbers = zip(*lines, strict=True)
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


def _body(system: RollingSystem) -> str:
    mass = f"m = {quantity(system.body.mass, 'kg')}"
    if not system.body.is_isotropic_sphere:
        return mass
    k, a = system.body.inertia_ratio, system.body.radius
    return rf"{mass},\quad a = {quantity(a, 'm')},\quad J = k m a^2,\; k = {number(k)}"


def _share(form: Any) -> float:
    return float(form.inertia_ratio) / (1 + float(form.inertia_ratio))


def _sphere_on_plane(form: SphereOnPlane, system: RollingSystem) -> Lines:
    if form.has_guiding_centre:
        return _circle(form, system)
    k, push, lines = float(form.inertia_ratio), complex(form.phi.re, form.phi.im), []
    if form.drag:
        turning = r"\ddot\zeta = (i\kappa - \gamma)\,\dot\zeta + \varphi,\quad \kappa = \frac{k}{1+k}\,\omega"
        if form.kappa:
            lines.append((turning, rf"\kappa = {quantity(form.kappa, 'rad/s')}"))
        else:
            lines.append(
                (r"\dot V = \varphi - \gamma V", rf"|\varphi| = {quantity(abs(push), 'm/s^2')}" if push else "")
            )
        heavy = rf"{decimal(form.mass)}\cdot(1 + {number(k)})"
        found = (
            rf"\gamma = \frac{{{decimal(form.drag)}}}{{{heavy}}}\,\mathrm{{s^{{-1}}}} = {quantity(form.gamma, '1/s')}"
        )
        lines.append((r"\gamma = \frac{c}{m(1+k)}", found))
        if push:
            speed = abs(push / complex(-float(form.gamma), float(form.kappa)))
            formula = r"|V| \to |\varphi/(i\kappa - \gamma)|" if form.kappa else r"|V| \to |\varphi|/\gamma"
            lines.append((formula, rf"|V| \to {quantity(speed, 'm/s')}"))
        return lines
    if not push:
        speed = math.hypot(*map(float, form.velocity))
        return [(r"\zeta = \zeta_0 + \dot\zeta_0\,t", rf"|\dot\zeta_0| = {quantity(speed, 'm/s')}")]
    if system.loads:
        formula = r"\dot V = \frac{F + K\times n/a}{m(1+k)}"
        heavy = rf"{decimal(form.mass)}\,\mathrm{{kg}}\cdot(1 + {number(k)})"
        force = abs(push) * float(form.mass) * (1 + k)
        return [(formula, rf"|\dot V| = \frac{{{quantity(force, 'N')}}}{{{heavy}}} = {quantity(abs(push), 'm/s^2')}")]
    tilt = abs(math.degrees(float(system.support.tilt)))
    numbers = (
        rf"\dot v = \frac{{{quantity(system.gravity, 'm/s^2')}\cdot\sin {quantity(tilt, 'deg')}}}{{1 + {number(k)}}} "
        rf"= {quantity(abs(push), 'm/s^2')}"
    )
    return [(r"\dot v = \frac{g\sin\alpha}{1+k}", numbers)]


def _circle(form: SphereOnPlane, system: RollingSystem) -> Lines:
    rate, kappa, radius = float(form.rate), float(form.kappa), float(form.circle_radius)
    drift = complex(*(float(part) for part in form.drift_velocity))
    numbers = rf"\kappa = {number(_share(form))}\cdot {quantity(rate, 'rad/s')} = {quantity(kappa, 'rad/s')}"
    lines = [(r"\kappa = \frac{k}{1+k}\,\omega", numbers)]
    if drift:
        shown = rf"v_d = {quantity(abs(drift), 'm/s')}"
        if not system.loads:
            k, tilt = float(form.inertia_ratio), math.degrees(float(system.support.tilt))
            above = rf"{quantity(system.gravity, 'm/s^2')}\cdot\sin {quantity(tilt, 'deg')}"
            below = rf"{number(k)}\cdot {quantity(rate, 'rad/s')}"
            signed = math.copysign(abs(drift), drift.imag)
            lines.append(
                (
                    r"v_d = \frac{g\sin\alpha}{k\,\omega}",
                    rf"v_d = \frac{{{above}}}{{{below}}} = {quantity(signed, 'm/s')}",
                )
            )
        else:
            lines.append((r"v_d = \frac{i\varphi}{\kappa}", f"|{shown.replace(' =', '| =', 1)}"))
    if radius:
        speed = radius * abs(kappa)
        above = r"|\dot\zeta_0 - v_d|" if drift else r"|\dot\zeta_0|"
        shown = (
            rf"\varrho = \frac{{{quantity(speed, 'm/s')}}}{{{quantity(abs(kappa), 'rad/s')}}} = {quantity(radius, 'm')}"
        )
        lines.append((rf"\varrho = \frac{{{above}}}{{|\kappa|}}", shown))
    return lines


def _moving_air(form: SphereInMovingAir, system: RollingSystem) -> Lines:
    del system
    formula = r"\ddot\zeta = (i\kappa - \gamma)\,\dot\zeta + i\beta\,\zeta + \varphi"
    parts = (("\\kappa", form.kappa, "rad/s"), (r"\gamma", form.gamma, "1/s"), (r"\beta", form.beta, "1/s^2"))
    return [(formula, r",\quad ".join(f"{name} = {quantity(value, unit)}" for name, value, unit in parts))]


def _unsteady_plane(form: SphereOnUnsteadyPlane, system: RollingSystem) -> Lines:
    shown = rf"\kappa(t) = {number(_share(form))}\,\omega(t)"
    if system.loads or float(system.support.tilt):
        return [(r"\frac{d}{dt}\big[\dot\zeta - (i\kappa - \gamma)\,\zeta\big] = \varphi(t)", shown)]
    return [(r"\dot\zeta - i\kappa(t)\,\zeta = M,\quad \kappa = \frac{k}{1+k}\,\omega(t)", shown)]


def _free_plane(form: SphereOnFreePlane, system: RollingSystem) -> Lines:
    del system
    formula = r"L = I_t\,\omega + m\,\mathrm{Im}(\bar\zeta\dot\zeta)"
    momentum = quantity(form.angular_momentum, r"kg\,m^2/s")
    lines = [(formula, f"L = {momentum}")]
    drive = math.hypot(*map(float, form.drive))
    lines.append((r"M = \dot\zeta - i\frac{k}{1+k}\,\omega\,\zeta", rf"|M| = {quantity(drive, 'm/s')}"))
    return lines


def _pendulum(form: CylinderOnCylinder, system: RollingSystem) -> Lines:
    del system
    pull, heavy = math.hypot(*map(float, form.force)), float(form.mass) * (1 + float(form.inertia_ratio))
    square = pull / (heavy * float(form.length))
    below = rf"{decimal(form.mass)}\cdot(1 + {number(form.inertia_ratio)})\cdot {decimal(form.length)}"
    shown = rf"\nu^2 = \frac{{{decimal(pull)}}}{{{below}}}\,\mathrm{{s^{{-2}}}} = {quantity(square, '1/s^2')}"
    lines = [(r"\ddot\theta = -\nu^2\sin\theta,\quad \nu^2 = \frac{G}{m(1+k)\,\ell}", shown)]
    period = float(form.period)
    if math.isfinite(period):
        whole = r"T = \frac{2}{\sqrt\epsilon}\,K\!\left(\frac{\nu^2}{\epsilon}\right)"
        swings = r"T = \frac{4}{\nu}\,K\!\left(\sin^2\tfrac{\theta_{\max}}{2}\right)"
        lines.append((whole if form.goes_round else swings, rf"T = {quantity(period, 's')}"))
    return lines


def _along(form: BallInLeaningCylinder, system: RollingSystem) -> Lines:
    q = math.sqrt(_share(form))
    formula = r"\dot z - iq\sigma = W_0\,e^{iq(\theta - \theta_0)} + \dots,\quad q = \sqrt{\frac{k}{1+k}}"
    return [*_pendulum(form.pendulum, system), (formula, f"q = {decimal(q)}")]


def _upright(form: BallInUprightCylinder, system: RollingSystem) -> Lines:
    del system
    root = rf"\sqrt{{{number(_share(form))}}}"
    shown = rf"\nu = {root}\cdot {quantity(form.angular_rate, 'rad/s')} = {quantity(form.bobbing_rate, 'rad/s')}"
    return [(r"\nu = \sqrt{\frac{k}{1+k}}\;\dot\theta", shown)]


def _sphere(form: SphereOnSphere, system: RollingSystem) -> Lines:
    if form.side < 0:
        return _pendulum(form.pendulum, system)
    if system.support.friction is not None:
        return _slipping_dome(form, float(system.support.friction))
    cosine = float(form.lift_cosine)
    formula = r"\cos\theta_l = \frac{2\cos\theta_0 + (1+k)\,\ell\dot\theta_0^2/g}{3+k}"
    angle = rf",\quad \theta_l = {quantity(math.degrees(math.acos(cosine)), 'deg')}" if abs(cosine) <= 1 else ""
    return [(formula, rf"\cos\theta_l = {decimal(cosine)}{angle}")]


def _slipping_dome(form: SphereOnSphere, friction: float) -> Lines:
    k, above = float(form.inertia_ratio), -math.cos(float(form.angle))
    speed = float(form.mass) * float(form.length) * float(form.angular_rate) ** 2 / float(form.pull)
    slips = OffADome(k, friction, speed - 2 * (1 - above) / (1 + k)).slips_at
    formula = r"(3+k)\,\mu\cos\theta_s - k\sin\theta_s = \mu\,\big[2\cos\theta_0 + (1+k)\,\ell\dot\theta_0^2/g\big]"
    return [(formula, rf"\mu = {decimal(friction)},\quad \theta_s = {quantity(math.degrees(slips), 'deg')}")]


def _sliding(form: SlidingSphere, system: RollingSystem) -> Lines:
    k, mu = float(form.inertia_ratio), float(form.friction)
    brake = mu * -float(form.force[2]) / float(form.mass) * (1 + 1 / k)
    lines = [
        (
            r"\dot s = \frac{F}{m} - B\,\hat s,\quad B = \frac{\mu N}{m}\Big(1 + \frac1k\Big)",
            rf"B = {quantity(brake, 'm/s^2')}",
        )
    ]
    grips = float(form.grips_at)
    if not math.isfinite(grips):
        return lines
    slip = math.hypot(*map(float, form.slip))
    level = not (float(form.force[0]) or float(form.force[1]))
    if not level:
        return [*lines, (r"s(t_g) = 0", rf"t_g = {quantity(grips, 's')}")]
    del system
    shown = rf"t_g = \frac{{{quantity(slip, 'm/s')}}}{{{quantity(brake, 'm/s^2')}}} = {quantity(grips, 's')}"
    return [*lines, (r"t_g = \frac{|s_0|}{B}", shown)]


def _flight(form: SphereInFlight, system: RollingSystem) -> Lines:
    del system
    lands = float(form.ends_at.get("land", math.inf))
    shown = rf"t_l = {quantity(lands, 's')}" if math.isfinite(lands) else ""
    return [(r"r = r_0 + V_0\,t + \frac{F}{2m}\,t^2", shown)]


def _stopping(form: SphereComingToRest, system: RollingSystem) -> Lines:
    del system
    parts = (("r", form.deceleration, "m/s^2"), (r"\gamma", form.gamma, "1/s"), (r"\eta", form.eta, "1/m"))
    shown = r",\quad ".join(f"{name} = {quantity(value, unit)}" for name, value, unit in parts if float(value))
    lines = [(r"\dot v = -(r + \gamma v + \eta v^2)", shown)]
    if math.isfinite(float(form.stops_at)):
        lines.append((r"v(t_s) = 0", rf"t_s = {quantity(form.stops_at, 's')}"))
    return lines


def _chaplygin(form: ChaplyginBall, system: RollingSystem) -> Lines:
    del system
    momentum = quantity(form.momentum.norm(), r"kg\,m^2/s")
    return [(r"M = J\Omega + m a^2\,n\times(\Omega\times n)", f"|M| = {momentum}")]


def _chaplygin_upright(form: UprightChaplyginBall, system: RollingSystem) -> Lines:
    del system
    momentum = quantity(form.momentum, r"kg\,m^2/s")
    return [(r"(J + m a^2)\,\Omega = L\,n", f"L = {momentum}")]


_FORMULAS: dict[type, Callable[[Any, RollingSystem], Lines]] = {
    SphereOnPlane: _sphere_on_plane,
    SphereInMovingAir: _moving_air,
    SphereOnUnsteadyPlane: _unsteady_plane,
    SphereOnFreePlane: _free_plane,
    CylinderOnCylinder: _pendulum,
    BallInLeaningCylinder: _along,
    BallInUprightCylinder: _upright,
    SphereOnSphere: _sphere,
    SlidingSphere: _sliding,
    SphereInFlight: _flight,
    SphereComingToRest: _stopping,
    ChaplyginBall: _chaplygin,
    UprightChaplyginBall: _chaplygin_upright,
}
