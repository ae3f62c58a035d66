"""A derivation as the lab's page shows it: steps with their formulas, and the constants in numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ..simulation import Scenario

_OF_THE_FORM = ("The path", "The closed form is a solution")


def derivation_of(scenario: Scenario) -> dict[str, Any]:
    """Derive the motion of a scenario.

    Parameters
    ----------
    scenario : Scenario
        Any.

    Returns
    -------
    dict
        `title`, `introduction`, `steps` (each `title`, `text` with formulas between dollars, `latex`, `source`) and
        `numbers` (each `name`, `symbol` in LaTeX, `value`, `unit`; none where no closed form covers the motion).

    Examples
    --------
    >>> import trundle as tr
    >>> told = derivation_of(tr.Scenario.load("tilted-turntable"))
    >>> [number["value"] for number in told["numbers"] if number["symbol"] == "k"], told["steps"][-1]["source"]
    ([0.4], 'T5')
    """
    from ..derivation import derive
    from ..derivation.forms import form_of

    form, _ = form_of(scenario.system(), scenario.start_state())
    found = derive(scenario, with_numbers=form is not None)
    told = found.as_dict()
    steps = [
        {
            "title": step["title"],
            "text": step["sentence"],
            "latex": [equation["latex"] for equation in step["equations"]],
            "source": form.equation if form is not None and step["title"].startswith(_OF_THE_FORM) else None,
        }
        for step in told["steps"]
    ]
    numbers = [
        row for made, shown in zip(found.numbers, told["numbers"], strict=True) for row in _rows(made, shown["latex"])
    ]
    return {"title": told["title"], "introduction": told["introduction"], "steps": steps, "numbers": numbers}


def _rows(number: Any, symbol: str) -> list[dict[str, Any]]:
    """Return one row for a number, two for a complex one: its parts lie along the first and the second axis."""
    from ..derivation.symbols import MEANINGS

    name = MEANINGS.get(number.symbol, ("", ""))[0].removesuffix(", as a complex number")
    unit = "" if number.unit == "1" else number.unit
    if not isinstance(number.value, complex):
        return [{"name": name, "symbol": symbol, "value": float(number.value), "unit": unit}]
    parts = (("Re", "first", number.value.real), ("Im", "second", number.value.imag))
    return [
        {
            "name": f"{name}, along the {which} axis".removeprefix(", "),
            "symbol": rf"\operatorname{{{part}}} {symbol}",
            "value": value,
            "unit": unit,
        }
        for part, which, value in parts
    ]
