"""A static site: a gallery, a tour, and a page for each scenario, live where a page can compute it."""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from html import escape
from importlib.metadata import version
from importlib.resources import files
from pathlib import Path
from string import Template
from typing import Any

import numpy as np

from ..analysis.geometry import PathScenario
from ..analysis.geometry.scene import rolled_scene
from ..errors import InvalidValueError, OutOfDomainError
from ..scenario import files as scenarios
from ..simulation.simulate import Scenario
from ..solve.samples import Progress
from ..views.scene import Scene as Drawn
from ..views.scene import scene_of
from ..views.viewer.bundle import built
from ..views.viewer.page import catalogues, page_of
from .page import made

# From a slope to a table that leans: each has one thing more than that before it.
TOUR = (
    "cylinder-on-incline",
    "level-turntable-put-down",
    "level-turntable-nudged",
    "hollow-ball-turntable",
    "tilted-turntable",
    "tilted-turntable-straight",
    "real-demonstration",
)
_ADDITIONAL = "More"  # the heading of scenarios that have none
_POINTS = 300  # of a picture in the gallery
_TITLE = "Bodies that roll"
_CHALLENGES = "challenges.html"
_TAKEN = ("index", "challenges")  # by the site itself


@dataclass(frozen=True)
class Entry:
    """A scenario of the site."""

    name: str  # as its file has them
    title: str  # as its file has them
    group: str  # as its file has them
    notes: str  # as its file has them
    page: bytes  # that shows it
    scene: Drawn  # what is drawn there first
    live: bool  # whether the page computes the motion itself

    @property
    def file(self) -> str:
        """The name of its page."""
        return f"{self.name}.html"


def site_of(
    names: Sequence[str] = (),
    *,
    challenges: Sequence[Mapping[str, Any]] = (),
    progress: Progress | None = None,
) -> dict[str, bytes]:
    """Return the files of a site, by name.

    Parameters
    ----------
    names : sequence of str
        Shipped scenarios or TOML files; none: all that ship.
    challenges : sequence of dict
        As `trundle.lab.challenges` tells them; those whose scenario is on the site have a page.
    progress : callable, optional
        Told the fraction done.

    Returns
    -------
    dict of bytes
        HTML, with links from one to the other that are relative.

    Raises
    ------
    TrundleError
        If a scenario cannot be read or run.

    Examples
    --------
    >>> sorted(site_of(["level-turntable-nudged"]))
    ['index.html', 'level-turntable-nudged.html', 'tour-1.html']
    """
    wanted = list(names or scenarios.names())
    stems = [Path(name).stem if name.endswith(".toml") else name for name in wanted]
    double = {stem for stem in stems if stems.count(stem) > 1 or stem in _TAKEN or stem.startswith("tour-")}
    if double:
        raise InvalidValueError("SCENARIO", "must have a name of its own on the site", ", ".join(sorted(double)))
    entries = []
    for i, (name, stem) in enumerate(zip(wanted, stems, strict=True)):
        part = None if progress is None else lambda done, i=i: progress((i + done) / len(wanted))
        entries.append(entry(name, stem, part))
    toured = [one for wish in TOUR for one in entries if one.name == wish]
    found = {one.file: one.page for one in entries}
    tasks = [(task, one) for task in challenges for one in entries if one.name == task["scenario"]]
    links = {"index.html": "Gallery"} | ({_step(0): "Tour"} if toured else {})
    links |= {_CHALLENGES: "Challenges"} if tasks else {}
    found["index.html"] = _gallery(entries, links)
    if tasks:
        found[_CHALLENGES] = _challenges(tasks, links)
    return found | {_step(i): _stop(toured, i, links) for i in range(len(toured))}


def entry(name: str, stem: str, progress: Progress | None = None) -> Entry:
    """Return a scenario with the page that shows it: live if it can be, else the film of its run."""
    tables = scenarios.tables_of(name)
    if scenarios.rolls_along_path(tables):
        path = PathScenario.read(tables, name)
        scene = rolled_scene(path.run(), with_card=True)
        return Entry(stem, path.title, path.group, path.notes, page_of([scene]), scene, live=False)
    scenario = Scenario.read(tables, name)
    told = scenario.title, scenario.group, scenario.notes
    try:
        page, scene = made(scenario, progress=progress)
    except OutOfDomainError:
        scene = scene_of(scenario.run(progress=progress), with_card=True)
        return Entry(stem, *told, page_of([scene]), scene, live=False)
    return Entry(stem, *told, page, scene, live=True)


def _gallery(entries: Sequence[Entry], links: Mapping[str, str]) -> bytes:
    groups = list(dict.fromkeys(one.group or _ADDITIONAL for one in entries))
    parts = [
        "<p>Each page below computes its motion where it is opened, and has sliders to change it; a film shows one "
        "motion as it was computed. They need no network, and can be saved and carried about.</p>"
    ]
    for group in groups:
        cards = "".join(_card(one) for one in entries if (one.group or _ADDITIONAL) == group)
        parts.append(f'<section><h2>{escape(group)}</h2><ul class="gallery">{cards}</ul></section>')
    return _page(_TITLE, "\n".join(parts), links)


