"""What the tests of the lab's server share: one server for all of them, and its answers taken apart."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

# It would be imported, and rewritten by pytest, when the first file is served: beside a thread that parses formulas,
# which Python before 3.11.9 answers with a SystemError at times (its issue gh-106905).
from anyio import open_file  # noqa: F401
from starlette.testclient import TestClient

from trundle.lab import Settings, create_app
from trundle.scenario import files


@pytest.fixture(scope="session")
def lab() -> Iterator[TestClient]:
    """A client of a running lab; nothing that the server raises is hidden by an answer."""
    with TestClient(create_app(Settings(workers=2, slow_workers=1)), base_url="http://127.0.0.1") as client:
        yield client


def shipped(name: str) -> dict[str, Any]:
    """The tables of a scenario that ships with the package, as JSON has them."""
    return files.parse(files.read(name), name)
