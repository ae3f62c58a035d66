"""Faults that no card can tell, with what solver and check share; docs/what-the-card-can-show.md lists them."""

from __future__ import annotations

from .planting import Mutant

LOADS = "mechanics.loads"
EGG = "egg_rolls"
BOWL = "egg_in_rocking_bowl"
LOADED = "egg_under_loads"
FREE = "egg_on_free_table"

_GIVEN = "A load is what its formula says, for solver and check alike."
_OTHER = "It is another system, and moves by the same law."

SHARED = (
    Mutant(
        "drag 1 % too strong",
        LOADS + ".air",
        "return through_air(motion, self.air) * -self.coefficient",
        "return through_air(motion, self.air) * (-1.01 * self.coefficient)",
        LOADED,
        _GIVEN,
    ),
    Mutant(
        "quadratic drag 1 % too strong",
        LOADS + ".air",
        "return v * (-self.coefficient * namespace(square).sqrt(square))",
        "return v * (-1.01 * self.coefficient * namespace(square).sqrt(square))",
        LOADED,
        _GIVEN,
    ),
    Mutant(
        "Magnus's force 1 % too strong",
        LOADS + ".air",
        "cross(motion.velocity) * self.coefficient",
        "cross(motion.velocity) * (1.01 * self.coefficient)",
        LOADED,
        _GIVEN,
    ),
    Mutant(
        "a torque 1 % too strong",
        LOADS + ".given",
        '"""Return K."""\n        return self.at(motion.time)',
        '"""Return K."""\n        return self.at(motion.time) * 1.01',
        LOADED,
        _GIVEN,
    ),
    Mutant(
        "a motor 1 % too strong",
        LOADS + ".inside",
        "motion.orientation.matrix() @ self.at(motion.time)",
        "motion.orientation.matrix() @ self.at(motion.time) * 1.01",
        LOADED,
        _GIVEN,
    ),
    Mutant(
        "rolling resistance 1 % too strong",
        LOADS + ".contact",
        "return over * (-self.offset /",
        "return over * (-1.01 * self.offset /",
        LOADED,
        _GIVEN,
    ),
    Mutant(
        "pivot friction 1 % too strong",
        LOADS + ".contact",
        "n * (-self.offset * spin /",
        "n * (-1.01 * self.offset * spin /",
        LOADED,
        _GIVEN,
    ),
    Mutant(
        "a viscous couple 1 % too strong",
        LOADS + ".contact",
        "return over * -self.coefficient - n",
        "return over * (-1.01 * self.coefficient) - n",
        LOADED,
        _GIVEN,
    ),
    Mutant(
        "an axle's bearing 1 % too strong",
        "mechanics.motions.free",
        "- self.bearing_drag * rate - dry",
        "- 1.01 * self.bearing_drag * rate - dry",
        FREE,
        _GIVEN,
    ),
    Mutant(
        "a body 1 % too hard to turn",
        "mechanics.bodies.inertia",
        "return RotatedTensor(Q, Matrix.diagonal(self.x, self.y, self.z)).dense",
        "return RotatedTensor(Q, Matrix.diagonal(self.x, self.y, self.z) * 1.01).dense",
        EGG,
        _OTHER,
    ),
    Mutant(
        "an ellipsoid 1 % too large",
        "mechanics.shapes.base",
        "return Q @ self.support_map(nu), RotatedTensor(Q, self.support_gradient(nu))",
        "return Q @ self.support_map(nu) * 1.01, RotatedTensor(Q, self.support_gradient(nu) * 1.01)",
        EGG,
        _OTHER,
    ),
    Mutant(
        "a table that rocks 1 % too far",
        "mechanics.motions.swinging",
        "swing(self.amplitude, self.rate, self.phase, time))\n\n\n@dataclass(frozen=True)\nclass Shake",
        "swing(1.01 * self.amplitude, self.rate, self.phase, time))\n\n\n@dataclass(frozen=True)\nclass Shake",
        BOWL,
        _OTHER,
    ),
)
