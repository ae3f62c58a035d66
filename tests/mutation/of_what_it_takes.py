"""Faults planted in what the law takes: orientation, geometry, motion of the support, loads; and in closed forms."""

from __future__ import annotations

from .planting import Mutant

ALGEBRA = "mechanics.algebra"
LAWS = "solve.laws"
LOADS = "mechanics.loads"
EGG = "egg_rolls"
BOWL = "egg_in_rocking_bowl"
SLIPS = "egg_slips_in_bowl"
LOADED = "egg_under_loads"

ORIENTATION = (
    Mutant(
        "q̇ = ½ q Ω",
        ALGEBRA,
        "turned = Quaternion(0.0, *angular_velocity) * self",
        "turned = self * Quaternion(0.0, *angular_velocity)",
        BOWL,
    ),
    Mutant(
        "q̇ = ½ q Ω, a billiard ball",
        ALGEBRA,
        "turned = Quaternion(0.0, *angular_velocity) * self",
        "turned = self * Quaternion(0.0, *angular_velocity)",
        "billiard",
    ),
    Mutant(
        "q̇ = ½ q Ω, in flight",
        ALGEBRA,
        "turned = Quaternion(0.0, *angular_velocity) * self",
        "turned = self * Quaternion(0.0, *angular_velocity)",
        "ball_bounces",
    ),
    Mutant(
        "q̇ = −½ Ω q",
        ALGEBRA,
        "0.5 * turned.w, 0.5 * turned.x, 0.5 * turned.y, 0.5 * turned.z",
        "-0.5 * turned.w, -0.5 * turned.x, -0.5 * turned.y, -0.5 * turned.z",
        BOWL,
    ),
    Mutant(
        "q̇ 1 % too fast",
        ALGEBRA,
        "0.5 * turned.w, 0.5 * turned.x, 0.5 * turned.y, 0.5 * turned.z",
        "0.505 * turned.w, 0.505 * turned.x, 0.505 * turned.y, 0.505 * turned.z",
        "ball_on_rocking_table",
    ),
    Mutant(
        "Q transposed",
        ALGEBRA,
        "2.0 * (x * y - w * z), 2.0 * (x * z + w * y)),",
        "2.0 * (x * y + w * z), 2.0 * (x * z + w * y)),",
        EGG,
        refused="hold the body down",
    ),
    Mutant(
        "q not made a unit",
        f"{LAWS}.columns",
        "return q / np.linalg.norm(q, axis=-1, keepdims=True)",
        "return q * 1.001",
        BOWL,
    ),
    Mutant(
        "closed form: q by Ω of a moment later",
        "solve.closed_form",
        "Omega = motion.angular_velocity_at(t)",
        "Omega = motion.angular_velocity_at(t + 1e-3)",
        "turntable_exactly",
    ),
    Mutant(
        "closed form: q by ½ q Ω",
        "solve.orientation",
        "result[part] = _unit(course.at(times[part]))",
        "result[part] = _unit(course.at(times[part])) * np.array([1.0, -1.0, -1.0, -1.0])",
        "turntable_exactly",
    ),
    Mutant(
        "closed form: a straight turn 1 % too far",
        "solve.closed_form",
        "half, q = 0.5 * angle",
        "half, q = 0.505 * angle",
        "cylinder_exactly",
    ),
)

