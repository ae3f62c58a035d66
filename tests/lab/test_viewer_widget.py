"""The notebook's widget, as far as Python sees it; tests/browser looks at it in JupyterLab."""

from __future__ import annotations

import base64
import sys
from collections.abc import Iterator
from io import BytesIO

import numpy as np
import pytest
from PIL import Image

import trundle as tr
from trundle.errors import InvalidValueError, MissingExtraError, UnknownNameError
from trundle.views.scene import scene_of, unpack
from trundle.views.viewer.widget import SceneWidget


@pytest.fixture(scope="module")
def run() -> tr.Trajectory:
    return tr.Scenario.load("tilted-turntable").run()


@pytest.fixture
def widget(run: tr.Trajectory) -> Iterator[SceneWidget]:
    shown = run.view()
    yield shown
    shown.close()


def test_it_carries_the_scenes_and_the_built_viewer(run: tr.Trajectory) -> None:
    other = tr.Scenario.load("hollow-ball-turntable").run(duration=2.0)
    widget = run.view(other, theme="dark", speed=2.0)
    state = widget.get_state()
    assert len(state["scenes"]) == 2
    scene = unpack(state["scenes"][0])
    assert np.array_equal(scene.columns["position"], scene_of(run).columns["position"])
    assert unpack(state["scenes"][1]).header["body"]["name"] == "Hollow sphere"
    assert "createViewer" in state["_esm"]
    assert ".tr-viewer" in state["_css"]
    assert (state["theme"], state["speed"], state["frame"]) == ("dark", 2.0, "world")
    widget.close()


def test_where_there_are_no_widgets_it_is_a_picture(widget: SceneWidget) -> None:
    data, _ = widget._repr_mimebundle_()
    assert "application/vnd.jupyter.widget-view+json" in data
    picture = Image.open(BytesIO(base64.b64decode(data["image/png"])))
    assert picture.format == "PNG"
    assert min(picture.size) > 200
    assert "tilted turntable" in data["text/plain"]


def test_a_name_that_does_not_exist_is_refused_by_name(run: tr.Trajectory, widget: SceneWidget) -> None:
    with pytest.raises(UnknownNameError, match="Did you mean 'speed'"):
        run.view(sped=2.0)
    with pytest.raises(UnknownNameError, match="scenes"):
        run.view(scenes=[])
    with pytest.raises(UnknownNameError, match="support, world, corotating"):
        widget.frame = "wrold"
    with pytest.raises(UnknownNameError, match="auto, light, dark"):
        widget.theme = "black"
    with pytest.raises(UnknownNameError, match="contactForce"):
        widget.show = {"contact_force": True}
    with pytest.raises(InvalidValueError, match="must be positive"):
        widget.speed = 0.0
    assert (widget.frame, widget.theme, widget.show, widget.speed) == ("world", "auto", {}, 1.0)


def test_without_anywidget_the_remedy_is_told(run: tr.Trajectory, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "anywidget", None)
    with pytest.raises(MissingExtraError, match=r"`view` .* pip install 'trundle\[notebook\]'"):
        run.view()


def test_too_many_runs_are_refused(run: tr.Trajectory) -> None:
    with pytest.raises(InvalidValueError, match="1 to 5"):
        run.view(*[run] * 5)


def test_each_trait_of_the_widget_is_known_to_its_front_side() -> None:
    from pathlib import Path

    front = (Path(__file__).parents[2] / "web" / "src" / "viewer" / "widget.ts").read_text(encoding="utf-8")
    traits = front.partition("interface Traits {")[2].partition("}")[0]
    told = {line.partition(":")[0].strip() for line in traits.splitlines() if ":" in line}
    own = {name for name in SceneWidget.class_trait_names(sync=True) if name in SceneWidget.__dict__}
    assert told == own - {"_esm", "_css"}
