"""Tracker's own file, .trk, and the same in an archive with its film, .trz."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ...errors import InvalidValueError
from ...extras import need
from ..file import File
from ..options import Options
from ..table import Column, Rejected, Table
from .base import Format

_PANEL, _MASS = "TrackerPanel", "PointMass"
_RULERS = ("TapeMeasure", "CalibrationStick", "Calibration", "OffsetOrigin")
_FARTHEST = 10**7  # frames of a film


class TrackerProject(Format):
    """Points in pixels by frames, with the axes, the scale and the clock that turn them into metres and seconds."""

    name = "Tracker's own file"
    origin = "Tracker: File > Save As (.trk), or File > Export > TrackerZip (.trz)"
    endings = (".trk", ".trz")

    def recognises(self, file: File) -> bool:
        """Tell by the class of the outermost object, or by the archive."""
        return file.is_archive or _PANEL.encode() in file.content or b"<" in file.content[:200]

    def read(self, file: File, options: Options) -> Sequence[Table]:
        """Return each point mass."""
        need("fit", file.path.name, "Export the data from Tracker as text, which needs nothing more.")
        projects = dict(file.members(".trk")) if file.is_archive else {"": file.content}
        if not projects:
            raise InvalidValueError("file", "must hold a .trk file", file.path.name, "There is none in this archive.")
        found = [(name, table) for name, content in projects.items() for table in _tracks(content, options)]
        if not found:
            rule = "must hold a point mass with positions"
            raise InvalidValueError("file", rule, file.path.name, "Track a point in Tracker, and save again.")
        if len(projects) == 1:
            return [table for _, table in found]
        return [replace(table, name=f"{name.removesuffix('.trk')}/{table.name}") for name, table in found]


def _tracks(content: bytes, options: Options) -> Iterator[Table]:
    from defusedxml import DefusedXmlException
    from defusedxml.ElementTree import fromstring

    try:
        panel = _read(fromstring(content, forbid_dtd=True))
    except DefusedXmlException:
        rule = "must hold neither a document type nor entities"
        raise InvalidValueError(
            "file", rule, "such a one", "Tracker writes none: was the file made to do harm?"
        ) from None
    if not isinstance(panel, Mapping) or not _class(panel).endswith(_PANEL):
        rule = "must be a project of Tracker's"
        raise InvalidValueError("file", rule, "another kind of XML", "Save the tab with its tracks as .trk.")
    clip, clock = _object(panel, "videoclip"), _object(panel, "clipcontrol")
    coords = _object(panel, "coords")
    if coords and not _class(coords).endswith("ImageCoordSystem"):
        remedy = "Choose Coordinate System > Image as the reference frame, or export the data."
        raise InvalidValueError("coords", "must be fixed axes", _class(coords).rpartition(".")[2], remedy)
    things = [thing for thing in _items(panel.get("tracks")) if isinstance(thing, Mapping)]
    calibrated = any(_class(thing).endswith(_RULERS) for thing in things)
    axes = _Axes(coords, options, calibrated=calibrated)
    for thing in things:
        if _class(thing).endswith(f".{_MASS}") and _object(thing, "framedata"):
            yield _track(thing, clip, _clock(clip, clock, options), axes, str(panel.get("length_unit", "")))


def _clock(clip: Mapping[str, Any], clock: Mapping[str, Any], options: Options) -> float:
    """Return the time from frame to frame, s."""
    if options.rate is not None:
        return 1 / options.rate
    step = clock.get("delta_t", _object(clip, "video").get("delta_t"))
    if step is None:
        rule = "must be said where the file does not say how long a frame takes"
        raise InvalidValueError("rate", rule, "no `delta_t`", "Give the frames a second: --rate 60.")
    return _positive("delta_t", step) / 1e3


def _track(mass: Mapping[str, Any], clip: Mapping[str, Any], step: float, axes: _Axes, unit: str) -> Table:
    """Return one point mass; frames that the clip leaves out are no rows of it."""
    marks = sorted(mass["framedata"].items())
    first = int(_finite("startframe", clip.get("startframe", 0)))
    stride = max(int(_finite("stepsize", clip.get("stepsize", 1))), 1)
    last = first + (int(_finite("stepcount", clip.get("stepcount", _FARTHEST))) - 1) * stride
    frames, places, rejected = [], [], []
    for frame, mark in marks:
        if not first <= frame <= last or (frame - first) % stride:
            rejected.append(Rejected(frame, "it is no step of the clip"))
            continue
        if not isinstance(mark, Mapping) or not {"x", "y"} <= mark.keys():
            rejected.append(Rejected(frame, "it holds no position"))
            continue
        x, y = _finite("x", mark["x"]), _finite("y", mark["y"])
        frames.append(frame)
        places.append(axes.place(frame, x, y))
    start = _finite("starttime", clip.get("starttime", 0.0) or 0.0) / 1e3
    across, up = np.array(places).reshape(-1, 2).T
    t = start + (np.array(frames) - first) * step
    unit = "px" if axes.in_pixels else unit
    columns = [Column("t", t, "s", "t"), Column("x", across, unit, "x"), Column("y", up, unit, "y")]
    name = str(mass.get("name", "")).strip()
    rate = 1 / (step * stride)
    return Table(columns, name, frames, "frame", rejected=tuple(rejected), y_down=False, rate=rate)


class _Axes:
    """Origin, direction and scale of the axes, which may change from frame to frame."""

    def __init__(self, coords: Mapping[str, Any], options: Options, *, calibrated: bool) -> None:
        known = {frame: data for frame, data in (coords.get("framedata") or {}).items() if isinstance(data, Mapping)}
        if not known:
            raise InvalidValueError("coords", "must hold the axes of a frame", "none", "Save it again in Tracker.")
        self._frames = sorted(known)
        self._known = {frame: self._of(data) for frame, data in known.items()}
        unscaled = all(scale == (1.0, 1.0) for *_, scale in self._known.values())
        self.in_pixels = (unscaled and not calibrated) or options.pixel is not None
        if self.in_pixels:
            self._known = {frame: (x, y, angle, (1.0, 1.0)) for frame, (x, y, angle, _) in self._known.items()}

    @staticmethod
    def _of(data: Mapping[str, Any]) -> tuple[float, float, float, tuple[float, float]]:
        x, y, angle = (_finite(name, data.get(name)) for name in ("xorigin", "yorigin", "angle"))
        xscale, yscale = (_positive(name, data.get(name)) for name in ("xscale", "yscale"))
        return x, y, math.radians(angle), (xscale, yscale)

    def place(self, frame: int, x: float, y: float) -> tuple[float, float]:
        """Return a point along the axes of its frame, those of the last frame that has some, in units of the scale."""
        at = self._frames[max(int(np.searchsorted(self._frames, frame, side="right")) - 1, 0)]
        x0, y0, angle, (xscale, yscale) = self._known[at]
        dx, dy, c, s = x - x0, y - y0, math.cos(angle), math.sin(angle)
        return (c * dx - s * dy) / xscale, -(s * dx + c * dy) / yscale


def _read(element: Any, depth: int = 0) -> Any:
    """Return an object as a dictionary with its class, an array as one by index, all else as its text."""
    if depth > 50:
        raise InvalidValueError("file", "must be a project of Tracker's", "objects within objects, 50 deep")
    if element.tag == "object":
        found = {"class": element.get("class", "")}
        return found | {child.get("name", ""): _read(child, depth + 1) for child in element if child.tag == "property"}
    kind = element.get("type", "")
    inner = list(element)
    if kind == "object":
        return _read(inner[0], depth + 1) if inner else None
    if kind == "array":
        return {index: _read(child, depth + 1) for child in inner
                if (index := _index(child.get("name", ""))) is not None}  # fmt: skip
    if kind == "collection":
        return [_read(child, depth + 1) for child in inner]
    return (element.text or "").strip()


def _index(name: str) -> int | None:
    digits = name.strip("[]")
    if not (digits.isascii() and digits.isdigit()):
        return None
    if int(digits[:12]) > _FARTHEST:
        raise InvalidValueError("framedata", f"must be of frames up to {_FARTHEST}", name)
    return int(digits)


def _object(owner: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    found = owner.get(name)
    return found if isinstance(found, Mapping) else {}


def _class(thing: Mapping[str, Any]) -> str:
    return str(thing.get("class", ""))


def _items(collection: Any) -> Sequence[Any]:
    return (
        collection
        if isinstance(collection, list)
        else list((collection or {}).values())
        if isinstance(collection, Mapping)
        else []
    )


def _finite(name: str, value: Any) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = math.nan
    if not math.isfinite(number):
        raise InvalidValueError(name, "must be a finite number", value, "The file is damaged: save it again.")
    return number


def _positive(name: str, value: Any) -> float:
    number = _finite(name, value)
    if number <= 0:
        raise InvalidValueError(name, "must be positive", value, "Calibrate in Tracker, and save again.")
    return number
