"""A fit in other forms: text, Markdown, LaTeX, CSV, TOML, a dataset, a page."""

from __future__ import annotations

import base64
import html
import io
import re
from typing import TYPE_CHECKING, Any

import numpy as np

from ...errors import UnknownNameError
from ...solve.samples import Array
from .observations import unit_of
from .unknowns import OUTSIDE, of_run

if TYPE_CHECKING:
    import xarray

    from .result import Fit

HEADINGS = ("number", "value", "unit", "remark")
FORMS = ("text", "markdown", "latex", "csv")


def labels(fit: Fit) -> list[str]:
    """Return what each run is called."""
    return [model.seen.label for model in fit.problem.models]


def text(fit: Fit) -> str:
    """Return all that is said."""
    return "\n".join([fit.title, fit.verdict, in_form(fit, "text"), *fit.remarks])


def in_form(fit: Fit, form: str) -> str:
    """Return the table of numbers in a form."""
    if form not in FORMS:
        raise UnknownNameError("form of table", str(form), FORMS)
    return {"text": _plain, "markdown": _markdown, "latex": _latex, "csv": _csv}[form](fit)


def _plain(fit: Fit) -> str:
    rows = [HEADINGS, *fit.rows]
    widths = [max(len(row[i]) for row in rows) for i in range(len(HEADINGS))]
    return "\n".join("  ".join(f"{c:<{w}}" for c, w in zip(row, widths, strict=True)).rstrip() for row in rows)


def _markdown(fit: Fit) -> str:
    rows = [HEADINGS, ("---",) * len(HEADINGS), *((f"`{name}`", *rest) for name, *rest in fit.rows)]
    return "\n".join(f"| {' | '.join(row)} |" for row in rows)


def _latex(fit: Fit) -> str:
    lines = [r"\begin{tabular}{lll}", r"number & value & unit \\", r"\hline"]
    for name, value, unit, remark in fit.rows:
        shown = re.sub(r"\)e(-?\d+)$", r") \\times 10^{\1}", value).replace("±", r"\pm")
        escaped = name.replace("_", r"\_")
        said = f" ({remark})".replace("±", r"$\pm$") if remark else ""
        unit = unit.replace("^", r"\textasciicircum{}")
        lines.append(rf"\texttt{{{escaped}}} & ${shown}${said} & {unit} \\")
    return "\n".join([*lines, r"\end{tabular}"])


def _csv(fit: Fit) -> str:
    lines = ["number,value,sigma,unit,state"]
    for one in fit.estimates:
        sigma = "" if one.sigma is None else repr(one.sigma)
        lines.append(f"{one.name},{one.value!r},{sigma},{one.unit},{one.state}")
    return "\n".join(lines)


def correlation_cells(fit: Fit) -> tuple[list[list[str]], list[str]]:
    """Return the rows and the headings of the correlations."""
    from .result import correlation

    of = correlation(fit.covariance)
    rows = [[one.name, *(f"{part:z.2f}" for part in of[i])] for i, one in enumerate(fit.estimates)]
    return rows, ["", *(str(i + 1) for i in range(len(rows)))]


# The scenario


def toml(fit: Fit, run: int = 0) -> str:
    """Return the fitted scenario with errors as comments."""
    mine = of_run(fit.problem.unknowns, run)
    remarks: dict[str, list[str]] = {}
    outside = []
    for j in mine:
        key, one = fit.problem.unknowns[j].key, fit.estimates[j]
        if key.startswith(OUTSIDE):
            outside.append(f"# {one}")
        else:
            index = re.search(r"\[\d+\]$", key)
            said = f"± {one.sigma:.2g}" if one.sigma is not None else one.cells[2]
            remarks.setdefault(key[: index.start()] if index else key, []).append(
                f"{index[0]} {said}" if index else said
            )
    head = [f"# {fit.verdict}", *outside, *(f"# {one}" for one in fit.undetermined if len(one.names) > 1)]
    lines, table = [], ""
    counts: dict[str, int] = {}
    for line in fit.scenarios[run].to_toml().rstrip("\n").split("\n"):
        several, single = re.match(r"\[\[(.+)\]\]$", line), re.match(r"\[([^\[\]]+)\]$", line)
        if several:
            counts[several[1]] = counts.get(several[1], -1) + 1
            table = f"{several[1]}[{counts[several[1]]}]."
        elif single:
            table = f"{single[1]}."
        named = re.match(r"([\w-]+) = ", line)
        told = remarks.get(f"{table}{named[1]}") if named else None
        lines.append(f"{line}  # {', '.join(told)}" if told else line)
    return "\n".join([*head, *lines, ""])


# Data


def predicted(fit: Fit) -> list[Array]:
    """Return what the fit says of each value measured."""
    found = []
    for i, model in enumerate(fit.problem.models):
        mine = [float(fit.values[j]) for j in of_run(fit.problem.unknowns, i)]
        found.append(model.predict(mine, model.seen.time.size, slopes=False)[0])
    return found