def _card(one: Entry) -> str:
    kind = "Live, with sliders" if one.live else "Film"
    return (
        f'<li>{_picture(one.scene)}<a href="{escape(one.file)}">{escape(one.title)}</a>'
        f'<span class="kind">{kind}</span><details><summary>Embed</summary>{_code(one)}</details></li>'
    )


def _code(one: Entry) -> str:
    """Return what puts a page into another, to be copied."""
    frame = (
        f'<iframe src="{escape(one.file)}" title="{escape(one.title)}" width="100%" height="760" '
        'allowfullscreen loading="lazy"></iframe>'
    )
    label = f"Code that embeds {escape(one.title)}"
    return f'<textarea readonly aria-label="{label}" data-page="{escape(one.file)}">{escape(frame)}</textarea>'


def _picture(scene: Drawn) -> str:
    """Return the path as a drawing: seen from above, or from the side where it goes nowhere but up and down."""
    places = np.asarray(scene.columns["position"], dtype=float)
    places = places[:: max(1, len(places) // _POINTS)]
    spans = np.ptp(places, axis=0)
    across = 1 if spans[1] >= 0.02 * spans[0] or spans[2] < spans[1] else 2
    flat = places[:, [0, across]] * (1.0, -1.0)
    low, size = flat.min(axis=0), float(np.ptp(flat, axis=0).max()) or 1.0
    x, y = ((flat - low - 0.5 * np.ptp(flat, axis=0)) / size * 90.0).T
    points = "L".join(f"{a:.1f} {b:.1f}" for a, b in zip(x, y, strict=True))
    return f'<svg viewBox="-50 -50 100 100" aria-hidden="true"><path d="M{points}"/></svg>'


def _challenges(tasks: Sequence[tuple[Mapping[str, Any], Entry]], links: Mapping[str, str]) -> bytes:
    """Return the challenges, the easier first, each with its scenario and its hints."""
    parts = [
        "<p>Write down your prediction before you press Play. These pages have no server that could judge a run: to "
        "have your answer checked, run <code>trundle lab</code> and open Challenges there.</p>"
    ]
    for task, one in sorted(tasks, key=lambda pair: pair[0]["level"]):
        asked = task["prediction"]
        choices = "".join(f"<li>{escape(choice)}</li>" for choice in asked["choices"])
        hints = "".join(f"<li>{escape(hint)}</li>" for hint in task["hints"])
        if task["hidden"]:
            way = "<p>This one hides something, and can be done in the lab only.</p>"
        else:
            way = f'<p>The scenario to begin with: <a href="{escape(one.file)}">{escape(one.title)}</a></p>'
        parts.append(
            f"<section><h2>{escape(task['title'])}</h2><p>{escape(task['task'])}</p>"
            f"<p>Predict first: {escape(asked['question'])}</p><ul>{choices}</ul>{way}"
            f"<details><summary>Hints</summary><ol>{hints}</ol></details></section>"
        )
    return _page("Challenges", "\n".join(parts), links)


def _step(i: int) -> str:
    return f"tour-{i + 1}.html"


def _stop(toured: Sequence[Entry], i: int, links: Mapping[str, str]) -> bytes:
    """Return a step of the tour: what a lecturer says, and the page."""
    one = toured[i]
    paragraphs = "".join(
        f"<p>{escape(' '.join(part.split()).replace('`', ''))}</p>" for part in one.notes.split("\n\n") if part.strip()
    )
    frame = f'<iframe src="{escape(one.file)}" title="{escape(one.title)}" allowfullscreen></iframe>'
    ways = "".join(
        f'<a href="{_step(j)}" rel="{way}">{said}: {escape(toured[j].title)}</a>'
        for j, way, said in ((i - 1, "prev", "Back"), (i + 1, "next", "On"))
        if 0 <= j < len(toured)
    )
    body = f'{paragraphs}{frame}<p class="ways">{ways}</p>'
    return _page(one.title, body, links)


def _page(title: str, body: str, links: Mapping[str, str]) -> bytes:
    """Return a page of the site that holds no motion itself."""
    own = files(__package__)
    style, template = ((own / f"site.{kind}").read_text(encoding="utf-8") for kind in ("css", "html"))
    script = built("site.js")
    allowed = [
        f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'" for text in (script, style)
    ]
    # A page from a memory stick is no origin to a browser: frames of files beside it are said by their scheme.
    policy = "default-src 'none'; script-src {}; style-src {}; frame-src 'self' file:; base-uri 'none'".format(*allowed)
    shown = "".join(f'<a href="{address}">{name}</a>' for address, name in links.items())
    parts = {
        "catalogues": catalogues(),
        "title": escape(title),
        "version": escape(version("trundle")),
        "links": shown,
        "body": body,
    }
    return Template(template).substitute(parts, policy=policy, style=style, script=script).encode()


__all__ = ["TOUR", "Entry", "site_of"]
