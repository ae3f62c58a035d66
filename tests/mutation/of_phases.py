"""Faults planted in the phases: events that come too soon, too late or never, and what is recorded of them."""

from __future__ import annotations

from trundle.solve.samples import ROLLING
from trundle.solve.samples import SLIPPING as SLIPPING_CODE

from .planting import Mutant

SLIPPING = "mechanics.slipping"
LAWS = "solve.laws"
FOLLOWING = "solve.transitions"
RK = "solve.runge_kutta"
DOME = "egg_slips_off_dome"
AIR = "egg_over_bowl"
LOCATED = "            found = fall, which"
LATE = "            found = path.t_old + 1.01 * (fall - path.t_old), which"
EARLY = "            found = path.t_old + 0.99 * (fall - path.t_old), which"
RECORDED = """now = self._recorded(system, time, states)
        turning = self._turns(now.contact, Vector.of(Omega))
        centre, V, R, Omega = arrays(p, now.contact.centre, now.velocity, now.reaction, turning)
        return Samples(
            time, centre, p, V, Omega, q, R + 0.0, phase=phase_of(time, self.code), support_coordinates=coordinates
"""
RECORDED_ROLLING = """phase=phase_of(time, self.code), support_coordinates=coordinates
        )


class RollingWithResistance"""
CONE = "f, most = reaction - n * N, system.support.friction * (N + floor)"
LIFT = 'found = {"lift": N + floor}'
LIFT_OF_SLIP = 'found = {"lift": now.normal_force + self._floor(event_parameters)[0]}'

