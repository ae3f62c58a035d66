"""What a saved page says in words and numbers: summary, formula, findings, card, scenario. All text is escaped."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from typing import Any

from ...display import Markup, escaped, mathml, number, table, verdict
from ...verify import Card
from ...verify.card import table_of
from ..scene import Scene

_METHODS = {
    "exact": "closed form",
    "taylor": "Taylor integration",
    "runge-kutta": "Runge-Kutta integration",
    "page": "computed in this page",
}


def names_of(scenes: Sequence[Scene]) -> list[str]:
    """Return what to call the bodies of a page: what they are, unless that is the same of all.

    Examples
    --------
    >>> ball = {"body": {"label": "Ball"}}
    >>> names_of([Scene({**ball, "title": title}, {}) for title in ("Nudged", "Put down")])
    ['Nudged', 'Put down']
    """
    labels = [str(scene.header["body"]["label"]) for scene in scenes]
    if len(set(labels)) == len(labels):
        return labels
    return [str(scene.header["title"] or label) for scene, label in zip(scenes, labels, strict=True)]


def summary_of(scenes: Sequence[Scene]) -> str:
    """Return who moves on what, for how long, and how it was computed."""
    first = scenes[0].header
    bodies = [escape(name) for name in names_of(scenes)]
    methods = dict.fromkeys(_METHODS.get(scene.header["method"], str(scene.header["method"])) for scene in scenes)
    told = [
        *(f'<span class="page-body page-body-{i}">{name}</span>' for i, name in enumerate(bodies, start=1)),
        escape(str(first["support"]["name"])),
        f"{max(float(scene.header['duration']) for scene in scenes):.6g} s",
        escape(", ".join(methods)),
    ]
    return f'<p class="page-summary">{" <i>·</i> ".join(told)}</p>'


def headline_of(scenes: Sequence[Scene]) -> str:
    """Return what a run shows, in one sentence; of several, and of a page that computes it itself, nothing."""
    told = scenes[0].header.get("headline")
    if len(scenes) > 1 or not told or "live" in scenes[0].header:
        return ""
    other = f"{'predicted' if told['predicted'] else 'a second way gives'} {told['other']}" if told["other"] else ""
    said = escape(told["text"][:1].upper() + told["text"][1:])
    return (
        f'<p class="page-shown" title="{escape(told["how"])}"><strong>{said}</strong><span>{escape(other)}</span></p>'
    )


def formula_of(scenes: Sequence[Scene]) -> str:
    """Return the formula that a motion follows, with its numbers put in; nothing where there is none."""
    formula = scenes[0].header.get("formula")
    if not formula:
        return ""
    lines = "".join(mathml(formula[key], display=True) for key in ("latex", "numbers_latex") if formula.get(key))
    name = escape(str(formula["name"]))
    return f'<section class="page-formula"><h2>{name}</h2><div class="trundle-wide">{lines}</div></section>'


def findings_of(scenes: Sequence[Scene]) -> str:
    """Return what theory predicts beside what was measured on the computed path."""
    named = len(scenes) > 1
    rows = []
    for scene, name in zip(scenes, names_of(scenes), strict=True):
        found = scene.header.get("findings") or []
        rows += [([name] if named else []) + _finding(finding) for finding in found]
    if not rows:
        return ""
    heads = (["Body"] if named else []) + ["", "", "Predicted", "Measured", "Unit", "Apart by"]
    shown = table(rows, heads, numbers=(len(heads) - 4, len(heads) - 3, len(heads) - 1))
    return f"<section><h2>Theory and motion</h2>{shown}</section>"


def _finding(finding: dict[str, Any]) -> list[str]:
    note = f"<small>{escape(str(finding['note']))}</small>" if finding.get("note") else ""
    difference = finding.get("difference")
    return [
        Markup(f"{escape(str(finding['name']))}{note}"),
        mathml(str(finding.get("symbol") or "")),
        number(finding.get("predicted")),
        number(finding.get("measured")),
        str(finding.get("unit") or ""),
        "" if difference is None else number(difference, 2),
    ]


def card_of(scene: Scene, name: str = "") -> str:
    """Return a scene's verification card."""
    if not scene.header.get("card"):
        return ""
    card = Card.from_dict(scene.header["card"])
    who = f": {escape(name)}" if name else ""
    head = f"<summary><h2>Verification{who}</h2> {verdict(card.passed, card.outcome)}</summary>"
    origin = f" The card is {escaped(card.origin)}." if card.origin else ""
    told = f"<p>{escaped(card.method[:1].upper() + card.method[1:])}.{origin}</p>"
    return f"<details{' open' * (not name)}>{head}{told}{table_of(card.figures)}</details>"


def scenario_of(scene: Scene, name: str = "") -> str:
    """Return the scenario that gives this motion again."""
    text = scene.header.get("scenario_toml")
    if not text:
        return ""
    who = f": {escape(name)}" if name else ""
    told = "<p>Saved as <code>my.toml</code>, it gives this motion again: <code>trundle run my.toml</code></p>"
    return f'<details><summary><h2>Scenario{who}</h2></summary>{told}<pre tabindex="0">{escape(text)}</pre></details>'
