"""The notebook's widget. It needs the extra `notebook`, and `Viewable.view` says so where it is missing."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import anywidget
import traitlets

from ...errors import InvalidValueError, UnknownNameError
from ...solve.frames import FRAMES
from ..scene import pack, scene_of
from .bundle import built
from .page import check_count

if TYPE_CHECKING:
    from ...simulation.trajectory import Trajectory

THEMES = ("auto", "light", "dark")
SHOWN = (
    "velocity",
    "contactForce",
    "angularVelocity",
    "gravity",
    "frictionCone",
    "guidingCentre",
    "trail",
    "ahead",
    "axes",
)


class SceneWidget(anywidget.AnyWidget):
    """Runs that play on one stage, in a notebook.

    Each trait can be set while it is shown, and follows what is done with the mouse. While it plays, `time` tells
    where it is; `seek` goes elsewhere.

    Parameters
    ----------
    runs : sequence of Trajectory
        They share the support of the first.
    **traits
        `theme`: "auto" (the notebook's), "light" or "dark". `frame`: "support", "world" or "corotating". `time`: s.
        `speed`: times as fast as it happens. `loop`, `playing`: bool. `show`: what to draw besides, a dictionary of
        bool with some of the keys of `SHOWN`. `projector`: large type, thick lines. `height`: pixels.

    Examples
    --------
    >>> import trundle as tr
    >>> widget = tr.Scenario.load("level-turntable-nudged").run().view(frame="corotating")
    >>> widget.frame, len(widget.scenes)
    ('corotating', 1)
    >>> widget.close()
    """

    _esm = traitlets.Unicode().tag(sync=True)
    _css = traitlets.Unicode().tag(sync=True)
    scenes = traitlets.List(traitlets.Bytes(), help="packed scenes").tag(sync=True)
    theme = traitlets.Unicode("auto").tag(sync=True)
    frame = traitlets.Unicode("world").tag(sync=True)
    show = traitlets.Dict(value_trait=traitlets.Bool(), key_trait=traitlets.Unicode()).tag(sync=True)
    time = traitlets.Float(0.0).tag(sync=True)
    speed = traitlets.Float(1.0).tag(sync=True)
    loop = traitlets.Bool(False).tag(sync=True)
    playing = traitlets.Bool(True).tag(sync=True)
    projector = traitlets.Bool(False).tag(sync=True)
    height = traitlets.Int(480).tag(sync=True)

    def __init__(self, runs: Sequence[Trajectory], **traits: Any) -> None:
        known = [name for name in self.trait_names(sync=True) if name not in _INNER and name in SceneWidget.__dict__]
        for name in traits:
            if name not in known or name == "scenes":
                raise UnknownNameError("option of view", name, [other for other in known if other != "scenes"])
        check_count(len(runs))
        packed = [pack(scene_of(run)) for run in runs]
        super().__init__(_esm=built("viewer.js"), _css=built("viewer.css"), scenes=packed, **traits)
        self._runs = tuple(runs)

    def seek(self, time: float) -> None:
        """Go to an instant, whether it plays or not.

        Examples
        --------
        >>> import trundle as tr
        >>> widget = tr.Scenario.load("level-turntable-nudged").run().view(playing=False)
        >>> widget.seek(1.5)
        >>> widget.close()
        """
        self.send({"seek": float(time)})

    def __repr__(self) -> str:
        titles = ", ".join(run.title or "a run" for run in self._runs)
        return f"<trundle scene: {titles}>"

    def _repr_mimebundle_(self, **kwargs: Any) -> Any:
        bundle = super()._repr_mimebundle_(**kwargs)
        if bundle is None:
            return None
        # What a page shows that has no widgets: a picture of the path.
        picture = self._runs[0].plot()._repr_png_()  # type: ignore[attr-defined]
        bundle[0]["image/png"] = base64.b64encode(picture).decode()
        return bundle

    @traitlets.validate("theme", "frame")
    def _named(self, proposal: Any) -> str:
        name, value = proposal["trait"].name, proposal["value"]
        allowed = {"theme": THEMES, "frame": FRAMES}[name]
        if value not in allowed:
            raise UnknownNameError(name, value, allowed)
        return value

    @traitlets.validate("show")
    def _shown(self, proposal: Any) -> dict[str, bool]:
        for name in proposal["value"]:
            if name not in SHOWN:
                raise UnknownNameError("thing to show", name, SHOWN)
        return proposal["value"]

    @traitlets.validate("speed", "height")
    def _positive(self, proposal: Any) -> Any:
        if not 0 < proposal["value"] < float("inf"):
            raise InvalidValueError(proposal["trait"].name, "must be positive", proposal["value"])
        return proposal["value"]


_INNER = ("_esm", "_css")
