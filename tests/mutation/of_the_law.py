"""Faults planted in the law: the kinematics of contact, rolling, slipping, flight, and a free axle."""

from __future__ import annotations

from .planting import Mutant

CONTACT = "mechanics.contact"
SLIPPING = "mechanics.slipping"
LOADS = "mechanics.loads"
EGG = "egg_rolls"
BOWL = "egg_in_rocking_bowl"
DOME = "egg_slips_off_dome"
AIR = "egg_over_bowl"
SLIPS = "egg_slips_in_bowl"
LOADED = "egg_under_loads"
FREE = "egg_on_free_table"

KINEMATICS = (
    Mutant("T1: slip left out of the contact's way", CONTACT, "moved = slip + self", "moved = self", SLIPS),
    Mutant("T1: C(Ω − ω)×n 1 % too large", CONTACT, "on_tangent((angular", "on_tangent(1.01 * (angular", BOWL),
    Mutant(
        "T1: C(Ω − ω)×n with the other sign",
        CONTACT,
        "moved = slip + self",
        "moved = slip - self",
        BOWL,
        refused="hold the body down",
    ),
    Mutant("T1: ω left out", CONTACT, "(angular_velocity - omega).cross(n)", "angular_velocity.cross(n)", BOWL),
    Mutant(
        "T1: 1 + C S taken for 1",
        CONTACT,
        "along = self.along_support(moved, 0.0 if gap is None else gap)",
        "along = moved",
        BOWL,
    ),
    Mutant("T1: C S 1 % too large", CONTACT, "on_tangent(bent)", "on_tangent(bent * 1.01)", BOWL),
    Mutant("T1: u left out of ṗ", CONTACT, "self.support.material_velocity(self.point) + along", "along", EGG),
    Mutant(
        "T1: ρ̇ with the other sign",
        CONTACT,
        "return point_rate, point_rate - velocity",
        "return point_rate, velocity - point_rate",
        EGG,
    ),
    Mutant(
        "T1: V = u − Ω×ρ 1 % too large",
        CONTACT,
        "(self.point) - angular_velocity.cross(self.offset)",
        "(self.point) - angular_velocity.cross(self.offset) * 1.01",
        EGG,
    ),
    Mutant(
        "T4a: the gap left out of 1 + (C + g)S",
        CONTACT,
        "turned if is_zero(gap) else turned + bent * gap",
        "turned",
        AIR,
    ),
    Mutant("T4a: −(s·n)n left out", CONTACT, "moved - n * slip.dot(n) - omega", "moved - omega", AIR),
    Mutant(
        "T4a: −g ω×n left out",
        CONTACT,
        "moved - n * slip.dot(n) - omega.cross(n) * gap",
        "moved - n * slip.dot(n)",
        AIR,
    ),
    Mutant(
        "T4a: the gap grows 1 % too fast",
        SLIPPING,
        "turned, acting.force / m, n.dot(s))",
        "turned, acting.force / m, n.dot(s) * 1.01)",
        AIR,
    ),
)

ROLLING = (
    Mutant("T2: the torque 1 % too large", CONTACT, "solve(acting.torque - ", "solve(acting.torque * 1.01 - ", LOADED),
    Mutant("T2: the torque left out", CONTACT, "solve(acting.torque - ", "solve(ZERO - ", LOADED),
    Mutant("T2: Ω×JΩ left out", CONTACT, "- system.body.gyroscopic(Q, Omega), rho", ", rho", EGG),
    Mutant("T2: Ω×JΩ with the other sign", CONTACT, "solve(acting.torque - ", "solve(acting.torque + ", EGG),
    Mutant("T2: ρ×F 1 % too large", CONTACT, "inertial - F))", "inertial - F * 1.01))", EGG),
    Mutant("T2: ρ×F with the other sign", CONTACT, "inertial - F))", "inertial + F))", EGG),
    Mutant("T2: m ρ×(u̇ − Ω×ρ̇) 1 % too large", CONTACT, "(m * inertial - F))", "(1.01 * m * inertial - F))", EGG),
    Mutant("T2: Ω×ρ̇ left out", CONTACT, "inertial = u_rate - Omega.cross(rho_rate)", "inertial = u_rate", EGG),
    Mutant(
        "T2: u̇ left out", CONTACT, "inertial = u_rate - Omega.cross(rho_rate)", "inertial = -Omega.cross(rho_rate)", EGG
    ),
    Mutant(
        "T2: Steiner's term 1 % too large",
        CONTACT,
        "whole = inertia_about(J, m, rho)",
        "whole = inertia_about(J, m * 1.01, rho)",
        EGG,
    ),
    Mutant(
        "T2: J 1 % too large",
        CONTACT,
        "whole = inertia_about(J, m, rho)",
        "whole = inertia_about(J * 1.01, m, rho)",
        EGG,
    ),
    Mutant(
        "T3: m V̇ 1 % too large",
        CONTACT,
        "R = m * (inertial - Omega_rate.cross(rho)) - F",
        "R = 1.01 * m * (inertial - Omega_rate.cross(rho)) - F",
        EGG,
    ),
    Mutant(
        "T3: Ω̇×ρ with the other sign",
        CONTACT,
        "inertial - Omega_rate.cross(rho)",
        "inertial + Omega_rate.cross(rho)",
        EGG,
    ),
    Mutant(
        "T3: F left out",
        CONTACT,
        "(inertial - Omega_rate.cross(rho)) - F",
        "(inertial - Omega_rate.cross(rho))",
        EGG,
    ),
    Mutant(
        "T3: F left out of N",
        CONTACT,
        "(rho.cross(n))) - n.dot(F)",
        "(rho.cross(n)))",
        EGG,
        refused="contact chatters",
    ),
    Mutant(
        "couples that follow N: 1 % too large in T2",
        CONTACT,
        "turned = whole.solve(acting.couple)",
        "turned = whole.solve(acting.couple * 1.01)",
        LOADED,
    ),
    Mutant(
        "couples that follow N: left out of R",
        CONTACT,
        "couplings.append((turned, turned.cross(rho) * -m))",
        "couplings.append((turned, ZERO))",
        LOADED,
    ),
    Mutant(
        "free axle: its lever 1 % too long",
        CONTACT,
        "turned = whole.solve(ZERO, m * rho.cross(lever))",
        "turned = whole.solve(ZERO, 1.01 * m * rho.cross(lever))",
        FREE,
    ),
    Mutant(
        "free axle: R without ω̇", CONTACT, "m * (lever - turned.cross(rho))", "m * (ZERO - turned.cross(rho))", FREE
    ),
    Mutant(
        "free axle: the moment of R with the other sign",
        CONTACT,
        "(support, N) - lever.dot(R)",
        "(support, N) + lever.dot(R)",
        FREE,
    ),
    Mutant(
        "free axle: the couples of the contact left out",
        LOADS + ".base",
        "return -support.axle.dot(self.from_support) - (support.axle.dot(self.couple) * N if self.has_couple else 0.0)",
        "return 0.0",
        FREE,
    ),
    Mutant(
        "free axle: its own torque left out of ω̇",
        "mechanics.motions.free",
        "(rate, (self.axle_torque(time, coordinates) + moment) / self.inertia)",
        "(rate, moment / self.inertia)",
        FREE,
    ),
    Mutant(
        "free axle: turns 1 % too fast",
        "mechanics.motions.free",
        "return (rate, (self",
        "return (1.01 * rate, (self",
        FREE,
    ),
)

