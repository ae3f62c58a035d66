"""Findings of a sphere on a plane: circles, drift, acceleration, spirals, a free table."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from ...mechanics.system import RollingSystem
from ...solve.exact import SphereInMovingAir, SphereOnFreePlane, SphereOnPlane, SphereOnUnsteadyPlane
from ...wording import as_ratio
from .finding import Finding
from .fits import Seen, acceleration, circle, exponent, round_time, two_exponents

_STILL = 1e-12  # share of the table's speed below which a ball that was put down gently has not moved
_LITTLE = "the run shows too little of it to measure"


def on_plane(form: SphereOnPlane, system: RollingSystem, seen: Seen) -> Iterator[Finding]:
    """Compare a sphere on a plane with T5."""
    if form.has_guiding_centre:
        yield from _circling(form, system, seen)
    elif form.drag:
        yield from _braked(form, seen)
    else:
        yield from _pushed(form, system, seen)
    if not form.drag:
        yield from _friction(form, seen)


def _circling(form: SphereOnPlane, system: RollingSystem, seen: Seen) -> Iterator[Finding]:
    kappa, drift, radius = float(form.kappa), complex(*form.drift_velocity), float(form.circle_radius)
    centre, share = complex(*form.guiding_centre(0.0)), float(form.inertia_ratio) / (1 + float(form.inertia_ratio))
    if radius <= _STILL * abs(form.rate) * (abs(centre) + form.radius):
        zeta = seen.zeta
        moved = float(np.max(np.abs(zeta - zeta[0] - drift * seen.time)))
        if not drift:
            note = "put down gently, it stays while the table turns away under it"
            yield Finding("Distance that it moves", r"\varrho", 0.0, moved, "m", note, max(abs(centre), form.radius))
            return
        speed = abs(zeta[-1] - zeta[0]) / float(seen.time[-1])
        yield Finding("Drift speed", r"|v_d|", abs(drift), speed, "m/s", "straight, without loops")
        yield _direction(drift, zeta[-1] - zeta[0], system)
        return
    found = circle(seen, abs(kappa))
    note = "" if found else _LITTLE
    rate = found.rate if found else None
    yield Finding("Angular rate of the circle", r"\kappa", kappa, rate, "rad/s", note)
    of_table = f"{as_ratio(share)} of the table's rate, whatever its size and mass"
    yield Finding("Share of the table's rate", r"\kappa/\omega", share, rate and rate / float(form.rate), "", of_table)
    yield Finding("Radius of the circle", r"\varrho", radius, abs(found.arm) if found else None, "m", note)
    measured = abs(found.centre) if found else None
    if not drift:
        name = "Distance of its centre from the axis"
        yield Finding(name, r"|\zeta_c|", abs(centre), measured, "m", note, max(abs(centre), radius))
        return
    yield Finding("Drift speed", r"|v_d|", abs(drift), abs(found.drift) if found else None, "m/s", note)
    yield _direction(drift, found.drift if found else None, system)


def _direction(predicted: complex, measured: complex | None, system: RollingSystem) -> Finding:
    """Compare directions, in degrees from the first axis towards the second: from downhill, where there is a slope."""
    tilted = float(system.support.tilt) != 0
    name = "Direction of the drift, from straight downhill" if tilted else "Direction of the drift"
    turned = None if measured is None else math.degrees(cmath.phase(predicted) + cmath.phase(measured / predicted))
    note = "90° is level: on average it does not come down" if tilted and not system.loads else ""
    return Finding(name, r"\arg v_d", math.degrees(cmath.phase(predicted)), turned, "°", note, 360.0)


def _pushed(form: SphereOnPlane, system: RollingSystem, seen: Seen) -> Iterator[Finding]:
    """Compare with the parabola on a plane at rest."""
    push = complex(form.phi.re, form.phi.im)
    if seen.time.size < 4:
        return
    if not push:
        gone = float(np.abs(seen.zeta[-1] - seen.zeta[0]) / seen.time[-1])
        note = "nothing pushes it: it keeps its speed"
        yield Finding("Speed", "v", math.hypot(*map(float, form.velocity)), gone, "m/s", note)
        return
    found = acceleration(seen)
    yield Finding("Acceleration", r"|\varphi|", abs(push), abs(found), "m/s²")
    slide = float(system.gravity) * math.sin(abs(float(system.support.tilt)))
    if slide and not system.loads:
        share = 1 / (1 + float(form.inertia_ratio))
        note = f"{as_ratio(share)} of that of a block without friction"
        yield Finding("Share of a sliding block's", r"\frac{1}{1+k}", share, abs(found) / slide, "", note)
        return
    turned = math.degrees(cmath.phase(push) + cmath.phase(found / push))
    note = "from the first axis towards the second"
    yield Finding("Its direction", r"\arg\varphi", math.degrees(cmath.phase(push)), turned, "°", note, 360.0)
    applied, along = complex(*map(float, form.force[:2])), push / abs(push)
    reaction, seen_so = (((float(form.mass) * a - applied) / along).real for a in (push, found))
    note = "along the acceleration; negative: it holds the ball back"
    scale = max(abs(applied), float(form.mass) * abs(push))
    yield Finding("Reaction of the support", r"R_\parallel", reaction, seen_so, "N", note, scale)


def _braked(form: SphereOnPlane, seen: Seen) -> Iterator[Finding]:
    """Compare with the spiral or the straight course that air brakes."""
    gamma, kappa, push = float(form.gamma), float(form.kappa), complex(form.phi.re, form.phi.im)
    found = exponent(seen, math.hypot(gamma, kappa))
    rate = found[0] if found else None
    note = "" if found else _LITTLE
    yield Finding("Rate at which air slows it", r"\gamma", gamma, None if rate is None else -rate.real, "1/s", note)
    if kappa:
        yield Finding(
            "Angular rate of the spiral", r"\kappa", kappa, None if rate is None else rate.imag, "rad/s", note
        )
    if push:
        final = abs(push / complex(-gamma, kappa))
        measured = abs(found[1] / found[0]) if found else None
        yield Finding("Speed that it comes to", r"|\varphi/\lambda|", final, measured, "m/s", note)


def _friction(form: SphereOnPlane, seen: Seen) -> Iterator[Finding]:
    """Compare the friction that rolling takes with T5f, where no torque acts."""
    fx, fy, fz = (float(part) for part in form.force)
    if any(form.torque) or not fz < 0:
        return
    pull = math.hypot(fx, fy)
    if form.has_guiding_centre:
        turned = abs(float(form.kappa)) * float(seen.time[-1])
        radius = float(form.circle_radius)
        if pull and radius and turned < 2 * math.pi:
            return  # the largest comes with a full turn
        needed = (pull + float(form.mass) * float(form.kappa) ** 2 * radius) / -fz
    else:
        needed = pull * float(form.inertia_ratio) / (1 + float(form.inertia_ratio)) / -fz
    yield needed_friction(needed, seen)


def needed_friction(predicted: float | None, seen: Seen, friction: Any = None, normals: Any = None) -> Finding:
    """Compare the largest |f|/N of the samples with a prediction."""
    force = seen.at.contact_force
    normal = force[:, 2] if normals is None else np.sum(force * normals, axis=1)
    along = np.sqrt(np.maximum(np.sum(force * force, axis=1) - normal * normal, 0.0))
    if normals is None:
        along = np.hypot(force[:, 0], force[:, 1])
    pressed = normal > 1e-9 * float(np.max(np.abs(normal), initial=0.0))
    share = float(np.max(along[pressed] / normal[pressed])) if pressed.any() else None
    note = "largest |f|/N while it rolls"
    if friction is not None:
        note += f"; there is {float(friction):g}"
    return Finding("Friction needed", r"\mu", predicted, share, "", note, max(predicted or 0.0, 1e-3))


def in_air(form: SphereInMovingAir, seen: Seen) -> Iterator[Finding]:
    """Compare the two exponents of T14."""
    predicted = sorted((complex(part) for part in form.exponents), key=abs, reverse=True)
    found = two_exponents(seen, abs(predicted[0]))
    for name, mark, s, measured in zip(("faster", "slower"), "12", predicted, found or (None, None), strict=False):
        size, note = abs(s) or None, "" if measured is not None else _LITTLE
        turn, grow = (None, None) if measured is None else (measured.imag, measured.real)
        yield Finding(
            f"Angular rate of the {name} part", rf"\mathrm{{Im}}\,s_{mark}", s.imag, turn, "rad/s", note, size
        )
        yield Finding(f"Growth of the {name} part", rf"\mathrm{{Re}}\,s_{mark}", s.real, grow, "1/s", note, size)


def on_unsteady_plane(form: SphereOnUnsteadyPlane, system: RollingSystem, seen: Seen) -> Iterator[Finding]:
    """Compare M = ζ̇ − iκζ of the start with that of the samples, where no load changes it."""
    if system.loads or float(system.support.tilt):
        return
    rate = np.broadcast_to(seen.at.support(system).angular_velocity.z, seen.time.shape)
    share = float(form.inertia_ratio) / (1 + float(form.inertia_ratio))
    velocity = seen.at.velocity[:, 0] + 1j * seen.at.velocity[:, 1]
    kept = velocity - 1j * share * rate * seen.zeta
    at_start = float(form.motion.at(float(form.start_time), *form.motion.own_start()).angular_velocity.z)
    predicted = abs(complex(*form.velocity) - 1j * share * at_start * complex(*form.position))
    worst = float(np.abs(kept)[np.argmax(np.abs(np.abs(kept) - predicted))])
    size = max(float(np.max(np.abs(velocity))), predicted)
    note = "stays as it is, however the table is turned"
    yield Finding(
        "Velocity less its share of the table's", r"|\dot\zeta - i\kappa\zeta|", predicted, worst, "m/s", note, size
    )


def on_free_plane(form: SphereOnFreePlane, seen: Seen) -> Iterator[Finding]:
    """Compare a ball on a free turntable with its conic (T13)."""
    own, V = seen.at.own, seen.at.velocity
    rate = own[:, 1] if own.shape[1] > 1 else np.full(seen.time.size, np.nan)
    x, y = seen.at.position[:, 0], seen.at.position[:, 1]
    momentum = float(form.axle_inertia) * rate + float(form.mass) * (x * V[:, 1] - y * V[:, 0])
    predicted = float(form.angular_momentum)
    worst = float(momentum[np.argmax(np.abs(momentum - predicted))])
    scale = float(np.max(np.abs(float(form.axle_inertia) * rate)))
    yield Finding("Angular momentum about the axle", "L", predicted, worst, "kg m²/s", "of ball and table", scale)
    if not form.rate:
        return  # a table at rest that the ball sets going: no conic
    centre, measured = _conic(seen)
    share = float(form.inertia_ratio) / (1 + float(form.inertia_ratio))
    square = float(form.axle_inertia) + float(form.mass) * share * abs(complex(*form.position)) ** 2
    drive = math.hypot(*map(float, form.drive)) * math.sqrt(float(form.mass) / share)
    eccentricity = drive / (abs(float(form.rate)) * math.sqrt(square))
    yield Finding(f"Eccentricity of the {form.path}", "e", eccentricity, measured, "", "", max(eccentricity, 0.1))
    if math.isfinite(form.period):
        angle = np.unwrap(np.angle(seen.zeta - centre))
        measured = None if measured is None else round_time(seen.time, angle)
        yield Finding("Time round the ellipse", "T", float(form.period), measured, "s")


def _conic(seen: Seen) -> tuple[complex, float | None]:
    """Fit a conic to a path; return its centre, and its eccentricity unless the path is too short or straight."""
    middle, size = np.mean(seen.zeta), float(np.max(np.abs(seen.zeta - np.mean(seen.zeta))))
    if not size > 0:
        return complex(middle), None
    z = (seen.zeta[seen.every(0.0)] - middle) / size
    x, y = z.real, z.imag
    design = np.column_stack([x * x, x * y, y * y, x, y, np.ones_like(x)])
    _, sizes, rows = np.linalg.svd(design, full_matrices=False)
    if len(sizes) < 6 or sizes[-2] < 1e-7 * sizes[0]:
        return complex(middle), None
    a, b, c, d, e, f = rows[-1]
    centre = np.linalg.solve([[2 * a, b], [b, 2 * c]], [-d, -e])
    level = -(f + 0.5 * float(np.dot([d, e], centre)))  # of λ₁u² + λ₂v², counted from the centre
    one, other = np.linalg.eigvalsh([[a, 0.5 * b], [0.5 * b, c]]) / level
    # The main axis of an ellipse is its longer one, that of a hyperbola the one that it crosses.
    along, across = (min(one, other), max(one, other)) if one * other > 0 else (max(one, other), min(one, other))
    return complex(middle + size * complex(*centre)), math.sqrt(max(0.0, 1.0 - float(along / across)))
