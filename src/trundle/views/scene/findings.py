"""What theory promises of a run beside what its samples show, each number taken in two ways that share nothing."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from ...mechanics.algebra import Quaternion, Vector
from ...mechanics.contact import normal_on
from ...mechanics.invariants import Record, invariants_of
from ...mechanics.invariants.legendre import LEGENDRE_PAIR
from ...mechanics.invariants.revolution import ROUTH_PAIR
from ...mechanics.loads import BodyMotion
from ...mechanics.system import RollingSystem, State
from ...solve.exact import ClosedForm
from ...solve.exact.finding import Finding
from ...solve.exact.fits import Seen, needed_friction
from ...solve.samples import FLIGHT, ROLLING, SLIPPING, Samples

_LOOKED_AT = 200  # samples
_NAMES = {ROLLING: "rolling", SLIPPING: "slipping", FLIGHT: "flight"}
_SEVERAL = (ROUTH_PAIR.name, LEGENDRE_PAIR.name)  # two numbers each, and slow to find
_SYMBOLS = {"energy": "E", "moving energy": r"\tilde E", "spin about the normal": r"\Omega_n"}


def findings_of(system: RollingSystem, start: State, samples: Samples, form: ClosedForm | None) -> list[Finding]:
    """Return predicted and measured numbers of a run: those of its closed form, and those that every run has."""
    seen = Seen.of(system, samples)
    found = list(form.findings(seen)) if form is not None and seen.time.size > 3 else []
    if not any(one.name == "Friction needed" for one in found):
        found += [*_friction(seen), *_sliding_friction(seen)]
    found += _integrals(system, start, samples)
    return found


def _friction(seen: Seen) -> Iterator[Finding]:
    """Say what friction rolling takes in the first stretch, with no prediction."""
    lifts = any(event.kind == "lift" for event in seen.at.events)  # before that N falls to 0, and the share has no end
    if seen.time.size and seen.at.phase[0] == ROLLING and not lifts:
        some = seen.at.part(slice(None, None, max(1, seen.time.size // 2000)))
        system = seen.system
        found = needed_friction(None, some, system.support.friction, some.normals(system))
        if found.measured is not None:
            yield found


def _sliding_friction(seen: Seen) -> Iterator[Finding]:
    """Compare |f|/N while it slips with the coefficient of slipping."""
    if seen.time.size and seen.at.phase[0] == SLIPPING:
        some = seen.at.part(slice(None, None, max(1, seen.time.size // _LOOKED_AT)))
        system = seen.system
        mu = float(system.support.sliding_friction)
        found = needed_friction(mu, some, None, some.normals(system))
        yield Finding("Friction while it slips", r"\mu_k", mu, found.measured, "", note="largest |f|/N while it slips")


def _integrals(system: RollingSystem, start: State, samples: Samples) -> Iterator[Finding]:
    """Compare each first integral at the start with its value where it is furthest from it."""
    phases = {int(code) for code in np.unique(samples.phase)}
    if not phases <= set(_NAMES) or not samples.time.size:
        return
    struck = any(event.kind in ("land", "settle", "jolt") for event in samples.events)
    some = samples.part(slice(None, None, max(1, samples.time.size // _LOOKED_AT)))
    record = Record(some.motion(system), Vector.of(some.contact), some.support_columns)
    at_start = _record(system, start, samples)
    for integral in invariants_of(system, tuple(sorted(_NAMES[code] for code in phases))):
        if struck and not integral.through_changes:
            continue
        first, sizes = integral.sized_terms(system, at_start) if integral.name not in _SEVERAL else ([], [])
        if not first or any(isinstance(term, Vector) or np.ndim(term) for term in first):
            continue  # of several numbers no one can be shown
        later, meanwhile = integral.sized_terms(system, record)
        total = np.broadcast_to(np.asarray(sum(later), dtype=float), some.time.shape)
        predicted = float(sum(first))
        worst = float(total[np.argmax(np.abs(total - predicted))])
        size = max(float(np.max(np.abs(part))) for part in (*sizes, *meanwhile))
        name = integral.name[0].upper() + integral.name[1:]
        note = f"{integral.formula} stays the same: at the start, and where it is furthest from that"
        yield Finding(
            name, _SYMBOLS.get(integral.name, "I"), predicted, worst, integral.unit, note=note, scale=size or None
        )


def _record(system: RollingSystem, start: State, samples: Samples) -> Any:
    """Return the start as integrals take it."""
    support, contact = system.support.motion.at(start.time, *start.support), Vector.of(samples.contact[0])
    motion = BodyMotion(
        start.time,
        system.body.mass,
        Vector(*start.position),
        Vector(*start.velocity),
        Quaternion(*start.orientation),
        Vector(*start.angular_velocity),
        normal_on(system, support, contact),
        support.angular_velocity,
    )
    return Record(motion, contact, start.support)
