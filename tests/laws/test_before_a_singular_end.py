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
