"""What all tests share: how Hypothesis draws."""

from __future__ import annotations

import pytest
from hypothesis import settings

pytest.register_assert_rewrite("tests.contracts")

# The same examples on every machine and at every hour; `--hypothesis-profile=explore` looks for new ones.
settings.register_profile("trundle", deadline=None, derandomize=True, max_examples=40)
settings.register_profile("explore", deadline=None, derandomize=False, max_examples=400)
settings.load_profile("trundle")
