"""Formulas of a scene, in LaTeX, as the MathML that browsers draw by themselves."""

from __future__ import annotations

import re
from functools import lru_cache
from html import escape


@lru_cache(maxsize=256)
def mathml(latex: str, *, display: bool = False) -> str:
    r"""Return a formula as markup; what cannot be converted stands there as it was written.

    Parameters
    ----------
    latex : str
        Without dollar signs.
    display : bool
        Whether it stands on a line of its own.

    Returns
    -------
    str
        A `math` element.

    Examples
    --------
    >>> mathml("k < 1").count("<mi>"), mathml(r"\frac"), mathml("")
    (1, '<code>\\frac</code>', '')
    """
    if not latex:
        return ""
    from latex2mathml import converter, exceptions

    found = [kind for kind in vars(exceptions).values() if isinstance(kind, type) and issubclass(kind, Exception)]
    refusals: tuple[type[Exception], ...] = (IndexError, KeyError, *found)
    # The converter takes the text of \text{} for markup.
    safe = latex.replace("<", r"\lt ").replace(">", r"\gt ")
    safe = re.sub(r"\\(arg|sgn)(?![a-zA-Z])", r"\\operatorname{\1}", safe)  # which it does not know
    try:
        return converter.convert(safe, display="block" if display else "inline")
    except refusals:
        return f"<code>{escape(latex)}</code>"
