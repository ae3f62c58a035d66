"""Whatever is sent, the answer is never a mistake of ours: inputs that nobody thought of."""

from __future__ import annotations

import copy
import http.client
import json
import threading
import time
from collections.abc import Iterator
from typing import Any

import pytest
import schemathesis
import uvicorn
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from schemathesis.checks import not_a_server_error
from schemathesis.specs.openapi.checks import (
    content_type_conformance,
    response_schema_conformance,
    status_code_conformance,
)
from tests.lab.conftest import shipped

from trundle.lab import Settings, create_app
from trundle.lab.serving import listen

FEW = settings(max_examples=10, deadline=None, suppress_health_check=list(HealthCheck))
CHECKS = [not_a_server_error, status_code_conformance, content_type_conformance, response_schema_conformance]
SCHEMA = schemathesis.openapi.from_dict(create_app().openapi())


@pytest.fixture(scope="module")
def served() -> Iterator[tuple[str, int]]:
    """A real server on a free port."""
    with listen("127.0.0.1", 0) as taken:
        app = create_app(Settings(workers=2, slow_workers=1, wall_time=60.0))
        server = uvicorn.Server(uvicorn.Config(app, log_level="error", access_log=False))
        thread = threading.Thread(target=server.run, kwargs={"sockets": [taken]})
        thread.start()
        while not server.started:
            time.sleep(0.02)
        yield taken.getsockname()[:2]
        server.should_exit = True
        thread.join(20)


@SCHEMA.parametrize()
@FEW
def test_no_request_brings_an_answer_that_the_schema_does_not_tell_of(
    case: schemathesis.Case, served: tuple[str, int]
) -> None:
    host, port = served
    case.call_and_validate(base_url=f"http://{host}:{port}", checks=CHECKS, timeout=90)


# --- scenarios that are almost right ------------------------------------------------------------------------------

NAMES = (
    "tilted-turntable",
    "billiard-draw",
    "ball-in-a-trough",
    "rattleback",
    "coin-in-a-circle",
    "free-turntable-ellipse",
)
STRANGE = st.one_of(
    st.sampled_from(
        [None, True, [], {}, "", "0", 0, -1, "-1 m", "1e-300 m", 1e300, 1e-29, "1e30 m", "90 deg", "89.9999 deg"]
    ),
    st.sampled_from(
        ["nan", "inf kg", "9" * 190, "1 m/s^2^2", "sin(t)", "t**20", "1/t", "sqrt(-t)", "exp(t*1e3)", "log(t)"]
    ),
    st.floats(),
    st.text(max_size=8),
    st.lists(st.floats(-10, 10), min_size=1, max_size=4),
)


def places(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """The path of every part of some tables."""
    for key, part in value.items() if isinstance(value, dict) else enumerate(value):
        if key != "notes":
            yield (*path, key)
        if isinstance(part, dict | list):
            yield from places(part, (*path, key))


@st.composite
def almost(draw: st.DrawFn) -> dict[str, Any]:
    """A shipped scenario, short, with one or two of its parts replaced."""
    tables = copy.deepcopy(shipped(draw(st.sampled_from(NAMES))))
    tables["run"] |= {"duration": "0.2 s", "every": "10 ms"}
    for _ in range(draw(st.integers(1, 2))):
        *above, last = draw(st.sampled_from(list(places(tables))))
        part = tables
        for key in above:
            part = part[key]
        part[last] = draw(STRANGE)
        if not all(isinstance(tables[key], dict) for key in ("body", "support", "start", "run")):
            break
    return tables


@given(scenario=almost(), route=st.sampled_from(["simulate", "twin", "derivation", "simulate", "simulate"]))
@settings(max_examples=120, deadline=None, suppress_health_check=list(HealthCheck))
def test_a_scenario_that_is_almost_right_is_run_or_refused(
    served: tuple[str, int], scenario: dict[str, Any], route: str
) -> None:
    connection = http.client.HTTPConnection(*served, timeout=60)
    try:
        body = json.dumps({"scenario": scenario})
        connection.request("POST", f"/api/{route}", body, {"content-type": "application/json"})
        answer = connection.getresponse()
        content = answer.read()
    finally:
        connection.close()
    assert answer.status in (200, 422), content[:1000]
    if answer.status == 422:
        assert json.loads(content)["error"]["message"]
