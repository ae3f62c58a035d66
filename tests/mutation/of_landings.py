"""Faults planted in the landings."""

from __future__ import annotations

from .planting import Mutant

FOLLOWING = "solve.transitions"
RESPONSE = "mechanics.slipping"
IMPACT, TURNING = "mechanics.impact", "mechanics.turning_slip"
BOUNCES = "egg_bounces"

LANDINGS = (
    Mutant(
        "landing: e for e²",
        IMPACT,
        "self.aim = (1 - self.restitution**2) * self.work",
        "self.aim = (1 - self.restitution) * self.work",
        "ball_bounces",
    ),
    Mutant(
        "landing: e 1 % too large",
        IMPACT,
        "as_float(system.support.restitution)",
        "1.01 * as_float(system.support.restitution)",
        "ball_bounces",
    ),
    Mutant(
        "landing: friction 1 % too large",
        IMPACT,
        "mu = math.inf if system.support.friction is None else as_float(",
        "mu = math.inf if system.support.friction is None else 1.01 * as_float(",
        "ball_lands_on_ice",
    ),
    Mutant(
        "landing: without friction",
        IMPACT,
        "mu = math.inf if system.support.friction is None else as_float(",
        "mu = math.inf if system.support.friction is None else 0.0 * as_float(",
        "ball_bounces",
    ),
    Mutant(
        "landing: effective mass 1 % off",
        RESPONSE,
        "answer = push / system.body.mass + turned.cross(rho)",
        "answer = push / (1.01 * system.body.mass) + turned.cross(rho)",
        "ball_bounces",
    ),
    Mutant(
        "landing: effective inertia 1 % off",
        RESPONSE,
        "answer = push / system.body.mass + turned.cross(rho)",
        "answer = push / system.body.mass + turned.cross(rho) * 1.01",
        "ball_bounces",
    ),
    Mutant(
        "landing: ΔV 1 % too large",
        IMPACT,
        "return Impact(P, P / system.body.mass,",
        "return Impact(P, P * 1.01 / system.body.mass,",
        "ball_bounces",
    ),
    Mutant(
        "landing: ΔΩ 1 % too large",
        IMPACT,
        "J.solve(contact.offset.cross(P)), axle)",
        "J.solve(contact.offset.cross(P)) * 1.01, axle)",
        "ball_bounces",
    ),
    Mutant(
        "landing: ΔΩ with the other sign",
        IMPACT,
        "J.solve(contact.offset.cross(P)), axle)",
        "-J.solve(contact.offset.cross(P)), axle)",
        "ball_bounces",
    ),
    Mutant(
        "landing: the axle left out of M",
        RESPONSE,
        "answer = answer + lever * (moment / motion.inertia)",
        "pass",
        "ball_on_free_table",
    ),
    Mutant(
        "landing: the axle turned 1 % too much",
        IMPACT,
        "axle = -contact.support.lever(contact.point).dot(P) / motion.inertia",
        "axle = -1.01 * contact.support.lever(contact.point).dot(P) / motion.inertia",
        "ball_on_free_table",
    ),
    Mutant(
        "landing: Keller's friction 1 % too large",
        TURNING,
        "mu, n = self.mu, 1.0",
        "mu, n = 1.01 * self.mu, 1.0",
        BOUNCES,
    ),
    Mutant(
        "landing: slip does not turn",
        TURNING,
        "-_product(s, turning),\n                _product(c, turning),",
        "0.0,\n                0.0,",
        BOUNCES,
    ),
    Mutant(
        "landing: slip turns the other way",
        TURNING,
        "-_product(s, turning),\n                _product(c, turning),",
        "_product(s, turning),\n                -_product(c, turning),",
        BOUNCES,
    ),
    Mutant(
        "landing: Stronge's work 1 % off",
        TURNING,
        "                _product(up, size),",
        "                _product(up, size) + 0.01 * one,",
        BOUNCES,
    ),
    Mutant(
        "landing: slip that has ended begins again",
        IMPACT,
        "_length(self._holding) <= self.mu",
        "_length(self._holding) <= 0.0 * self.mu",
        "egg_grips_as_it_lands",
        refused="jams",
    ),
    Mutant(
        "landing: slip that has ended stays so",
        IMPACT,
        "_length(self._holding) <= self.mu",
        "True",
        "egg_slips_as_it_lands",
    ),
    Mutant(
        "landing: at the wrong place of the body",
        FOLLOWING,
        "state, now, floats(before.nearest))",
        "state, now, floats(before.nearest * 1.001))",
        "ball_bounces",
    ),
)
