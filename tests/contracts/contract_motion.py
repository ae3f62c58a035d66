"""What every motion of a support must obey: inherit `MotionContract` and say the motion."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import mpmath
import numpy as np
from tests.precise import numbers, precisely, size_of, slope, vectors
from tests.tolerances import EXACT

from trundle.mechanics.algebra import E_Z, Matrix, Vector
from trundle.mechanics.motions import Motion


class MotionContract:
    """Set `motion`. Its rates are checked against difference quotients of its rotation and origin."""

    motion: Motion
    rate = 10.0  # of the fastest change, 1/s: sets the scale of rounding

    def times(self) -> list[Any]:
        return numbers("times", 6, 4.0)

    def _carried(self, own: Vector) -> Callable[[Any], Vector]:
        """Return where a point of the support's material is, as a function of time."""

        def place(t: Any) -> Vector:
            now = self.motion.at(t)
            return now.origin + now.rotation @ own

        return place

    @precisely
    def test_the_rotation_is_one(self) -> None:
        for t in self.times():
            R = self.motion.at(t).rotation
            assert size_of(R @ R.transpose - Matrix.identity()) <= EXACT(16, 1)
            assert abs(R.a.dot(R.b.cross(R.c)) - 1) <= EXACT(16, 1)

    @precisely
    def test_material_points_move_as_it_says(self) -> None:
        for t, own in zip(self.times(), vectors("own", 6), strict=True):
            place, now = self._carried(own), self.motion.at(t)
            velocity = slope(place, t)
            assert size_of(now.material_velocity(place(t)) - velocity) <= EXACT(64, self.rate)
            acceleration = slope(lambda t, place=place: slope(place, t), t)
            assert size_of(now.material_acceleration(place(t), velocity) - acceleration) <= EXACT(64, self.rate**2)

    @precisely
    def test_the_material_velocity_changes_as_it_says_along_a_moving_point(self) -> None:
        for t, start, rate in zip(self.times(), vectors("start", 6), vectors("rate", 6), strict=True):
            u_rate = slope(lambda h, t=t, p=start, r=rate: self.motion.at(t + h).material_velocity(p + r * h))
            assert size_of(self.motion.at(t).material_acceleration(start, rate) - u_rate) <= EXACT(64, self.rate**2)

    @precisely
    def test_it_says_truly_whether_it_turns_steadily_about_its_axis(self) -> None:
        rate = self.motion.steady_rate
        steady = []
        for t in self.times():
            now, angle = self.motion.at(t), t * (0 if rate is None else rate)
            c, s = mpmath.cos(angle), mpmath.sin(angle)
            turned = Matrix(Vector(c, -s, 0), Vector(s, c, 0), E_Z)
            on_axis = abs(now.origin.x) + abs(now.origin.y) + size_of(now.velocity)
            steady.append(size_of(now.rotation - turned) + on_axis <= EXACT(64, 1))
        assert all(steady) == (rate is not None)

    def test_whole_arrays_of_times_are_one_call(self) -> None:
        times = np.array([float(t) for t in self.times()])
        p = Vector(0.3, -0.2, 0.1)
        many = np.broadcast_to(self.motion.at(times).material_velocity(p).array(), (times.size, 3))
        for t, u in zip(times, many, strict=True):
            one = self.motion.at(float(t)).material_velocity(p)
            assert np.allclose(u, one.array(), rtol=0, atol=EXACT(16, self.rate))