GEOMETRY = (
    Mutant(
        "ellipsoid: C 1 % too large",
        "mechanics.shapes.ellipsoid",
        "return ReducedTensor.of(A, x, shrunk)",
        "return ReducedTensor.of(A, x, 1.01 * shrunk)",
        EGG,
    ),
    Mutant(
        "bowl: S 1 % too large",
        "mechanics.surfaces.spherical",
        "RoundTensor.of(self.sign / distance, e)",
        "RoundTensor.of(1.01 * self.sign / distance, e)",
        BOWL,
    ),
    Mutant(
        "bowl: n leans",
        "mechanics.surfaces.spherical",
        "arm = self._arm(p)\n        return arm * (self.sign / arm.norm())",
        "arm = self._arm(p) + Vector(0.0, 0.0, 0.01 * p.x)\n        return arm * (self.sign / arm.norm())",
        BOWL,
    ),
    Mutant(
        "bowl: the level 1 % of the height too high",
        "mechanics.surfaces.spherical",
        "(2.0 * self.sign) * self.radius * p.z",
        "(2.02 * self.sign) * self.radius * p.z",
        BOWL,
    ),
    Mutant(
        "support: ω 1 % too fast for its pose",
        "mechanics.motions.turning",
        "ZERO, ZERO, ZERO, axis * rate, axis * acceleration",
        "ZERO, ZERO, ZERO, axis * (1.01 * rate), axis * acceleration",
        BOWL,
    ),
    Mutant(
        "support: ω̇ 1 % too large",
        "mechanics.motions.turning",
        "axis * rate, axis * acceleration",
        "axis * rate, axis * (1.01 * acceleration)",
        BOWL,
    ),
    Mutant(
        "support: Ẋ 1 % too fast",
        "mechanics.motions.turning",
        "amplitude * s, amplitude * (rate * c),",
        "amplitude * s, amplitude * (1.01 * rate * c),",
        BOWL,
    ),
    Mutant(
        "support: Ẍ with the other sign",
        "mechanics.motions.turning",
        "amplitude * -(rate * rate * s)",
        "amplitude * (rate * rate * s)",
        BOWL,
    ),
    Mutant(
        "support: ω̇×(p − X) left out of u̇",
        "mechanics.motions.base",
        "            + self.angular_acceleration.cross(p - self.origin)\n",
        "",
        BOWL,
    ),
    Mutant(
        "support: ω×(ṗ − Ẋ) left out of u̇",
        "mechanics.motions.base",
        "            + self.angular_velocity.cross(p_rate - self.velocity)\n",
        "",
        EGG,
    ),
    Mutant(
        "support: an uneven turn's ω̇ 1 % too large",
        "mechanics.motions.uneven",
        "omega_rate = E_Z * (self",
        "omega_rate = E_Z * (1.01 * self",
        SLIPS,
    ),
    Mutant(
        "inertia: turned the wrong way",
        "mechanics.bodies.inertia",
        "return RotatedTensor(Q, Matrix.diagonal(self.x, self.y, self.z)).dense",
        "return RotatedTensor(Q.transpose, Matrix.diagonal(self.x, self.y, self.z)).dense",
        EGG,
    ),
)

ON_LOADS = (
    Mutant(
        "gravity 1 % too strong",
        LOADS + ".given",
        "return self.acceleration * motion.mass",
        "return self.acceleration * (1.01 * motion.mass)",
        EGG,
    ),
    Mutant(
        "gravity leans the other way",
        "mechanics.system",
        "return Gravity(self.gravity * xp.sin(tilt), 0.0",
        "return Gravity(-self.gravity * xp.sin(tilt), 0.0",
        EGG,
    ),
    Mutant(
        "a force given as numbers 1 % too strong",
        LOADS + ".given",
        '"""Return F."""\n        return self.at(motion.time)',
        '"""Return F."""\n        return self.at(motion.time) * 1.01',
        "ball_pushed",
    ),
    Mutant(
        "a potential's force 1 % too strong",
        LOADS + ".field",
        "return -Vector(*self.formula",
        "return -1.01 * Vector(*self.formula",
        LOADED,
    ),
    Mutant(
        "rolling resistance 1 % too strong, with a closed form",
        LOADS + ".contact",
        "return over * (-self.offset /",
        "return over * (-1.01 * self.offset /",
        "ball_slows_down",
    ),
    Mutant(
        "drag 1 % too strong, with a closed form",
        LOADS + ".air",
        "return through_air(motion, self.air) * -self.coefficient",
        "return through_air(motion, self.air) * (-1.01 * self.coefficient)",
        "ball_in_air",
    ),
    Mutant(
        "loads: torques not added up",
        "mechanics.system",
        "force, torque = force + load.force(motion), torque + exerted",
        "force, torque = force + load.force(motion), torque",
        LOADED,
    ),
    Mutant(
        "loads: couples at the contact not added up",
        "mechanics.system",
        "couple = couple + load.torque_per_normal_force(motion)",
        "couple = ZERO",
        LOADED,
    ),
    Mutant(
        "loads: the last one left out",
        "mechanics.system",
        "return (self.weight, *self.loads)",
        "return (self.weight, *self.loads[:-1])",
        LOADED,
    ),
)

CLOSED_FORMS = (
    Mutant(
        "T5: κ one part in 10⁷ off",
        "solve.exact.sphere_on_plane",
        "return quotient_times(self.rate, self.inertia_ratio)",
        "return quotient_times(self.rate * (1 + 1e-7), self.inertia_ratio)",
        "turntable_exactly",
    ),
    Mutant(
        "T11: friction one part in 10⁷ off",
        "solve.exact.sliding_sphere",
        "brake = number(form.friction) *",
        "brake = number(form.friction) * (1 + 1e-7) *",
        "billiard_exactly",
    ),
    Mutant(
        "a stop of a closed form 1 % late",
        "solve.closed_form",
        "reached = now.time + found[0]",
        "reached = now.time + 1.01 * found[0]",
        "billiard_exactly",
    ),
)

TAKEN = (*ORIENTATION, *GEOMETRY, *ON_LOADS, *CLOSED_FORMS)
