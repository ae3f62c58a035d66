"""A number that theory promises beside the same number as the samples show it."""

from __future__ import annotations

import math
from dataclasses import KW_ONLY, dataclass
from typing import Any


@dataclass(frozen=True)
class Finding:
    r"""One number, predicted and measured.

    Parameters
    ----------
    name : str
        What it is.
    symbol : str
        In LaTeX.
    predicted, measured : float or None
        By the closed form's constants, and from the samples alone; None where there is none.
    unit : str
        Of both.
    note : str
        What it means, or how it was measured.
    scale : float, optional
        Against which a difference is small or not; absent: the size of what was predicted.
    said : str
        What happens, in a sentence with `{}` for the number and its unit; empty of a number that is not what one sees.

    Examples
    --------
    >>> Finding("Angular rate of the circle", r"\kappa", 1.0, 1.001, "rad/s").as_dict()["difference"]
    0.001
    """

    name: str
    symbol: str
    predicted: float | None
    measured: float | None
    unit: str = ""
    _: KW_ONLY
    note: str = ""
    scale: float | None = None
    said: str = ""

    @property
    def difference(self) -> float | None:
        """Measured less predicted as a share of the scale; None where one of them is missing, or the scale is 0."""
        if self.predicted is None or self.measured is None:
            return None
        scale = abs(self.predicted) if self.scale is None else self.scale
        off = abs(self.measured - self.predicted)
        if not math.isfinite(off):
            return None
        return 0.0 if off == 0 else float(f"{off / scale:.3g}") if scale > 0 else None

    def as_dict(self) -> dict[str, Any]:
        """Return it as a scene's header holds it."""
        return {
            "name": self.name,
            "symbol": self.symbol,
            "predicted": self.predicted,
            "measured": self.measured,
            "unit": self.unit,
            "difference": self.difference,
            "note": self.note,
        }
