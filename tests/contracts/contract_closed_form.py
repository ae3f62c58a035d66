"""What every closed form must obey: inherit `ClosedFormContract`, say the form, systems inside and outside it."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import mpmath
import numpy as np
import pytest
from tests.precise import numbers, precisely, size_of, slope
from tests.tolerances import EXACT

from trundle.errors import OutOfDomainError
from trundle.mechanics.algebra import Matrix, Quaternion, Vector
from trundle.mechanics.loads import BodyMotion
from trundle.mechanics.system import RollingSystem, State
from trundle.simulation.simulate import simulate
from trundle.solve.exact import CLOSED_FORMS, closed_form

NAMES = ("position", "velocity", "angular_velocity", "contact_force")


class ClosedFormContract:
    """Set `form`, and write `cases` and `violations`. It is for spheres with the same inertia about every axis.

    A form for another body overrides `inertia` and `offset`.
    """

    form: Any
    span = 10.0  # s, over which the motion is looked at

    def cases(self) -> list[tuple[RollingSystem, State]]:
        """Return systems of the domain, each with a start."""
        raise NotImplementedError

    def violations(self) -> list[tuple[RollingSystem, State, str]]:
        """Return systems outside the domain, and a word that the refusal must name."""
        raise NotImplementedError

    def inertia(self, system: RollingSystem) -> Any:
        ratio, m, a = system.body.inertia_ratio, system.body.mass, system.body.shape.radius
        return mpmath.mpf(ratio) * m * a * a

    def offset(self, system: RollingSystem, at: Vector) -> Vector:  # noqa: ARG002  the same everywhere on a plane
        """Return ρ for the centre of mass at a place."""
        return Vector(mpmath.mpf(0), mpmath.mpf(0), -mpmath.mpf(system.body.shape.radius))

    def applied(self, system: RollingSystem, V: Vector) -> tuple[Vector, Vector]:
        """Return the applied force, gravity worked out here, and torque."""
        zero = Vector(mpmath.mpf(0), mpmath.mpf(0), mpmath.mpf(0))
        motion = BodyMotion(0.0, system.body.mass, zero, V, Quaternion(1.0, 0.0, 0.0, 0.0), zero)
        weight = mpmath.mpf(system.body.mass) * system.gravity
        tilt = mpmath.mpf(system.support.tilt)
        force, torque = Vector(weight * mpmath.sin(tilt), mpmath.mpf(0), -weight * mpmath.cos(tilt)), zero
        for load in system.loads:
            force, torque = force + load.force(motion), torque + load.torque(motion)
        return force, torque

    def test_it_says_where_it_comes_from_and_where_it_holds(self) -> None:
        assert self.form in CLOSED_FORMS
        assert all(len(text) > 1 for text in (self.form.name, self.form.equation, self.form.source, self.form.domain()))

    def test_it_begins_at_the_start(self) -> None:
        for system, start in self.cases():
            now = self.form.of(system, start).motion_at(0.0)
            for vector, wanted in zip(now, (start.position, start.velocity, start.angular_velocity), strict=False):
                assert np.allclose(vector.array(), wanted, rtol=EXACT(8, 1), atol=EXACT(8, np.abs(wanted).max()))

    @precisely
    def test_it_obeys_newton_euler_and_the_constraint(self) -> None:
        """Solve m V̇ = F + R, J Ω̇ = K + ρ×R, V̇ + Ω̇×ρ = u̇ − Ω×ρ̇ for V̇, Ω̇, R; compare with its slopes and force.

        ρ̇ and u̇ are difference quotients of ρ and of the material's velocity at the contact.
        """
        for system, start in self.cases():
            for t in numbers("instants", 3, self.span):
                self._obeys(system, start, abs(t))

    def _obeys(self, system: RollingSystem, start: State, t: Any) -> None:
        motion, I = self.form.of(system, start), self.inertia(system)
        m, support = mpmath.mpf(system.body.mass), system.support.motion

        def offset(t: Any) -> Vector:
            return self.offset(system, motion.motion_at(t)[0])

        def material_velocity(t: Any) -> Vector:
            own = (
                of_start + gone for of_start, gone in zip(start.support, motion.support_coordinates_at(t), strict=True)
            )
            return support.at(start.time + t, *own).material_velocity(motion.motion_at(t)[0] + offset(t))

        rho = offset(t)
        _, V, Omega, R = motion.motion_at(t)
        r_rate, V_rate, Omega_rate = (slope(lambda t, i=i: motion.motion_at(t)[i], t) for i in range(3))
        F, K = self.applied(system, V)
        a, turning, force = _solve(m, I, rho, F, K, slope(material_velocity, t) - Omega.cross(slope(offset, t)))
        speed = size_of(V) + size_of(Omega.cross(rho)) + size_of(motion.motion_at(0.0)[1])
        assert size_of(r_rate - V) <= EXACT(32, speed)
        assert size_of(V + Omega.cross(rho) - material_velocity(t)) <= EXACT(32, speed)
        push = size_of(F) + size_of(K) / rho.norm() + m * size_of(V_rate)
        assert size_of(V_rate - a) <= EXACT(32, push / m)
        assert size_of(Omega_rate - turning) <= EXACT(32, push * rho.norm() / I)
        assert size_of(R - force) <= EXACT(32, push)

    def test_it_repeats_after_its_period(self) -> None:
        finite = 0
        for system, start in self.cases():
            motion = self.form.of(system, start)
            assert motion.period > 0
            if np.isfinite(motion.period):
                finite += 1
                some = np.array([0.1, 0.6, 0.9]) * motion.period
                for now, later in zip(motion.motion_at(some), motion.motion_at(some + motion.period), strict=True):
                    size = float(np.abs(now.array()).max())
                    assert np.allclose(now.array(), later.array(), rtol=0, atol=EXACT(64, size))
        assert finite

    def test_the_turning_alone_is_that_of_the_motion(self) -> None:
        times = np.linspace(0.0, self.span, 7)
        for system, start in self.cases():
            motion = self.form.of(system, start)
            alone, whole = motion.angular_velocity_at(times).array(), motion.motion_at(times)[2].array()
            assert np.allclose(alone, whole, rtol=0, atol=EXACT(8, np.abs(whole).max()))

    def test_members_broadcast(self) -> None:
        # All cases as one call: parameters (n, 1) against times (m,).
        singles = [self.form.of(system, start) for system, start in self.cases()]
        stacked = self.form(**{f.name: _stack([getattr(one, f.name) for one in singles]) for f in fields(self.form)})
        times = np.linspace(0.0, self.span, 7)
        for vectors, name in zip(stacked.motion_at(times), NAMES, strict=True):
            all_ = np.broadcast_to(vectors.array(), (len(singles), times.size, 3))
            for one, of_all in zip(singles, all_, strict=True):
                alone = one.motion_at(times)[NAMES.index(name)].array()
                size = np.abs(of_all).max()
                assert np.allclose(of_all, alone, rtol=0, atol=EXACT(64, size)), name

    def test_it_refuses_by_name_what_lies_outside(self) -> None:
        assert self.violations()
        for system, start, word in self.violations():
            assert self.form.violations(system, start)
            with pytest.raises(OutOfDomainError, match=word):
                self.form.of(system, start)
            with pytest.raises(OutOfDomainError, match=word):
                simulate(system, start, duration=1.0, every=0.5, method="exact")
            assert closed_form(system, start) is None

    def test_it_is_found_for_what_lies_inside(self) -> None:
        for system, start in self.cases():
            assert not self.form.violations(system, start)
            r, _, _, R = self.form.of(system, start).motion_at(0.0)
            if R.dot(self.offset(system, r)) > 0:  # the support would have to pull: it lifts off
                assert not isinstance(closed_form(system, start), self.form)
            else:
                assert isinstance(closed_form(system, start), self.form)


def _stack(values: list[Any]) -> Any:
    if isinstance(values[0], tuple):
        return tuple(_stack(list(part)) for part in zip(*values, strict=True))
    return np.array([float(value) for value in values])[:, None]


def _solve(m: Any, I: Any, rho: Vector, F: Vector, K: Vector, constraint: Vector) -> tuple[Vector, Vector, Vector]:
    A, b = mpmath.zeros(9, 9), mpmath.matrix([*F, *K, *constraint])
    cross = Matrix(Vector(0, -rho.z, rho.y), Vector(rho.z, 0, -rho.x), Vector(-rho.y, rho.x, 0))
    for i, row in enumerate(cross.rows):
        A[i, i], A[i, 6 + i] = m, -1
        A[3 + i, 3 + i] = I
        A[6 + i, i] = 1
        for j, entry in enumerate(row):
            A[3 + i, 6 + j], A[6 + i, 3 + j] = -entry, -entry
    x = mpmath.lu_solve(A, b)
    return Vector(*x[0:3]), Vector(*x[3:6]), Vector(*x[6:9])
