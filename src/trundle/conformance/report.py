"""The report of a score: one table in Markdown, and one page that needs nothing but itself."""

from __future__ import annotations

import io
import math
import platform
from collections.abc import Iterable, Mapping, Sequence
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

from ..display import Markup, escaped, joined
from .animation import beside, program
from .answers import NOT_INSTALLED
from .case import Case
from .measuring import (
    ASTRAY,
    CANNOT,
    CLASSES,
    CONVERGES,
    DIVERGES,
    EXACT,
    FLOAT_FLOOR,
    NOT_RUN,
    ONE_STEP,
    PLATEAUS,
    SILENT_LIMIT,
    SLOWLY,
)
from .results import Cell, Score

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Okabe and Ito's colours, lightened; a sign goes with each, so that nobody needs the colour.
_LOOKS = {
    EXACT: ("●", "#BFDFF2"),
    CONVERGES: ("↓", "#D9EEF9"),
    SLOWLY: ("↘", "#FBE9C0"),
    PLATEAUS: ("→", "#F6D5B8"),
    DIVERGES: ("↑", "#EFB08A"),
    ASTRAY: ("?", "#E3E0F0"),
    SILENT_LIMIT: ("⊤", "#E9CBDD"),
    FLOAT_FLOOR: ("▁", "#DDDDDD"),
    ONE_STEP: ("·", "#FFFFFF"),
    CANNOT: ("–", "#F4F3EE"),
    NOT_RUN: ("✗", "#FFFFFF"),
}
_STYLE = """
body { font: 16px/1.5 system-ui, sans-serif; color: #1a1a1a; background: #fff; margin: 2rem auto; max-width: 76rem;
  padding: 0 1rem }
h1 { font-size: 1.6rem } h2 { font-size: 1.25rem; margin-top: 2.5rem } h3 { font-size: 1.05rem; margin-bottom: .3rem }
table { border-collapse: collapse; font-size: .9rem } .wide { overflow-x: auto }
th, td { border: 1px solid #d9d9d9; padding: .3rem .5rem; text-align: left; vertical-align: top }
th { background: #f4f3ee; font-weight: 600 } td small { color: #4a4a4a; display: block } td span { white-space: nowrap }
.wide :is(th[scope=row], thead th:first-child) { position: sticky; left: 0 }
svg { max-width: 100%; min-width: 36rem; height: auto } figure { margin: 1rem 0; overflow-x: auto }
p { max-width: 46rem }
.beside canvas { display: block; width: 100%; height: 22rem; margin: .5rem 0 }
.beside :is(button, select, input) { font: inherit; min-height: 2.2rem; vertical-align: middle; accent-color: #0072b2 }
.beside select { max-width: 100% } .beside input { width: 14rem } .beside button { min-width: 6.5rem }
.beside :focus-visible { outline: 3px solid #0072b2; outline-offset: 2px }
.beside div { display: flex; flex-wrap: wrap; gap: .5rem 1rem; align-items: center }
.beside output { font-variant-numeric: tabular-nums }
@media (prefers-color-scheme: dark) {
  :root { color-scheme: dark } body { color: #e8e8e8; background: #161616 } th { background: #2a2a2a }
  th, td { border-color: #4a4a4a } td[style] { color: #1a1a1a } svg, canvas { background: #fff }
}
"""


def markdown(score: Score) -> str:
    """Return the profiles as a table in Markdown: a row for each engine and profile, a column for each case.

    Derivatives have a table of their own below.

    Examples
    --------
    >>> print(markdown(Score(())), end="")
    | engine | setting |
    | --- | --- |
    """
    motions = _in_markdown("setting", score.motions)
    return motions + (f"\n{_in_markdown('derivatives', score.derivatives)}" if score.derivatives else "")


def _in_markdown(head: str, cells: Sequence[Cell]) -> str:
    names = _case_names(cells)
    lines = [_row(["engine", head, *names]), _row(["---"] * (2 + len(names)))]
    for (engine, setting), found in _matrix(cells).items():
        lines.append(_row([engine, setting, *(_in_words(found.get(name)) for name in names)]))
    return "\n".join(lines) + "\n"


def _row(cells: Iterable[str]) -> str:
    return f"| {' | '.join(cell.replace('|', '∣') for cell in cells)} |"


def _in_words(cell: Cell | None) -> str:
    """Return the class of a cell, with the error at the finest step."""
    if cell is None:
        return ""
    return cell.name if not math.isfinite(cell.finest.worst) else f"{cell.name}, {_number(cell.finest.worst)}"


def _number(value: float) -> str:
    return f"{value:.1e}".replace("e-0", "e-").replace("e+0", "e+")


def _case_names(cells: Iterable[Cell]) -> list[str]:
    return list(dict.fromkeys(cell.case for cell in cells))


