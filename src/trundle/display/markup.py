"""Pieces of HTML. Text is escaped where it is put in, so that only what these functions return can be markup."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from html import escape
from typing import Any

_SIGNS = {True: "✓\u00a0", False: "✗\u00a0", None: ""}  # not apart from their word
_KINDS = {True: ' class="trundle-good"', False: ' class="trundle-bad"', None: ""}


class Markup(str):
    """Text that is HTML already."""

    __slots__ = ()


def escaped(content: str) -> Markup:
    """Return a text as markup, and markup as it is.

    Examples
    --------
    >>> escaped("N < 0"), escaped(Markup("<b>N</b>"))
    ('N &lt; 0', '<b>N</b>')
    """
    return content if isinstance(content, Markup) else Markup(escape(content))


def joined(pieces: Iterable[str], between: str = "") -> Markup:
    """Return pieces of text and markup behind each other.

    Examples
    --------
    >>> joined(["a < b", Markup("<br>")], "; ")
    'a &lt; b; <br>'
    """
    return Markup(escaped(between).join(map(escaped, pieces)))


def number(value: Any, digits: int = 6, unit: str = "") -> Markup:
    """Return a number as it is set in print.

    Examples
    --------
    >>> number(-0.25), number(1.5e-16, 2, "m"), number(None)
    ('−0.25', '1.5·10<sup>−16</sup> m', '')
    """
    behind = escape(f" {unit}") if unit else ""
    if value is None or isinstance(value, str):
        return Markup(escape(value or "") + behind)
    mantissa, _, power = f"{float(value):.{digits}g}".replace("-", "−").partition("e")
    if power:
        sign, size = "−" * power.startswith("−"), power.lstrip("+−0")
        mantissa = {"1": "", "−1": "−"}.get(mantissa, f"{mantissa}·") + f"10<sup>{sign}{size}</sup>"
    return Markup(mantissa + behind)


def numbers(values: Iterable[Any], digits: int = 6, unit: str = "") -> Markup:
    """Return the components of a vector, each as `number` sets it.

    Examples
    --------
    >>> numbers((0.1, -2.0), unit="m")
    '(0.1, −2) m'
    """
    return joined(["(", joined((number(value, digits) for value in values), ", "), ")", f" {unit}" if unit else ""])


def verdict(good: bool | None, words: str) -> Markup:
    r"""Return a verdict that is seen by word and sign; colour only adds to it.

    Examples
    --------
    >>> verdict(False, "FAILS")
    '<strong class="trundle-bad">✗\xa0FAILS</strong>'
    """
    tag = "strong" if good is False else "span"
    return Markup(f"<{tag}{_KINDS[good]}>{_SIGNS[good]}{escaped(words)}</{tag}>") if words else Markup()


def table(rows: Iterable[Sequence[str]], heads: Sequence[str] = (), numbers: Iterable[int] = ()) -> Markup:
    """Return a table; what is too wide for the page scrolls by itself.

    Examples
    --------
    >>> table([["a", "1"]], numbers=[1]).partition("<tbody>")[2].partition("</tbody>")[0]
    '<tr><td>a</td><td class="trundle-number">1</td></tr>'
    """
    right = dict.fromkeys(numbers, ' class="trundle-number"')

    def cell(place: int, content: str) -> str:
        return f"<td{right.get(place, '')}>{_lines(content)}</td>"

    def head(place: int, name: str) -> str:
        return f'<th scope="col"{right.get(place, "")}>{escaped(name)}</th>' if name else "<td></td>"

    top = "".join(head(i, name) for i, name in enumerate(heads))
    body = "".join(f"<tr>{''.join(cell(i, content) for i, content in enumerate(row))}</tr>" for row in rows)
    return _scrolled(f"{f'<thead><tr>{top}</tr></thead>' if top else ''}<tbody>{body}</tbody>") if body else Markup()


def pairs(rows: Iterable[tuple[str, str]]) -> Markup:
    """Return named values, one to a line; those without a value are left out.

    Examples
    --------
    >>> pairs([("mass", "1 kg"), ("title", "")]).partition("<tbody>")[2].partition("</tbody>")[0]
    '<tr><th scope="row">mass</th><td>1 kg</td></tr>'
    """
    body = "".join(f'<tr><th scope="row">{escaped(name)}</th><td>{_lines(v)}</td></tr>' for name, v in rows if v)
    return _scrolled(f"<tbody>{body}</tbody>") if body else Markup()


def records(items: Sequence[Mapping[str, str]]) -> Markup:
    """Return things that have the same properties: one as named values, several as the numbered rows of a table.

    Examples
    --------
    >>> records([{"at": "here"}]).count("<tr>"), records([{"at": "here"}, {"at": "there", "N": "1 N"}]).count("<tr>")
    (1, 3)
    """
    if len(items) == 1:
        return pairs(items[0].items())
    heads = list(dict.fromkeys(name for item in items for name, value in item.items() if value))
    rows = [[str(i), *(item.get(name, "") for name in heads)] for i, item in enumerate(items, 1)]
    return table(rows, ["", *heads])


def paragraph(*pieces: str) -> Markup:
    """Return a paragraph that keeps its line ends, as cells of tables do; nothing where there is nothing to say.

    Examples
    --------
    >>> paragraph("at ", Markup("<b>rest</b>")), paragraph("")
    ('<p>at <b>rest</b></p>', '')
    """
    content = joined(pieces)
    return Markup(f"<p>{_lines(content)}</p>") if content.strip() else Markup()


def section(title: str, *parts: str) -> Markup:
    """Return parts below a title; nothing where they are empty.

    Examples
    --------
    >>> section("Events", "none"), section("Events", "")
    ('<p class="trundle-title">Events</p>none', '')
    """
    # No heading: a notebook would list it among those of its author.
    content = joined(parts)
    return Markup(f'<p class="trundle-title">{escaped(title)}</p>{content}') if content else Markup()


def fold(title: str, *parts: str) -> Markup:
    """Return parts that are seen once their title is pressed; nothing where they are empty.

    Examples
    --------
    >>> fold("Variables", "position")
    '<details><summary>Variables</summary>position</details>'
    """
    content = joined(parts)
    return Markup(f"<details><summary>{escaped(title)}</summary>{content}</details>") if content else Markup()


def _lines(content: str) -> str:
    return escaped(content).replace("\n", "<br>")


def _scrolled(rows: str) -> Markup:
    return Markup(f'<div class="trundle-wide" tabindex="0"><table>{rows}</table></div>')
