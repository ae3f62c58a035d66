"""The correspondence as a table: each quantity of the ball beside the one of the charge that it is."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, Any

from trundle.wording import short, with_unit

from ...display import Markup, joined, mathml, pairs, table

if TYPE_CHECKING:
    from .correspondence import Twin

HEADS = ("", "ball", "", "charge", "")
Row = tuple[str, str, str, str, str]  # what it is, of the ball, its value, of the charge, its value


def rows(pair: Twin) -> list[Row]:
    """Return the rows; values of the charge that depend on time are in the time of the ball.

    Examples
    --------
    >>> import trundle as tr
    >>> rows(tr.twin(tr.Scenario.load("tilted-turntable")))[1][2:]
    ('0.996334 rad/s', '−QB/M', '0.996334 rad/s')
    """
    ball, charge, pace = pair.ball, pair.particle, pair.slow_motion
    push = math.hypot(ball.phi.re, ball.phi.im)
    E = math.hypot(*charge.electric_field)
    told: list[Row] = [
        ("mass", "m", f"{ball.mass:.6g} kg", "M", f"{charge.mass:.6g} kg"),
        (
            "rate of turning",
            "κ = ω k/(1 + k)",
            f"{ball.kappa:.6g} rad/s",
            "−QB/M",
            f"{charge.gyration_rate / pace + 0.0:.6g} rad/s",
        ),
        ("push", "|φ|", f"{push:.6g} m/s²", "|QE|/M", f"{abs(charge.charge) * E / charge.mass / pace**2:.6g} m/s²"),
    ]
    if ball.gamma:
        told.append(
            ("slowing", "γ", f"{ball.gamma:.6g} 1/s", "C/M", f"{charge.resistance / charge.mass / pace:.6g} 1/s")
        )
    if ball.kappa:
        period = 2 * math.pi / abs(ball.kappa)
        told.append(("one turn", "2π/|κ|", f"{period:.6g} s", "2πM/|QB|", f"{charge.period * pace:.6g} s"))
    if ball.has_guiding_centre:
        told += [
            (
                "radius",
                "|V − v|/|κ|",
                f"{ball.circle_radius:.6g} m",
                "M|v − v_d|/|QB|",
                f"{charge.larmor_radius:.6g} m",
            ),
            (
                "drift",
                "−φ/(iκ)",
                _pair(ball.drift_velocity, "m/s"),
                "E×B/B²",
                _pair(tuple(c / pace for c in charge.drift_velocity), "m/s"),
            ),
        ]
    return told


def settings(pair: Twin) -> list[tuple[str, str]]:
    """Return what to set on either side.

    Examples
    --------
    >>> import trundle as tr
    >>> settings(tr.twin(tr.Scenario.load("tilted-turntable")))[2]
    ('magnetic field B', '−0.50813 T along n, into the table')
    """
    charge = pair.particle
    b, (ex, ey) = charge.magnetic_field, charge.electric_field
    way = "out of the table" if b > 0 else "into the table"
    told = [
        ("table", f"{_turning(pair)}, tilt {short(math.degrees(pair.tilt), 6)}°"),
        ("charge Q", f"{short(charge.charge, 6)} C"),
        ("magnetic field B", f"{short(b, 6)} T along n, {way}" if b else "0: the plane does not turn"),
        ("electric field E", f"{_pair((ex, ey), 'V/m')}{_against(pair)}" if ex or ey else "0: nothing pushes"),
    ]
    if charge.resistance:
        told.append(("resistance C", f"{short(charge.resistance, 6)} kg/s"))
    if pair.slow_motion != 1.0:
        told.append(("slow motion", f"1 s of the ball is {with_unit(1 / pair.slow_motion, 'time', 6)} of the charge"))
    return told


def report(pair: Twin) -> str:
    """Write out the correspondence and how far the two paths are apart, as the command prints them."""
    head = [pair.title, ""] if pair.title else []
    return "\n".join([*head, *_columns([HEADS, *rows(pair)]), "", *_columns(settings(pair)), "", agreement(pair)])


def agreement(pair: Twin) -> str:
    """Say how far the two paths are apart, and how much of that rounding may do."""
    duration = pair.shown_duration
    apart, allowed = pair.largest_difference(duration), pair.rounding(duration)
    return (
        f"Over {duration:g} s the two paths, each by its own formulas, are at most {apart:.2g} m apart; "
        f"rounding may make {allowed:.2g} m."
    )


def shown(pair: Twin) -> Markup:
    """Return the correspondence and the settings as tables for a notebook."""
    told = [(name, _formula(ball), value, _formula(charge), its) for name, ball, value, charge, its in rows(pair)]
    return joined([table(told, HEADS), pairs(settings(pair))])


def _formula(text: str) -> Markup:
    """Return the formula of a row as MathML: it is LaTeX but for its bars, which have to be told left from right."""
    return mathml(re.sub(r"\|([^|]*)\|", r"\\left|\1\\right|", text))


def _columns(lines: list[Any]) -> list[str]:
    widths = [max(len(line[i]) for line in lines) for i in range(len(lines[0]))]
    return ["  ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)).rstrip() for line in lines]


def _turning(pair: Twin) -> str:
    rate = float(pair.ball.rate)
    return f"turns at {short(rate, 6)} rad/s" if rate else "at rest"


def _against(pair: Twin) -> str:
    """Say where E points on the slope."""
    ex, ey = pair.particle.electric_field
    if not pair.tilt or abs(ey) > 1e-12 * abs(ex):
        return ""
    return ", down the slope" if ex * pair.tilt > 0 else ", up the slope"


def _pair(values: tuple[float, ...], unit: str) -> str:
    size = max(abs(value) for value in values)
    shown = [short(0.0 if abs(value) < 1e-12 * size else value, 6) for value in values]
    return f"({shown[0]}, {shown[1]}) {unit}"
