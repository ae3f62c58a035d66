"""A saved page: whole, safe whatever the title says, and its figures those of the card."""

from __future__ import annotations

import base64
import gzip
import hashlib
import re
from dataclasses import replace
from html import unescape
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import trundle as tr
from trundle.display import mathml, number
from trundle.errors import InvalidValueError, TrundleError
from trundle.scenario import files
from trundle.views.scene import Scene, scene_of, unpack
from trundle.views.viewer import bundle
from trundle.views.viewer.bundle import NotBuiltError, languages
from trundle.views.viewer.page import page_of

NAME = "tilted-turntable"
NASTY = "</script></title><script>alert(1)</script> \"quoted\" & 'so' <!-- $title Kugel übt 🎱"
ALSO_LOADS = {"src", "href", "srcset", "data", "poster", "action", "background"}


class Read(HTMLParser):
    """A page as a browser takes it apart: elements, attributes, text by element."""

    def __init__(self, text: str) -> None:
        super().__init__(convert_charrefs=True)
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.texts: list[tuple[str, str]] = []
        self.inside = False
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attributes: Any) -> None:
        self.elements.append((tag, dict(attributes)))
        self.texts.append((tag, ""))
        self.inside = True

    def handle_endtag(self, tag: str) -> None:  # noqa: ARG002
        self.inside = False

    def handle_data(self, data: str) -> None:
        if self.inside:
            tag, text = self.texts[-1]
            self.texts[-1] = (tag, text + data)

    def all(self, tag: str) -> list[dict[str, str | None]]:
        return [attributes for name, attributes in self.elements if name == tag]

    def text(self, tag: str) -> list[str]:
        return [text for name, text in self.texts if name == tag]


@pytest.fixture(scope="module")
def run() -> tr.Trajectory:
    return tr.Scenario.load(NAME).run()


@pytest.fixture(scope="module")
def page(run: tr.Trajectory, tmp_path_factory: pytest.TempPathFactory) -> str:
    return run.save_html(tmp_path_factory.mktemp("page") / "scene.html").read_text(encoding="utf-8")


def test_the_scene_in_it_is_that_of_the_run(page: str, run: tr.Trajectory) -> None:
    read = Read(page)
    [packed] = [
        text
        for (tag, attributes), (_, text) in zip(read.elements, read.texts, strict=True)
        if tag == "script" and "data-trundle-scene" in attributes
    ]
    scene = unpack(gzip.decompress(base64.b64decode(packed)))
    wanted = scene_of(run, curves=True)
    assert scene.columns.keys() == wanted.columns.keys()
    for name, column in wanted.columns.items():
        assert np.array_equal(scene.columns[name], column)
    assert scene.header["card"] == run.card().as_dict()


def test_its_policy_lets_nothing_run_or_load_but_its_own(page: str) -> None:
    read = Read(page)
    [policy] = [meta["content"] for meta in read.all("meta") if meta.get("http-equiv") == "Content-Security-Policy"]
    rules = dict(rule.split(None, 1) for rule in str(policy).split("; "))
    assert rules["default-src"] == "'none'"
    assert "unsafe" not in str(policy)
    script = read.text("script")[-1]
    [style] = read.text("style")
    for text, rule in ((script, "script-src"), (style, "style-src")):
        assert len(text) > 1000
        assert rules[rule] == f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"


def test_nothing_in_it_points_elsewhere(page: str) -> None:
    read = Read(page)
    for tag, attributes in read.elements:
        assert not ALSO_LOADS & attributes.keys(), tag
        assert not any(name.startswith("on") or name == "style" for name in attributes), tag
    [style] = read.text("style")
    assert all(part.startswith("data:") for part in re.findall(r"url\([\"']?([^)\"']*)", style))
    assert "@import" not in style


def test_it_says_how_large_it_is_and_who_made_it(page: str) -> None:
    from importlib.metadata import version

    stated = re.search(r"all there is to it: ([\d.]+) MB", page)
    assert stated
    assert float(stated[1]) == pytest.approx(len(page.encode()) / 1e6, abs=0.06)
    assert len(page.encode()) < 4e6, "too large for a letter"
    assert f"trundle {version('trundle')}" in page


def test_the_card_and_the_findings_stand_in_it_without_any_script(page: str, run: tr.Trajectory) -> None:
    shown = " ".join(re.sub(r"<[^>]+>", " ", page.partition("data-trundle-scene")[0].partition("</style>")[2]).split())
    assert "every check held" in shown
    for figure in run.card().figures:
        assert figure.name.replace("'", "&#x27;") in shown
    rate = 2 / 7 * run.system.support.motion.rate
    assert f"{rate:.6g}" in shown


