"""The adapters of engines that install in a minute: motion, a mesh, and derivatives; skipped where none can be made."""

from __future__ import annotations

import math

import pytest

from trundle.conformance import Case, cases, derivatives, engines
from trundle.conformance.case import Motion
from trundle.conformance.measuring import Errors, errors_of
from trundle.conformance.running import Adapter

CASES = {case.name: case for case in cases()}
SETTINGS = {  # of engines that are small: what makes each as good as it is
    "mujoco": "contacts as stiff as the step allows",
    "ode": "as shipped",
    "pybullet": "best",
    "rapier": "as shipped",
}


def errors(adapter: Adapter, case: Case, dt: float, setting: engines.Setting) -> Errors:
    answer = adapter.answer(case, dt, dict(setting.values))
    assert isinstance(answer.motion, Motion), answer.message
    return errors_of(case, case.exact(), answer.motion)


@pytest.mark.parametrize("name", SETTINGS)
def test_an_engine_and_its_adapter(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PIP_RETRIES", "1")
    monkeypatch.setenv("PIP_TIMEOUT", "15")
    engine = engines.engine(name)
    try:
        engine.install()
    except engines.CannotInstallError as error:
        pytest.skip(f"{engine.title} cannot be installed here: {error}")
    setting = next(each for each in engine.settings if each.name == SETTINGS[name])
    incline, bowl = CASES["incline"], CASES["bowl-mesh-coarse"]
    with engine.adapter(120.0) as adapter:
        # Each takes the new velocity for the whole step: it is ahead by dt v/2, which is dt/T of the path.
        assert errors(adapter, incline, 1e-3, setting).position == pytest.approx(1e-3 / incline.duration, rel=0.25)
        found = errors(adapter, bowl, 1e-4, setting)
        assert found.own < 0.2 * found.mesh
        inputs = incline.inputs()
        by_runs = derivatives.of_runs(adapter, incline, inputs, 1e-2, setting.values)
        own = derivatives.own(adapter, incline, inputs, 1e-2, {})
    assert all(each.outcome == "ok" and math.isfinite(each.error) for each in by_runs.values())
    if name == "pybullet":
        assert by_runs["differences of runs by 0.001"].error < 5e-3
    if name == "mujoco":
        assert own["mjd_transitionFD by 1e-06"].error < 1e-2
    else:
        assert [each.outcome for each in own.values()] == ["cannot"]
