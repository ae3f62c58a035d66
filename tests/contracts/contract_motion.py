"""What every motion of a support must obey: inherit `MotionContract` and say the motion."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import mpmath
import numpy as np
from tests.precise import numbers, precisely, size_of, slope, vectors
from tests.tolerances import EXACT

from trundle.mechanics.algebra import E_Z, Matrix, Vector
from trundle.mechanics.motions import Motion, SupportState


class MotionContract:
    """Set `motion`. Its rates are checked against difference quotients of its rotation and origin.

    A motion with coordinates of its own needs `support_coordinates_at`, which says what they are at a time by another
    way than by integrating `coordinate_rates`; a free axle's are those of ω̇ = 0.
    """

    motion: Motion
    rate = 10.0  # of the fastest change, 1/s: sets the scale of rounding

    def times(self) -> list[Any]:
        return numbers("times", 6, 4.0)

    def support_coordinates_at(self, t: Any) -> tuple[Any, ...]:  # noqa: ARG002
        return ()

    def at(self, t: Any) -> SupportState:
        return self.motion.at(t, *self.support_coordinates_at(t))

    def _carried(self, own: Vector) -> Callable[[Any], Vector]:
        """Return where a point of the support's material is, as a function of time."""

        def place(t: Any) -> Vector:
            now = self.at(t)
            return now.origin + now.rotation @ own

        return place

    @precisely
    def test_the_rotation_is_one(self) -> None:
        for t in self.times():
            R = self.at(t).rotation
            assert size_of(R @ R.transpose - Matrix.identity()) <= EXACT(16, 1)
            assert abs(R.a.dot(R.b.cross(R.c)) - 1) <= EXACT(16, 1)

    def test_its_word_about_the_axis_is_true(self) -> None:
        if self.motion.keeps_axis is None:
            return
        for t in self.times():
            now = self.at(t)
            turning = (now.angular_velocity, now.angular_acceleration)
            leans = now.rotation @ E_Z != E_Z or any(part != 0 for rate in turning for part in (rate.x, rate.y))
            assert leans is not self.motion.keeps_axis

    @precisely
    def test_material_points_move_as_it_says(self) -> None:
        for t, own in zip(self.times(), vectors("own", 6), strict=True):
            place, now = self._carried(own), self.at(t)
            velocity = slope(place, t)
            assert size_of(now.material_velocity(place(t)) - velocity) <= EXACT(64, self.rate)
            acceleration = slope(lambda t, place=place: slope(place, t), t)
            assert size_of(now.material_acceleration(place(t), velocity) - acceleration) <= EXACT(64, self.rate**2)

    @precisely
    def test_the_material_velocity_changes_as_it_says_along_a_moving_point(self) -> None:
        for t, start, rate in zip(self.times(), vectors("start", 6), vectors("rate", 6), strict=True):
            u_rate = slope(lambda h, t=t, p=start, r=rate: self.at(t + h).material_velocity(p + r * h))
            assert size_of(self.at(t).material_acceleration(start, rate) - u_rate) <= EXACT(64, self.rate**2)

    @precisely
    def test_it_says_truly_whether_it_turns_steadily_about_its_axis(self) -> None:
        rate = self.motion.steady_rate
        steady = []
        for t in self.times():
            now, angle = self.at(t), t * (0 if rate is None else rate)
            c, s = mpmath.cos(angle), mpmath.sin(angle)
            turned = Matrix(Vector(c, -s, 0), Vector(s, c, 0), E_Z)
            on_axis = abs(now.origin.x) + abs(now.origin.y) + size_of(now.velocity)
            steady.append(size_of(now.rotation - turned) + on_axis <= EXACT(64, 1))
        assert all(steady) == (rate is not None)

    @precisely
    def test_its_own_coordinates_change_as_it_says(self) -> None:
        assert (
            len(self.motion.coordinates) == len(set(self.motion.coordinates)) == len(self.motion.initial_coordinates())
        )
        for t in self.times():
            own = self.support_coordinates_at(t)
            moment = -self.motion.axle_torque(t, own) if self.motion.free else numbers("moment", 1)[0]
            rates = self.motion.coordinate_rates(t, own, moment)
            for i, rate in enumerate(rates):
                assert abs(rate - slope(lambda t, i=i: self.support_coordinates_at(t)[i], t)) <= EXACT(64, self.rate)
            assert len(rates) == len(own)
        for start, at_start in zip(
            self.motion.initial_coordinates(), self.support_coordinates_at(mpmath.mpf(0)), strict=True
        ):
            assert abs(start - at_start) <= EXACT(4, 1 + abs(start))

    @precisely
    def test_it_says_truly_whether_it_turns(self) -> None:
        turning = [size_of(self.at(t).rotation - Matrix.identity()) for t in self.times()]
        assert (max(turning) > 0) == self.motion.turns

    def test_its_rates_are_numbers(self) -> None:
        assert self.motion.fastest_rate >= 0
        assert self.motion.fastest_rate_within(0.0, 4.0) >= 0
        assert math.isfinite(float(self.motion.mean_rate))

    def test_it_runs_on_symbols(self) -> None:
        import heyoka

        names = ("t", *self.motion.coordinates)
        symbols = [heyoka.expression(name) for name in names]
        there = self.motion.at(*symbols).material_acceleration(Vector(0.3, -0.2, 0.1), Vector(0.1, 0.2, 0.3))
        compiled = heyoka.cfunc([part + 0.0 * symbols[0] for part in there], symbols)
        for t in map(float, self.times()):
            values = [t, *map(float, self.support_coordinates_at(mpmath.mpf(t)))]
            one = self.motion.at(*values).material_acceleration(Vector(0.3, -0.2, 0.1), Vector(0.1, 0.2, 0.3))
            assert np.allclose(compiled(values), list(one), rtol=0, atol=EXACT(256, self.rate**2))

    def test_whole_arrays_of_times_are_one_call(self) -> None:
        times = np.array([float(t) for t in self.times()])
        own = [
            np.array([float(self.support_coordinates_at(t)[i]) for t in self.times()])
            for i in range(len(self.motion.coordinates))
        ]
        p = Vector(0.3, -0.2, 0.1)
        many = np.broadcast_to(self.motion.at(times, *own).material_velocity(p).array(), (times.size, 3))
        for i, (t, u) in enumerate(zip(times, many, strict=True)):
            one = self.motion.at(float(t), *(float(values[i]) for values in own)).material_velocity(p)
            assert np.allclose(u, one.array(), rtol=0, atol=EXACT(16, self.rate))