def _matrix(cells: Iterable[Cell]) -> dict[tuple[str, str], dict[str, Cell]]:
    """Return the cells by engine and setting, and by case."""
    found: dict[tuple[str, str], dict[str, Cell]] = {}
    for cell in cells:
        found.setdefault((cell.engine, cell.label), {})[cell.case] = cell
    return found


def page(score: Score, cases: Sequence[Case]) -> str:
    """Return the report as a page of HTML: nothing in it comes from elsewhere.

    Parameters
    ----------
    score : Score
        What is reported.
    cases : sequence of Case
        For their titles and what is said about them.
    """
    known = {case.name: case for case in cases}
    names = _case_names(score.motions)
    versions = sorted({row.version for row in score.rows if row.version})
    told = [platform.machine(), platform.system(), f"Python {platform.python_version()}"]
    about = f"{', '.join(versions)}. {', '.join(told)}. {datetime.now(UTC):%Y-%m-%d}."
    parts = [
        Markup("<h1>Physics engines on rolling, spinning and slipping</h1>"),
        _p(_INTRODUCTION),
        _p(about),
        Markup("<h2>How the error falls with the step</h2>"),
        _key(),
        _table(_matrix(score.motions), names, known),
        *_of_derivatives(score.derivatives, known),
        Markup("<h2>What takes a plateau away</h2>"),
        _p(
            "Each row differs from a profile in what its name says. Where an error that stays in the profile falls"
            " here, that is its cause."
        ),
        _table(_matrix(cell for cell in score.cells if cell.rows[0].of and not cell.way), names, known),
        Markup("<h2>Case by case</h2>"),
        *(_section(name, known.get(name), [cell for cell in score.motions if cell.case == name]) for name in names),
    ]
    return (
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>Physics engines on rolling</title><style>{_STYLE}</style></head><body>"
        f"{joined(part for part in parts if part)}{program()}</body></html>\n"
    )


_INTRODUCTION = (
    "Each engine was given the same bodies, the same start and the same numbers, and run at several steps. The exact"
    " motion is known, by a formula or to fifteen digits by two methods. The error is the larger of two: the distance"
    " from the exact position over the length of the path, and the angle from the exact orientation over the angle"
    " turned through, each at its worst. Where a box is pushed, the error of the force of friction is given, too."
    " Where a bowl is made of triangles, the error is that from a ball that is exact but for the triangles; how far"
    " this ball is from the exact one is the mesh's own share, and stands beside it."
    " “As shipped” changes no setting; “best” sets what the engine's own"
    " documentation recommends for accuracy. An engine that is made for another purpose may do well there all the same."
)


_DERIVATIVES = (
    "How the state at the end changes with the start, gravity, the slope, the friction and the table, which is what"
    " methods that learn or fit by gradients need. The error is that of the worst of them, relative to the exact"
    " derivative. An engine's own derivatives, in each way that it has to them, stand beside differences of its whole"
    " runs: where these are good and its own are not, it is not the motion that is at fault."
)


def _of_derivatives(cells: Sequence[Cell], known: Mapping[str, Case]) -> Iterable[Markup]:
    """Yield what is said of derivatives, and their matrix."""
    if cells:
        yield Markup("<h2>Derivatives of the final state</h2>")
        yield _p(_DERIVATIVES)
        yield _table(_matrix(cells), _case_names(cells), known)


def _p(words: str) -> Markup:
    return Markup(f"<p>{escaped(words)}</p>")


def _key() -> Markup:
    """Return what the classes mean, each with its sign and colour."""
    rows = "".join(
        f'<tr><td style="background:{colour}">{sign} {escaped(name)}</td><td>{escaped(CLASSES[name])}</td></tr>'
        for name, (sign, colour) in _LOOKS.items()
    )
    return Markup(f"<table>{rows}</table><p></p>")


def _table(
    matrix: Mapping[tuple[str, str], Mapping[str, Cell]], names: Sequence[str], known: Mapping[str, Case]
) -> Markup:
    """Return the matrix of engines and cases; one cell across where nothing of an engine could be run."""
    if not matrix:
        return _p("None were run.")
    heads = "".join(
        f'<th scope="col" title="{escaped(name)}">{escaped(known[name].title if name in known else name)}</th>'
        for name in names
    )
    rows = []
    for (engine, setting), cells in matrix.items():
        head = f'<th scope="row">{escaped(engine)}</th><td>{escaped(setting)}</td>'
        reasons = {(cell.name, cell.rows[0].message) for cell in cells.values()}
        if len(reasons) == 1 and next(iter(reasons))[0] == NOT_RUN:
            inside = f'<td colspan="{len(names)}">✗ {escaped(next(iter(reasons))[1])}</td>'
        else:
            inside = "".join(_cell(cells.get(name)) for name in names)
        rows.append(f"<tr>{head}{inside}</tr>")
    return Markup(
        f'<div class="wide" tabindex="0"><table><thead><tr><th>engine</th><th>setting</th>{heads}</tr></thead>'
        f"<tbody>{''.join(rows)}</tbody></table></div>"
    )