SLIPPING_LAW = (
    Mutant(
        "T4: friction 1 % too large",
        SLIPPING,
        "n - hat * system.support.sliding_friction",
        "n - hat * system.support.sliding_friction * 1.01",
        SLIPS,
    ),
    Mutant(
        "T4: friction the other way",
        SLIPPING,
        "d = n if hat is ZERO else n - hat",
        "d = n if hat is ZERO else n + hat",
        SLIPS,
    ),
    Mutant(
        "T4: friction across the slip",
        SLIPPING,
        "d = n if hat is ZERO else n - hat",
        "d = n if hat is ZERO else n - n.cross(hat)",
        SLIPS,
    ),
    Mutant(
        "T4: static friction while slipping",
        "mechanics.system",
        "return self.friction if self.kinetic_friction is None else self.kinetic_friction",
        "return self.friction",
        DOME,
    ),
    Mutant(
        "T4: N 1 % too large",
        SLIPPING,
        "N = -free.opening / opening_per_newton",
        "N = -1.01 * free.opening / opening_per_newton",
        SLIPS,
    ),
    Mutant("T4: ṅ·s left out", SLIPPING, "n.dot(s_rate) + n_rate.dot(s), n_rate", "n.dot(s_rate), n_rate", SLIPS),
    Mutant(
        "T4: S w left out of ṅ",
        SLIPPING,
        " + contact.shape_operator.on_tangent(along)",
        "",
        SLIPS,
    ),
    Mutant(
        "T4: Ω×ρ̇ left out",
        SLIPPING,
        "turning.cross(contact.offset) + Omega.cross(rho_rate) - u_rate",
        "turning.cross(contact.offset) - u_rate",
        SLIPS,
    ),
    Mutant("T4: u̇ left out", SLIPPING, "+ Omega.cross(rho_rate) - u_rate", "+ Omega.cross(rho_rate)", SLIPS),
    Mutant(
        "T4: Ω×JΩ left out",
        SLIPPING,
        "torque, holding = acting.torque - system.body.gyroscopic(Q, Omega), ZERO",
        "torque, holding = acting.torque, ZERO",
        SLIPS,
    ),
    Mutant("T4: F 1 % too large", SLIPPING, "s_rate = acting.force / m", "s_rate = acting.force * 1.01 / m", SLIPS),
    Mutant(
        "T4: ρ×d 1 % too large",
        SLIPPING,
        "turned = inertia.solve(torque)",
        "turned = inertia.solve(torque * 1.01)",
        SLIPS,
    ),
    Mutant(
        "T4: d/m left out of a₁",
        SLIPPING,
        "answer = push / system.body.mass + turned.cross(rho)",
        "answer = turned.cross(rho)",
        SLIPS,
        refused="all but jams",
    ),
    Mutant(
        "T4: the slip grows 1 % too fast",
        SLIPPING,
        "free.slip_rate + answer.slip * N +",
        "(free.slip_rate + answer.slip * N) * 1.01 +",
        SLIPS,
    ),
    Mutant(
        "T4: R 1 % too large",
        SLIPPING,
        "        opening_per_newton,\n        d * N,",
        "        opening_per_newton,\n        d * N * 1.01,",
        SLIPS,
    ),
    Mutant(
        "flight: F 1 % too large",
        SLIPPING,
        "turned, acting.force / m, n.dot(s))",
        "turned, acting.force * 1.01 / m, n.dot(s))",
        AIR,
    ),
    Mutant(
        "flight: Ω×JΩ left out",
        SLIPPING,
        "solve(acting.torque - system.body.gyroscopic(Q, Omega))\n    return Flying",
        "solve(acting.torque)\n    return Flying",
        AIR,
    ),
)

LAW = (*KINEMATICS, *ROLLING, *SLIPPING_LAW)