PHASES = (
    Mutant(
        "lift 1 % late",
        f"{LAWS}.friction",
        LIFT,
        'found = {"lift": N + floor + 0.01 * system.body.mass * system.gravity}',
        "ball_off_dome",
    ),
    Mutant(
        "lift 1 % early",
        f"{LAWS}.friction",
        LIFT,
        'found = {"lift": N + floor - 0.01 * system.body.mass * system.gravity}',
        "ball_off_dome",
    ),
    Mutant(
        "lift where N only touches zero",
        FOLLOWING,
        "_touching(system, at) if _stays(system, law, at, stop) else _lifted(system, at)",
        "_lifted(system, at)",
        "ball_turns_back_in_pipe",
    ),
    Mutant("lift missed", f"{LAWS}.friction", LIFT, 'found = {"lift": 1.0 + 0.0 * N}', "ball_off_dome"),
    Mutant(
        "lift from slipping 1 % late",
        f"{LAWS}.slipping",
        LIFT_OF_SLIP,
        'found = {"lift": now.normal_force + 0.01 * system.body.mass * system.gravity}',
        DOME,
    ),
    Mutant(
        "lift from slipping missed",
        f"{LAWS}.slipping",
        LIFT_OF_SLIP,
        'found = {"lift": 1.0 + 0.0 * now.normal_force}',
        DOME,
    ),
    Mutant(
        "slip 1 % late",
        f"{LAWS}.friction",
        CONE,
        CONE.replace("N, system", "N, 1.01 * system"),
        "ball_on_rocking_table",
    ),
    Mutant(
        "slip 1 % early",
        f"{LAWS}.friction",
        CONE,
        CONE.replace("N, system", "N, 0.99 * system"),
        "ball_on_rocking_table",
        refused="can neither roll, nor slip",
    ),
    Mutant(
        "slip missed",
        f"{LAWS}.friction",
        "if system.support.friction is not None:\n        " + CONE,
        "if False:\n        " + CONE,
        "ball_on_rocking_table",
    ),
    Mutant(
        "grip 0.1 ms late",
        FOLLOWING,
        "wait = max(0.0, -v.dot(rate) / max(rate.dot(rate), 1e-300))",
        "wait = 1e-4",
        "egg_grips_in_bowl",
    ),
    Mutant("all events 1 % of a step late: lift", RK, LOCATED, LATE, "ball_slips_off_dome"),
    Mutant("all events 1 % of a step late: the rim", RK, LOCATED, LATE, "off_the_rim"),
    Mutant("all events 1 % of a step late: rest", RK, LOCATED, LATE, "ball_comes_to_rest"),
    Mutant("all events 1 % of a step early: lift", RK, LOCATED, EARLY, DOME),
    Mutant("all events 1 % of a step early: landing", RK, LOCATED, EARLY, AIR),
    Mutant(
        "dips between two looks are not looked for",
        RK,
        "if np.nanmin(inside, initial=np.inf) < LOW * np.ptp(values) and",
        "if False and",
        "ball_over_a_crest",
    ),
    Mutant(
        "grip where the cone does not hold",
        FOLLOWING,
        'floor).get("slip", 0.0) < 0\n',
        'floor).get("slip", 0.0) < -float(R.dot(R))\n',
        "incline_too_steep",
    ),
    Mutant(
        "slips from the start, taken for rolling",
        FOLLOWING,
        "if support.friction is not None and at.sliding.norm() > limit:",
        "if support.friction is not None and at.sliding.norm() > 100:",
        "billiard",
    ),
    Mutant(
        "landing late, 10 μm deep",
        f"{LAWS}.flight",
        'return {"land": rest[3], **',
        'return {"land": rest[3] + 1e-5, **',
        "ball_lands_on_ice",
    ),
    Mutant(
        "landing early, 10 μm over it",
        f"{LAWS}.flight",
        'return {"land": rest[3], **',
        'return {"land": rest[3] - 1e-5, **',
        "ball_bounces",
    ),
    Mutant("landing missed", f"{LAWS}.flight", 'return {"land": rest[3], **', "return {**", "ball_bounces"),
    Mutant(
        "set down without its slip",
        FOLLOWING,
        "rolling_velocity(at.Omega) + at.sliding, at.Omega)",
        "rolling_velocity(at.Omega), at.Omega)",
        "ball_lands_on_ice",
    ),
    Mutant("bounces cut at a thousandth of the body", FOLLOWING, "SETTLED = 1e-6", "SETTLED = 1e-3", "ball_bounces"),
    Mutant(
        "rest left 1 % late",
        f"{LAWS}.friction",
        "most = system.resistance * normal_force",
        "most = 1.01 * system.resistance * normal_force",
        "ball_comes_to_rest",
    ),
    Mutant(
        "rest left 1 % early",
        f"{LAWS}.friction",
        "most = system.resistance * normal_force",
        "most = 0.99 * system.resistance * normal_force",
        "ball_comes_to_rest",
        refused="chatters",
    ),
    Mutant(
        "rest: R 1 % too large",
        f"{LAWS}.resting",
        "R = support.material_acceleration(contact.centre, V) * m - F",
        "R = (support.material_acceleration(contact.centre, V) * m - F) * 1.01",
        "ball_comes_to_rest",
    ),
    Mutant(
        "the rim 1 % further out",
        f"{LAWS}.law",
        'found["rim"] = surface.rim * surface.rim -',
        'found["rim"] = 1.02 * surface.rim * surface.rim -',
        "off_the_rim",
    ),
    Mutant("the edge of the shape missed", f"{LAWS}.law", 'found["edge"] = covered', "pass", "over_its_edge"),
    Mutant(
        "V jumps by 1e-6 where it grips",
        FOLLOWING,
        'Omega = at.Omega if stop == "grip" else',
        'Omega = at.Omega * (1 + 1e-6) if stop == "grip" else',
        "billiard",
    ),
    Mutant(
        "recorded as rolling while it slips",
        f"{LAWS}.slipping",
        RECORDED,
        RECORDED.replace("self.code", str(ROLLING)),
        "billiard",
    ),
    Mutant(
        "recorded as slipping while it rolls",
        f"{LAWS}.rolling",
        RECORDED_ROLLING,
        RECORDED_ROLLING.replace("self.code", str(SLIPPING_CODE)),
        "ball_on_rocking_table",
    ),
    Mutant(
        "flight: r moves a millionth too fast",
        f"{LAWS}.flight",
        "moving = (*now.acceleration, now.gap_rate, *rest[:3])",
        "moving = (*now.acceleration, now.gap_rate, *(part * (1 + 1e-6) for part in rest[:3]))",
        AIR,
    ),
    Mutant(
        "landing: put down a nanometre over the support",
        FOLLOWING,
        "return _struck(system, at.over(0.0))",
        "return _struck(system, at.over(1e-9))",
        "ball_bounces",
    ),
    Mutant(
        "flight recorded with a force",
        f"{LAWS}.flight",
        "np.zeros_like(p),\n            phase=phase,",
        "np.ones_like(p),\n            phase=phase,",
        "ball_bounces",
    ),
)
