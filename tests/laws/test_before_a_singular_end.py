"""Runge-Kutta on the way to an instant at which the law is singular: a step across it tells nothing of that way."""

from __future__ import annotations

import numpy as np
import pytest

import trundle as tr
from trundle.verify.bounds import sizes_of

pytest.importorskip("heyoka")


@pytest.mark.parametrize("place", [(-0.0148747, -0.145295), (0.1, 0.12)])
@pytest.mark.parametrize("friction", [0.0, 0.1, 0.6])
@pytest.mark.parametrize("body", [tr.Body.ring(0.0422, 0.2), tr.Body.disc(0.05, 0.1)], ids=["ring", "disc"])
def test_the_last_steps_before_it_are_as_exact_as_taylors(
    body: tr.Body, friction: float, place: tuple[float, float]
) -> None:
    bowl = tr.RollingSystem(body, tr.Support(tr.Bowl(0.262, rim=0.186), friction=friction))
    start = bowl.place(place)
    ended = tr.simulate(bowl, start, 0.5, 0.5, method="runge-kutta")
    if not ended.events or ended.events[-1].kind != "curved":
        pytest.skip("nothing singular comes")
    end = ended.events[-1].time
    every = end / 997
    ours, theirs = (tr.simulate(bowl, start, 0.5, every, method=method) for method in ("runge-kutta", "taylor"))
    same = min(len(ours.data.time), len(theirs.data.time)) - 3  # at the very end all speeds are without bounds
    for field, size in sizes_of(bowl, theirs.samples.part(slice(0, same))).items():
        if field != "contact_force":
            apart = ours.data[field].values[:same] - theirs.data[field].values[:same]
            assert np.abs(apart).max() <= 1e-10 * size, field
    assert ours.card().passed, ours.card().failures


@pytest.mark.parametrize("samples", [100, 2001, 5003])
def test_taylors_steps_that_miss_it_by_a_rounding_lead_past_it_all_the_same(samples: int) -> None:
    """A disc that flies to where its nearest point has no direction: it depends on the samples how its steps fall."""
    inertia = [3.17217e-05, 2.43805e-05, 1.89112e-05]
    scenario = tr.Scenario.read(
        {
            "body": {"kind": "disc", "radius": 0.019609, "mass": 0.179261, "moments": inertia},
            "support": {
                "kind": "cylinder",
                "radius": 1.93328,
                "motion": {"kind": "precessing-tilt", "angle": 0.199194, "rate": -0.664707},
            },
            "loads": [
                {"kind": "pivot-friction", "offset": 3.9307e-05},
                {"kind": "force", "value": [-0.0125622, 0.136351, 0.0]},
            ],
            "start": {
                "position": [0.00698188, 0.176244],
                "velocity": [0.0, -0.17552, -1.12968],
                "spin": -0.609523,
                "height": 0.101534,
            },
            "run": {"duration": 2.0, "every": 2.0 / samples},
        }
    )
    ours, other = scenario.run("taylor"), scenario.run("runge-kutta")
    assert [event.kind for event in ours.events] == ["land", "lift"] * 3
    assert ours.samples.time[-1] == 2.0
    assert float(abs(ours.data.position - other.data.position).max()) <= 1e-9
    assert ours.card().passed, ours.card().failures


def test_a_closed_form_that_cannot_be_followed_is_no_failure_of_another_method() -> None:
    """A ball that goes round a narrow pipe at 28 m/s: 2400 rad/s about its axis, more than 10⁴ rad in all."""
    pipe = tr.RollingSystem(tr.Body.solid_sphere(0.0031391, 0.0459), tr.Support(tr.Cylinder(0.0150382)))
    ours = tr.simulate(pipe, pipe.place((0.0, 0.0), (28.5442, 0.0)), 4.4, 0.06)
    assert ours.card().passed, ours.card().failures
