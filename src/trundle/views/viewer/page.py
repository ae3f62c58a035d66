"""A page of its own: one file that plays a run wherever there is a browser, and asks nothing of any network."""

from __future__ import annotations

import base64
import gzip
import hashlib
import json
import re
from collections.abc import Sequence
from functools import lru_cache
from html import escape
from importlib.metadata import version
from importlib.resources import files
from string import Template

from ...errors import InvalidValueError
from ..scene import Scene, pack
from .bundle import built, languages
from .words import card_of, findings_of, formula_of, headline_of, names_of, scenario_of, summary_of

_ENDS_A_SCRIPT = re.compile(r"<(?=/script|script|!--)", re.IGNORECASE)
_LONGEST = 120  # letters of what a saved page may say: notes and lessons stand elsewhere
MOST_SCENES = 5  # bodies that can be told apart on one stage


def page_of(scenes: Sequence[Scene], law: str = "") -> bytes:
    """Return a self-contained page that shows scenes on one stage; or a live one, with the law as a script.

    Examples
    --------
    >>> import trundle as tr
    >>> from trundle.views.scene import scene_of
    >>> page = page_of([scene_of(tr.Scenario.load("level-turntable-nudged").run())])
    >>> page[:15], b"Content-Security-Policy" in page
    (b'<!doctype html>', True)
    """
    check_count(len(scenes))
    script, style = _script(built("viewer.js")), _style(built("viewer.css"), _own("page.css"))
    title = title_of(scenes)
    names = names_of(scenes) if len(scenes) > 1 else [""]
    parts = {
        "policy": _policy(script, style, workers=bool(law)),
        "version": escape(version("trundle")),
        "title": escape(title),
        "summary": summary_of(scenes),
        "headline": headline_of(scenes),
        "formula": formula_of(scenes),
        "findings": findings_of(scenes),
        "cards": "".join(map(card_of, scenes, names)),
        "scenarios": "".join(map(scenario_of, scenes, names)),
        "scenes": "\n".join([catalogues(_LONGEST), *map(_data, scenes), *([_held(law)] if law else [])]),
        "kind": " trundle-live" if law else "",
        "style": style,
        "script": script,
    }
    template = Template(_own("page.html"))
    whole = template.substitute(parts, size="00.0 MB")
    return template.substitute(parts, size=_size(len(whole.encode()))).encode()


def check_count(count: int) -> None:
    """Refuse more scenes on one stage than can be told apart.

    Examples
    --------
    >>> check_count(1)
    """
    if not 1 <= count <= MOST_SCENES:
        raise InvalidValueError("runs", f"must be 1 to {MOST_SCENES} on one stage", count)


def title_of(scenes: Sequence[Scene]) -> str:
    """Return the title of a page: the first scene's, or the bodies' names where there are several."""
    titles = list(dict.fromkeys(str(scene.header["title"]) for scene in scenes))
    return titles[0] if len(titles) == 1 else f"{titles[0]}, and {len(scenes) - 1} more"


def catalogues(longest: int = 100_000) -> str:
    """Return what a page needs to be said in other languages, as elements; longer texts than some are left out.

    Examples
    --------
    >>> catalogues()[:62]
    '<script type="application/gzip" data-trundle-language="de">H4s'
    """
    return "".join(_catalogue(tag, text, longest) for tag, text in languages().items())


@lru_cache(maxsize=8)
def _catalogue(tag: str, text: str, longest: int) -> str:
    entries = {said: other for said, other in json.loads(text).items() if len(said) <= longest}
    told = json.dumps(entries, ensure_ascii=False, separators=(",", ":"))
    return _packed(told.encode(), f'data-trundle-language="{tag}"')


def _data(scene: Scene) -> str:
    return _packed(pack(scene), "data-trundle-scene")


def _packed(content: bytes, attribute: str) -> str:
    packed = base64.b64encode(gzip.compress(content, 6, mtime=0)).decode()
    return f'<script type="application/gzip" {attribute}>{packed}</script>'


def _held(law: str) -> str:
    """Return a script that the page does not run itself: the text of its worker."""
    if _ENDS_A_SCRIPT.search(law):
        raise ValueError("the text of a law ends its element")
    return f'<script type="text/plain" data-trundle-law>{law}</script>'


def _policy(script: str, style: str, *, workers: bool) -> str:
    """Return a policy under which nothing runs but the page's own script, and nothing is asked for.

    A worker runs what the page makes a blob of; nothing is evaluated from text in either.
    """
    own = (f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'" for text in (script, style))
    allowed = "default-src 'none'; script-src {}; style-src {}".format(*own)
    allowed += "; worker-src blob:" if workers else ""
    return f"{allowed}; img-src data: blob:; font-src data:; base-uri 'none'; form-action 'none'"


@lru_cache(maxsize=2)
def _script(module: str) -> str:
    """Return a module as it may stand within a page: nothing in it ends the element, or opens a comment."""
    text = module.replace("\r\n", "\n").replace("\r", "\\r")
    return _ENDS_A_SCRIPT.sub(r"\\x3C", text)


@lru_cache(maxsize=2)
def _style(*sheets: str) -> str:
    text = "\n".join(sheets).replace("\r\n", "\n")
    return re.sub(r"</(?=style)", r"<\\/", text, flags=re.IGNORECASE)


def _own(name: str) -> str:
    return (files(__package__) / name).read_text(encoding="utf-8")


def _size(count: int) -> str:
    return f"{count / 1e6:.1f} MB"
