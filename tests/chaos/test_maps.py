"""Maps over starts against what is known of them by formula."""

from __future__ import annotations

import math

import numpy as np
import pytest

import trundle as tr

BALL = tr.Body.solid_sphere(0.01, 0.05)


def test_a_ball_on_top_of_a_dome_parts_from_its_neighbours_at_the_rate_of_the_formula():
    """The difference that grows most is C e^(λT), but for what dies away as e^(−2λT)."""
    dome = tr.RollingSystem(BALL, tr.Support(tr.Dome(0.2, rim=0.15)))

    def place(x: float) -> tr.State:
        return dome.place(position=(x, 0.0))

    first = tr.lyapunov_map(dome, {"x": [0.0]}, place, "1.5 s")
    found = tr.lyapunov_map(dome, {"x": [0.0, 0.1]}, place, "2.5 s")
    values = found.data.exponent.values
    rate = 2.5 * values[0] - 1.5 * first.data.exponent.values[0]
    assert math.isclose(rate, math.sqrt(9.80665 / (1.4 * 0.21)), rel_tol=1e-5)
    assert math.isnan(values[1])
    assert "rim" in str(found.data.reason.values[1])
    assert found.plot().axes


def test_a_free_roll_on_a_plane_parts_by_a_power_of_the_time_only():
    plane = tr.RollingSystem(BALL, tr.Support(tr.Plane()))

    def place(v: float) -> tr.State:
        return plane.place(velocity=(v, 0.0))

    short, long = (tr.lyapunov_map(plane, {"v": [-0.2, 0.0]}, place, time) for time in ("5 s", "50 s"))
    assert (long.data.exponent.values < 0.3 * short.data.exponent.values).all()


def test_basins_of_two_hollows_are_the_mirror_images_of_each_other():
    hollows = tr.HeightField("2*(x**2 - 0.04)**2/0.04 + y**2")
    system = tr.RollingSystem(BALL, tr.Support(hollows), loads=[tr.Drag(0.2)])
    grid = {"x": np.array([-0.31, -0.27, -0.1, 0.1, 0.27, 0.31]), "y": np.array([-0.05, 0.05])}
    found = tr.basins_of_attraction(system, grid, lambda x, y: system.place(position=(x, y)), "8 s")
    basin = found.data.basin.values
    assert len(found.classes) == 2
    assert (basin == 1 - basin[::-1]).all()
    assert found.shares == {found.classes[0]: 0.5, found.classes[1]: 0.5}
    assert basin[2, 0] != basin[3, 0]
    assert found.plot().axes


def test_what_ends_early_is_a_class_of_its_own_and_so_is_what_you_name():
    plane = tr.RollingSystem(BALL, tr.Support(tr.Plane(rim=0.2)))

    def place(v: float) -> tr.State:
        return plane.place(velocity=(v, 0.0))

    found = tr.basins_of_attraction(plane, {"v": [0.0, 0.5]}, place, "2 s")
    assert found.classes[1] == "rim"
    named = tr.basins_of_attraction(plane, {"v": [0.0, 0.5]}, place, "2 s", kind=lambda run: str(bool(run.events)))
    assert named.classes == ("False", "True")


@pytest.mark.parametrize("over", [{}, {"a": [1.0], "b": [1.0], "c": [1.0]}, {"x": []}, {"x": [math.nan]}])
def test_what_is_no_grid_is_refused(over):
    plane = tr.RollingSystem(BALL, tr.Support(tr.Plane()))
    with pytest.raises(tr.InvalidValueError, match="over"):
        tr.lyapunov_map(plane, over, lambda **_: plane.place(), "1 s")
