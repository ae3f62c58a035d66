"""A derivation as the lab's page shows it: steps with their formulas, and the constants in numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ..analysis.derivation.steps import Number
    from ..simulation.simulate import Scenario

_COMPLEX = ", as a complex number"
_OF_THE_FORM = ("The path", "The closed form is a solution")


def derivation_of(scenario: Scenario) -> dict[str, Any]:
    """Derive the motion of a scenario.

    Examples
    --------
    >>> import trundle as tr
    >>> told = derivation_of(tr.Scenario.load("tilted-turntable"))
    >>> [number["value"] for number in told["numbers"] if number["symbol"] == "k"], told["steps"][-1]["source"]
    ([0.4], 'T5')
    """
    from ..analysis.derivation import derive
    from ..analysis.derivation.forms import form_of

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
        row for made, shown in zip(found.numbers, told["numbers"], strict=True) for row in rows_of(made, shown["latex"])
    ]
    return {"title": told["title"], "introduction": told["introduction"], "steps": steps, "numbers": numbers}


def rows_of(number: Number, symbol: str) -> list[dict[str, Any]]:
    r"""Return one row for a number, two for a complex one: its parts lie along the first and the second axis.

    Examples
    --------
    >>> from trundle.analysis.derivation.steps import Number
    >>> from trundle.analysis.derivation.symbols import v_d
    >>> [row["name"] for row in rows_of(Number(v_d, 1.0 + 2.0j, "m/s"), "v_d")][0]
    'velocity at which the circle drifts, along the first axis'
    """
    from ..analysis.derivation.symbols import MEANINGS

    name = MEANINGS.get(number.symbol, ("", ""))[0].removesuffix(_COMPLEX)
    unit = "" if number.unit == "1" else number.unit
    if not isinstance(number.value, complex):
        return [{"name": name, "symbol": symbol, "value": float(number.value), "unit": unit}]
    parts = (("Re", "first", number.value.real), ("Im", "second", number.value.imag))
    return [
        {
            "name": f"{name}, along the {which} axis",
            "symbol": rf"\operatorname{{{part}}} {symbol}",
            "value": value,
            "unit": unit,
        }
        for part, which, value in parts
    ]
