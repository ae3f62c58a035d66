"""All faults that are planted, and those that no card can tell."""

from __future__ import annotations

from .of_jolts import JOLTS
from .of_landings import LANDINGS
from .of_phases import PHASES
from .of_the_law import LAW
from .of_what_it_takes import TAKEN
from .that_no_card_tells import SHARED

PLANTED = (*LAW, *TAKEN, *PHASES, *LANDINGS, *JOLTS)

__all__ = ["PLANTED", "SHARED"]
