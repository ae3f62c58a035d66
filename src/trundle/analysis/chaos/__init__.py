"""Is the motion regular? Sections, Lyapunov exponents, periodic orbits."""

from .exponents import lyapunov_exponents
from .spectrum import LyapunovExponents

__all__ = ["LyapunovExponents", "lyapunov_exponents"]
