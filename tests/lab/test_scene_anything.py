"""Whatever can be simulated can be shown: bodies, supports, motions and loads drawn at random."""

import numpy as np
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from tests.draws import anything, imperfect, rollers, runs

import trundle as tr
from trundle.views.scene import pack, scene_of, unpack


@settings(max_examples=25, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.one_of(runs(), rollers(), imperfect()))
def test_spheres_and_rollers(case):
    check(*case)


@settings(max_examples=12, deadline=None, suppress_health_check=list(HealthCheck))
@given(anything())
def test_everything_combined(case):
    system, placed = case
    try:
        start = system.place(**placed)
    except tr.TrundleError:
        assume(False)
    check(system, start)


def check(system, start):
    try:
        run = tr.simulate(system, start, duration=0.03, every=0.01, method="runge-kutta")
    except tr.TrundleError:
        assume(False)
    scene = scene_of(run)
    again = unpack(pack(scene))
    for name, column in again.columns.items():
        assert np.isfinite(column).all(), name
    assert again.columns["support_triangles"].size
    assert again.columns["body_triangles"].size
    assert again.header["support"]["size"] > 0
    assert again.header["body"]["radius"] > 0
    for row in again.header["findings"]:
        assert row["name"]
