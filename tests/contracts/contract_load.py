"""What every load must obey: inherit `LoadContract` and say the load."""

from __future__ import annotations

import math
from dataclasses import fields, replace
from typing import Any

import mpmath
import numpy as np
from tests.precise import directions, floats, numbers, precisely, quaternions, size_of, slope, turn, vectors
from tests.tolerances import EXACT

from trundle.mechanics.algebra import E_X, E_Y, E_Z, Matrix, Quaternion, Vector
from trundle.mechanics.loads import BodyMotion, Load, at_rest
from trundle.mechanics.parameters import numbers as numbers_in
from trundle.mechanics.parameters import with_numbers


class LoadContract:
    """Set `load`, and `size`, that of its force and torque where nothing is larger than 1 in SI units."""

    load: Load
    size = 10.0  # N, N m

    def motions(self) -> list[BodyMotion]:
        return [
            BodyMotion(t, m, r, V, q, Omega, n, omega)
            for t, m, r, V, q, Omega, n, omega in zip(
                numbers("t", 6),
                [mpmath.mpf("0.75")] * 6,
                vectors("r", 6),
                vectors("V", 6),
                quaternions("q", 6),
                vectors("Omega", 6),
                directions("n", 6),
                vectors("omega", 6),
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
        couple = any(size_of(self.load.torque_per_normal_force(m)) > 0 for m in self.motions())
        assert (same and not couple) == self.load.constant

    @precisely
    def test_it_says_truly_whether_it_is_linear_drag(self) -> None:
        c = self.load.linear_drag
        if c is not None:
            for motion in self.motions():
                assert size_of(self.load.force(motion) + motion.velocity * c) <= EXACT(16, self.size)
                assert size_of(self.load.torque(motion)) == 0
                assert size_of(self.load.torque_per_normal_force(motion)) == 0

    @precisely
    def test_it_says_truly_whether_it_looks_the_same_from_all_sides(self) -> None:
        same = []
        for motion, angle in zip(self.motions(), numbers("around", 6, 3.0), strict=True):
            about, turned = turn(E_Z * angle), _turned(motion, angle)
            R = about.matrix()
            F, K = R @ self.load.force(motion), R @ self.load.torque(motion)
            off = size_of(self.load.force(turned) - F) + size_of(self.load.torque(turned) - K)
            couple = R @ self.load.torque_per_normal_force(motion)
            off += size_of(self.load.torque_per_normal_force(turned) - couple)
            if self.load.potential(motion) is not None:
                off += abs(self.load.potential(turned) - self.load.potential(motion))
            same.append(off <= EXACT(16, self.size))
        assert all(same) == self.load.symmetric

    @precisely
    def test_it_says_truly_whether_it_leaves_the_spin(self) -> None:
        along = [abs(self.load.torque(m).z) + abs(self.load.torque_per_normal_force(m).z) for m in self.motions()]
        assert (max(along) == 0) == self.load.leaves_spin

    @precisely
    def test_what_the_support_exerts_brakes_the_turning_over_it_and_ends_in_flight(self) -> None:
        for motion in self.motions():
            couple = self.load.torque_per_normal_force(motion)
            if not self.load.at_contact:
                assert size_of(couple) == 0
                continue
            over = motion.angular_velocity - motion.support_angular_velocity
            assert over.dot(couple) + over.dot(self.load.torque(motion)) < 0
            flying = replace(motion, normal=None)
            assert size_of(self.load.torque(flying)) == size_of(self.load.torque_per_normal_force(flying)) == 0
            assert self.load.potential(motion) is None

    def test_at_rest_it_is_finite_and_has_slopes(self) -> None:
        # As floats, and as heyoka's Taylor integrator meets it, from the first step on.
        still = replace(at_rest(0.75), position=Vector(0.1, -0.2, 0.05), normal=E_Z)
        for part in (*self.load.force(still), *self.load.torque(still), *self.load.torque_per_normal_force(still)):
            assert math.isfinite(part)
        if not self.load.stops:  # that one has no direction at rest: the run does not go on with it
            assert all(math.isfinite(float(part)) for part in _pushed_from_rest(self.load))

    def test_whole_arrays_are_one_call(self) -> None:
        motions = [_in_floats(motion) for motion in self.motions()]
        many = _in_arrays(motions)
        for act in (self.load.force, self.load.torque, self.load.torque_per_normal_force):
            found = np.broadcast_to(act(many).array(), (len(motions), 3))
            for row, motion in zip(found, motions, strict=True):
                assert np.allclose(row, list(act(motion)), rtol=0, atol=EXACT(16, self.size))

    def test_its_numbers_are_parameters(self) -> None:
        values = numbers_in(self.load)
        assert numbers_in(with_numbers(self.load, [2 * value for value in values])) == [2 * value for value in values]


def _pushed_from_rest(load: Load) -> Any:
    """Integrate velocity and turning from rest under the load alone, and return them after a short time."""
    import heyoka

    names = ("x", "y", "z", "u", "v", "w", "p", "q", "r")
    x, y, z, u, v, w, p, q, r = heyoka.make_vars(*names)
    motion = BodyMotion(
        heyoka.time, 0.75, Vector(x, y, z), Vector(u, v, w), Quaternion(1.0, 0.0, 0.0, 0.0), Vector(p, q, r), E_Z
    )
    couple = load.torque_per_normal_force(motion)
    rates = [u, v, w, *load.force(motion), *(load.torque(motion) + couple)]
    system = [(heyoka.expression(name), rate + 0.0 * x) for name, rate in zip(names, rates, strict=True)]
    integrator = heyoka.taylor_adaptive(system, [0.1, -0.2, 0.05] + [0.0] * 6, compact_mode=True)
    integrator.propagate_until(0.125)
    return integrator.state


def _in_floats(motion: BodyMotion) -> BodyMotion:
    changed = {
        field.name: float(part) if isinstance(part := getattr(motion, field.name), mpmath.mpf) else floats(part)
        for field in fields(motion)
    }
    return BodyMotion(**changed)


def _in_arrays(motions: list[BodyMotion]) -> BodyMotion:
    def column(parts: list[Any]) -> Any:
        if isinstance(parts[0], float):
            return np.array(parts)
        return type(parts[0])(*(np.array(column) for column in zip(*parts, strict=True)))

    return BodyMotion(**{field.name: column([getattr(m, field.name) for m in motions]) for field in fields(motions[0])})


def _turned(motion: BodyMotion, angle: Any) -> BodyMotion:
    about: Quaternion = turn(E_Z * angle)
    R: Matrix = about.matrix()
    return replace(
        motion,
        position=R @ motion.position,
        velocity=R @ motion.velocity,
        angular_velocity=R @ motion.angular_velocity,
        orientation=about * motion.orientation,
        normal=None if motion.normal is None else R @ motion.normal,
        support_angular_velocity=R @ motion.support_angular_velocity,
    )
