"""Is the motion regular? Sections, Lyapunov exponents, periodic orbits."""

from .crossings import poincare_section
from .exponents import lyapunov_exponents
from .section import PoincareSection
from .spectrum import LyapunovExponents

__all__ = ["LyapunovExponents", "PoincareSection", "lyapunov_exponents", "poincare_section"]
