"""`trundle export NAME FILE.xml` and its like, as a user types them."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree as ET

from .conftest import Command


def test_a_model_for_physics_engines(folder: Path, here: Command) -> None:
    done = here("export", "billiard-draw", "draw.sdf")
    assert done.status == 0
    assert "for you to tell the engine: velocity (0.3, 0, 0) m/s" in done.out
    assert ET.parse(folder / "draw.sdf").getroot().tag == "sdf"  # noqa: S314
    done = here("export", "ball-in-a-funnel", "funnel.xml")
    assert done.status == 2
    assert "support.kind" in done.err
    done = here("export", "roll-home-turned", "path.xml")
    assert done.status == 2
    assert "feels no forces" in done.err
    assert done.files == {"draw.sdf"}