def test_a_title_can_be_any_text(tmp_path: Path, page: str) -> None:
    tables = files.parse(files.read(NAME), NAME)
    nasty = tr.Scenario.read({**tables, "title": NASTY}).run(duration=1.0)
    written = nasty.save_html(tmp_path / "nasty.html").read_text(encoding="utf-8")
    read, plain = Read(written), Read(page)
    assert [text.strip() for text in read.text("h1")] == [NASTY]
    assert read.text("title") == [NASTY]
    counts = [[tag for tag, _ in one.elements].count("script") for one in (read, plain)]
    assert counts == [2 + len(languages())] * 2  # the scene, the viewer, and a catalogue for each language
    assert "alert(1)" not in "".join(read.text("script"))


def test_a_card_that_failed_is_shown_as_failed(run: tr.Trajectory) -> None:
    scene = scene_of(run, with_card=True)
    card = {**scene.header["card"], "passed": False}
    card["figures"] = [{**card["figures"][0], "passed": False, "name": "no slip <at all>"}, *card["figures"][1:]]
    shown = page_of([replace(scene, header={**scene.header, "card": card})]).decode()
    assert "1 of the checks FAILED" in shown
    assert "every check held" not in shown
    assert "no slip &lt;at all&gt;" in shown
    assert shown.count("✗\xa0FAILS<") == 1


def test_several_runs_share_a_page(run: tr.Trajectory, tmp_path: Path) -> None:
    hollow = tr.Scenario.load("hollow-ball-turntable").run(duration=5.0)
    page = run.save_html(tmp_path / "two.html", hollow).read_text(encoding="utf-8")
    assert page.count("data-trundle-scene>") == 2
    assert page.count("Verification: ") == 2


@pytest.mark.parametrize("count", [0, 6])
def test_a_page_holds_one_to_five(count: int) -> None:
    with pytest.raises(InvalidValueError, match="must be 1 to 5"):
        page_of([Scene({}, {})] * count)


def test_it_is_written_whole_or_not_at_all(run: tr.Trajectory, tmp_path: Path) -> None:
    with pytest.raises(TrundleError, match="Make it first"):
        run.save_html(tmp_path / "nowhere" / "scene.html")
    (tmp_path / "taken.html").mkdir()
    with pytest.raises(TrundleError, match="cannot be written"):
        run.save_html(tmp_path / "taken.html")
    assert [path.name for path in tmp_path.iterdir()] == ["taken.html"]


def test_a_copy_without_the_viewer_says_how_to_get_it(
    run: tr.Trajectory, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(bundle, "STATIC", tmp_path)
    with pytest.raises(NotBuiltError, match=r"viewer\.js is missing.*pip install"):
        run.save_html(tmp_path / "scene.html")
    assert not list(tmp_path.iterdir())


def test_formulas_are_markup_that_says_the_same() -> None:
    shown = mathml(r"\dot q = \tfrac12 \Omega q", display=True)
    assert re.sub(r"<[^>]+>", "", shown).count("&#x003A9;") == 1
    assert 'display="block"' in shown
    assert ">arg<" in mathml(r"\arg v_d")
    plain = mathml(r"\frac{k}{1 + k} \omega^{2n} + \sqrt{a + b} + \tfrac12 v_d")  # where the markup is taken out
    assert unescape(re.sub(r"<[^>]+>", "", plain)) == "k/(1+k)ω^(2n)+√(a+b)+1/2v_d"
    assert "<mtext>kg</mtext>" in mathml(r"2\,\mathrm{kg\,m^2/s}")
    lines = mathml(r"\begin{aligned} a &= b \\ c &= d \end{aligned}")
    assert (lines.count("<mtr>"), lines.count("&<")) == (2, 0)
    assert "<script" not in mathml(r"\text{<script>alert(1)</script>}")
    assert mathml(r"\left( a") == r"<code>\left( a</code>"


@pytest.mark.parametrize(
    ("value", "digits", "shown"),
    [
        (0.0, 6, "0"),
        (-12.5, 6, "−12.5"),
        (1e-12, 2, "10<sup>−12</sup>"),
        (1.25e20, 3, "1.25·10<sup>20</sup>"),
        (-3e-5, 2, "−3·10<sup>−5</sup>"),
        ("nan", 6, "nan"),
        (None, 6, ""),
    ],
)
def test_numbers_are_set_as_in_print(value: Any, digits: int, shown: str) -> None:
    assert number(value, digits) == shown


def test_the_fonts_of_the_lab_are_there_in_one_form_only() -> None:
    """What has WebGL 2 reads woff2: older copies would only make the package larger."""
    assets = bundle.STATIC / "assets"
    if not assets.is_dir():
        pytest.skip("the viewer is not built into this copy: python web/build.py bundle")
    fonts = [path.suffix for path in assets.iterdir() if path.suffix in (".woff2", ".woff", ".ttf", ".otf")]
    assert len(fonts) > 10
    assert set(fonts) == {".woff2"}
    for style in assets.glob("*.css"):
        named = [name.strip("'\"") for name in re.findall(r"url\(([^)]*)\)", style.read_text(encoding="utf-8"))]
        assert [name for name in named if not name.startswith("data:") and not (assets / name).is_file()] == []
