"""Fixtures for the tests of an engine: `pytest_plugins = ["trundle.conformance.fixtures"]` in its conftest.py."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from typing import Any

import pytest

from .answers import CANNOT, OK, read_answer
from .case import Case, cases
from .measuring import Errors, errors_of


@pytest.fixture(params=cases(), ids=lambda case: case.name)
def rolling_case(request: pytest.FixtureRequest) -> Case:
    """Each motion that is known exactly, one after the other."""
    case: Case = request.param
    return case


@pytest.fixture
def rolling_errors(rolling_case: Case) -> Callable[[Mapping[str, Any]], Errors]:
    """Return what measures an answer to the task of `rolling_case`; it skips what cannot be, and fails what is bad."""

    def measured(answer: Mapping[str, Any]) -> Errors:
        found = read_answer(json.dumps({"task": 0, **answer}), rolling_case, int(answer.get("task", 0)))
        if found.outcome == CANNOT:
            pytest.skip(found.message)
        if found.outcome != OK or found.motion is None:
            pytest.fail(f"{found.outcome}: {found.message}")
        return errors_of(rolling_case, rolling_case.exact(), found.motion)

    return measured
