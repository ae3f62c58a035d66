"""What all tests share: how Hypothesis draws, who gets a second try, and a way through second walls."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import settings

pytest.register_assert_rewrite("tests.contracts")

# The same examples on every machine and at every hour; `--hypothesis-profile=explore` looks for new ones.
settings.register_profile("trundle", deadline=None, derandomize=True, max_examples=40)
settings.register_profile("explore", deadline=None, derandomize=False, max_examples=400)
settings.load_profile("trundle")

_BROWSER = Path(__file__).parent / "browser"


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Give tests of a browser and of a served process a second try; the summary says which took it.

    They wait on the clock of a machine that others may use. All others must hold the first time.
    """
    for item in items:
        if item.path.is_relative_to(_BROWSER) or item.path.name.startswith("test_server"):
            item.add_marker(pytest.mark.flaky(reruns=1))


@pytest.fixture
def through_walls(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let bodies go through second walls: most come to one before the support is as hollow as they are round."""
    from trundle.solve.walls import UpToWall

    monkeypatch.setattr(UpToWall, "runs_into", lambda _, at: np.zeros(at.time.size, dtype=bool))