def dataset(fit: Fit) -> xarray.Dataset:
    """Return data, fit, residuals and covariance as one dataset over row, column and parameter."""
    import xarray

    columns = list(dict.fromkeys(name for model in fit.problem.models for name in model.seen.columns))

    def whole(parts: list[Array]) -> Array:
        found = []
        for model, part in zip(fit.problem.models, parts, strict=True):
            filled = np.full((part.shape[0], len(columns)), np.nan)
            filled[:, [columns.index(name) for name in model.seen.columns]] = part
            found.append(filled)
        return np.concatenate(found)

    models = fit.problem.models
    measured, said = whole([one.seen.values for one in models]), whole(predicted(fit))
    sigma = whole([np.where(m.seen.known, n.sigma, np.nan) for m, n in zip(models, fit.problem.noises, strict=True)])
    each = fit.estimates
    names = [one.name for one in each]
    of_column, of_parameter = {"units": "see column_unit"}, {"units": "see unit"}  # one each: no word fits all
    variables: dict[str, Any] = {
        "measured": (("row", "column"), measured, {"long_name": "measured", **of_column}),
        "fitted": (("row", "column"), said, {"long_name": "by the fit", **of_column}),
        "residual": (("row", "column"), measured - said, {"long_name": "measured less fitted", **of_column}),
        "noise": (("row", "column"), sigma, {"long_name": "standard deviation of a value", **of_column}),
        "value": (("parameter",), fit.values, {"long_name": "fitted value", **of_parameter}),
        "sigma": (
            ("parameter",),
            np.array([np.nan if one.sigma is None else one.sigma for one in each]),
            {"long_name": "standard deviation; none where the data do not fix the number", **of_parameter},
        ),
        "covariance": (
            ("parameter", "parameter_2"),
            fit.covariance,
            {"long_name": "covariance", "units": "see unit and unit_2, whose product it is"},
        ),
    }
    units = np.array([one.unit or "1" for one in each], dtype=object)
    coordinates = {
        "time": ("row", np.concatenate([one.seen.time for one in models]), {"units": "s"}),
        "run": ("row", np.concatenate([np.full(one.seen.time.size, i) for i, one in enumerate(models)])),
        "line": ("row", np.concatenate([one.seen.rows for one in models]).astype(int)),
        "column": np.array(columns, dtype=object),
        "parameter": np.array(names, dtype=object),
        "parameter_2": np.array(names, dtype=object),
        "column_unit": ("column", np.array([unit_of(name) for name in columns], dtype=object)),
        "unit": ("parameter", units),
        "unit_2": ("parameter_2", units),
        "state": ("parameter", np.array([one.state for one in each], dtype=object)),
    }
    about = {
        "title": fit.title,
        "verdict": fit.verdict,
        "chi_square": fit.judgement.chi_square,
        "degrees_of_freedom": fit.judgement.freedom,
        "loss": fit.loss,
        "scenario": toml(fit),
        "undetermined": "\n".join(map(str, fit.undetermined)),
    }
    return xarray.Dataset(variables, coords=coordinates, attrs=about)


def as_dict(fit: Fit) -> dict[str, Any]:
    """Return all that is said as JSON takes it."""
    said = fit.judgement
    return {
        "title": fit.title,
        "answer": fit.answer,
        "verdict": fit.verdict,
        "chi_square": said.chi_square,
        "degrees_of_freedom": said.freedom,
        "faults": said.faults,
        "numbers": [
            {"name": one.name, "value": one.value, "sigma": one.sigma, "unit": one.unit, "state": one.state}
            for one in fit.estimates
        ],
        "undetermined": [
            {
                "names": list(one.names),
                "fixed": [
                    {"text": c.text, "value": c.value, "sigma": c.sigma, "unit": c.unit, "exact": c.exact}
                    for c in one.combinations
                ],
                "cures": list(one.cures),
                "text": str(one),
            }
            for one in fit.undetermined
        ],
        "outliers": [
            {"run": one.run + 1, "row": one.row, "column": one.column, "sigmas": one.off} for one in said.outliers
        ],
        "card_passed": bool(fit.card.passed),
    }


def page(fit: Fit) -> str:
    """Return a page of its own: nothing in it is fetched from anywhere."""
    picture = io.BytesIO()
    fit.plot().savefig(picture, format="png")
    encoded = base64.b64encode(picture.getvalue()).decode()
    title = html.escape(fit.title or "Fit")
    return (
        f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{title}</title>'
        "<style>body{font:16px/1.5 system-ui,sans-serif;max-width:60rem;margin:2rem auto;padding:0 1rem}"
        "img{max-width:100%}</style></head><body>"
        f"{fit._repr_html_().replace('<details>', '<details open>')}"
        f'<p><img alt="Measured and fitted motion, residuals, correlations" src="data:image/png;base64,{encoded}"></p>'
        f"<h2>Card of the fitted run</h2>{fit.card._repr_html_()}</body></html>\n"
    )