def _cell(cell: Cell | None) -> str:
    """Return one field of the matrix; why an engine cannot is said with the case, and in the field's own title."""
    if cell is None:
        return "<td></td>"
    sign, colour = _LOOKS[cell.name]
    last, why = cell.finest, _reason(cell)
    lines = [f"{_number(last.worst)} at {1e3 * last.step:g} ms"] if math.isfinite(last.worst) else []
    lines += [f"the mesh's own: {_number(last.mesh)}"] if math.isfinite(last.mesh) else []
    lines += [f"friction {_number(last.friction)}"] if math.isfinite(last.friction) else []
    if math.isfinite(last.spin):
        lines += [f"turns round with {last.spin:.0%} of the spin" if last.spin > 0 else "does not turn round"]
    lines += [f"falls with: {cell.cause}"] if cell.cause else []
    small = "".join(f"<small>{escaped(line)}</small>" for line in lines)
    told = f' title="{escaped(why)}"' if why else ""
    return f'<td style="background:{colour}"{told}><span>{sign} {escaped(cell.name)}</span>{small}</td>'


def _reason(cell: Cell) -> str:
    """Return what was said where there are no numbers at some step."""
    return "; ".join(dict.fromkeys(row.message for row in cell.rows if row.message))


def _section(name: str, case: Case | None, cells: Sequence[Cell]) -> Markup:
    """Return what a case is about, and its curves."""
    title = f"<h3>{escaped(case.title if case else name)} <small>({escaped(name)})</small></h3>"
    about = _p(" ".join(case.about.split())) if case else ""
    drawn = [cell for cell in cells if any(math.isfinite(row.worst) for row in cell.rows)]
    picture = (
        Markup(f'<figure tabindex="0">{_svg(curves(drawn))}</figure>') if drawn else _p("No engine came to numbers.")
    )
    said = [cell for cell in cells if _reason(cell) and cell.rows[0].outcome != NOT_INSTALLED]
    reasons = dict.fromkeys(f"{cell.engine}: {_reason(cell)}" for cell in said)
    left_out = Markup(f"<ul>{''.join(f'<li>{escaped(line)}</li>' for line in reasons)}</ul>") if reasons else Markup()
    return joined([Markup(title), about, picture, beside(case, cells) if case else Markup(), left_out])


def curves(cells: Sequence[Cell]) -> Figure:
    """Draw the error over the step, and over the time of a processor that it costs.

    Parameters
    ----------
    cells : sequence of Cell
        Of one case.
    """
    from ..views.plots.sheet import BLUE, GREEN, INK, ORANGE, PURPLE, SKY, VERMILION, Sheet, look

    colours, marks = [BLUE, VERMILION, GREEN, ORANGE, PURPLE, SKY, INK], "osD^vP*X"
    engines = list(dict.fromkeys(cell.engine for cell in cells))
    with look():
        figure = Sheet(8.0, 3.4, layout="constrained")
        left, right = figure.subplots(1, 2, sharey=True)
        for cell in cells:
            rows = [row for row in cell.rows if math.isfinite(row.worst)]
            place = engines.index(cell.engine)
            first = cell.setting == next(each.setting for each in cells if each.engine == cell.engine)
            style: dict[str, Any] = {
                "color": colours[place % len(colours)],
                "marker": marks[place % len(marks)],
                "linestyle": "--" if first else "-",
                "markersize": 5,
                "linewidth": 1.4,
                "label": f"{cell.engine}, {cell.setting}",
            }
            errors = [max(row.worst, 1e-17) for row in rows]
            left.plot([row.step for row in rows], errors, **style)
            costly = [(row.seconds, error) for row, error in zip(rows, errors, strict=True) if row.seconds > 0]
            if costly:
                right.plot(*zip(*costly, strict=True), **style)
        for panel, words in ((left, "step (s)"), (right, "processor time for 1 s of motion (s)")):
            panel.set_xscale("log")
            panel.set_yscale("log")
            panel.set_xlabel(words)
        left.set_ylabel("error")
        figure.legend(*left.get_legend_handles_labels(), loc="outside right upper", fontsize=7.5)
    return figure


def _svg(figure: Figure) -> Markup:
    """Return a figure as SVG to stand in a page."""
    stream = io.StringIO()
    figure.savefig(stream, format="svg", metadata={"Date": None, "Creator": None})
    text = stream.getvalue()
    return Markup(text[text.index("<svg") :])
