"""What every load must obey: inherit `LoadContract` and say the load."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import mpmath
from tests.precise import numbers, precisely, quaternions, size_of, slope, turn, vectors
from tests.tolerances import EXACT

from trundle.mechanics.algebra import E_X, E_Y, E_Z, Matrix, Quaternion, Vector
from trundle.mechanics.loads import BodyMotion, Load


class LoadContract:
    """Set `load`, and `size`, that of its force and torque where nothing is larger than 1 in SI units."""

    load: Load
    size = 10.0  # N, N m

    def motions(self) -> list[BodyMotion]:
        return [
            BodyMotion(t, m, r, V, q, Omega)
            for t, m, r, V, q, Omega in zip(
                numbers("t", 6),
                [mpmath.mpf("0.75")] * 6,
                vectors("r", 6),
                vectors("V", 6),
                quaternions("q", 6),
                vectors("Omega", 6),
                strict=True,
            )
        ]

    @precisely
    def test_the_force_is_the_slope_of_the_potential(self) -> None:
        for motion in self.motions():
            if self.load.potential(motion) is None:
                return
            force = self.load.force(motion)
            for e, component in zip((E_X, E_Y, E_Z), force, strict=True):

                def at(h: Any, motion: BodyMotion = motion, e: Vector = e) -> Any:
                    return self.load.potential(replace(motion, position=motion.position + e * h))

                assert abs(slope(at) + component) <= EXACT(16, self.size)

    @precisely
    def test_the_torque_is_the_slope_of_the_potential(self) -> None:
        for motion in self.motions():
            if self.load.potential(motion) is None:
                return
            torque = self.load.torque(motion)
            for e, component in zip((E_X, E_Y, E_Z), torque, strict=True):

                def at(h: Any, motion: BodyMotion = motion, e: Vector = e) -> Any:
                    return self.load.potential(replace(motion, orientation=turn(e * h) * motion.orientation))

                assert abs(slope(at) + component) <= EXACT(16, self.size)

    @precisely
    def test_a_potential_does_not_depend_on_velocities(self) -> None:
        for motion in self.motions():
            still = replace(motion, velocity=Vector(0, 0, 0), angular_velocity=Vector(0, 0, 0))
            assert self.load.potential(still) == self.load.potential(motion)

    @precisely
    def test_it_says_truly_whether_it_is_constant(self) -> None:
        first, *others = [(self.load.force(m), self.load.torque(m)) for m in self.motions()]
        same = all(size_of(F - first[0]) + size_of(K - first[1]) == 0 for F, K in others)
        assert same == self.load.constant

    @precisely
    def test_it_says_truly_whether_it_is_linear_drag(self) -> None:
        c = self.load.linear_drag
        if c is not None:
            for motion in self.motions():
                assert size_of(self.load.force(motion) + motion.velocity * c) <= EXACT(16, self.size)
                assert size_of(self.load.torque(motion)) == 0

    @precisely
    def test_it_says_truly_whether_it_looks_the_same_from_all_sides(self) -> None:
        same = []
        for motion, angle in zip(self.motions(), numbers("around", 6, 3.0), strict=True):
            about, turned = turn(E_Z * angle), _turned(motion, angle)
            R = about.matrix()
            F, K = R @ self.load.force(motion), R @ self.load.torque(motion)
            off = size_of(self.load.force(turned) - F) + size_of(self.load.torque(turned) - K)
            if self.load.potential(motion) is not None:
                off += abs(self.load.potential(turned) - self.load.potential(motion))
            same.append(off <= EXACT(16, self.size))
        assert all(same) == self.load.symmetric


def _turned(motion: BodyMotion, angle: Any) -> BodyMotion:
    about: Quaternion = turn(E_Z * angle)
    R: Matrix = about.matrix()
    return replace(
        motion,
        position=R @ motion.position,
        velocity=R @ motion.velocity,
        angular_velocity=R @ motion.angular_velocity,
        orientation=about * motion.orientation,
    )
