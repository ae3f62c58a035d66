"""The curve of a request to roll a ball along, as the tables of a scenario file."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..errors import ScenarioError
from ..scenario.validation_errors import quoted


def path_of(radius: Any, curve: Mapping[str, Any]) -> dict[str, Any]:
    """Return a ball and a curve as the tables of a scenario file.

    Examples
    --------
    >>> path_of("25 mm", {"kind": "straight", "turn": "90 deg"})["path"]
    [{'kind': 'straight', 'turn': '90 deg'}]
    """
    if "kind" in curve:
        return {"title": "A ball rolled along a curve", "body": {"radius": radius}, "path": [dict(curve)]}
    known = ("path", "start", "title", "group", "notes")
    for key in curve:
        if key not in known:
            path = f"curve.{quoted(key)}"
            raise ScenarioError(path, "is no key of a curve", curve[key], f"There are: {', '.join(known)}.")
    if "path" not in curve:
        remedy = 'Give pieces, for instance [{"kind": "straight", "turn": "90 deg"}].'
        raise ScenarioError("curve.path", "must be given", "nothing", remedy)
    return {"title": "A ball rolled along a path", **curve, "body": {"radius": radius}}
