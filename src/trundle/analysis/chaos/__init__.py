"""Is the motion regular? Sections, Lyapunov exponents, periodic orbits."""

from .branch import OrbitBranch
from .crossings import poincare_section
from .exponents import lyapunov_exponents
from .orbit import PeriodicOrbit, periodic_orbit
from .section import PoincareSection
from .spectrum import LyapunovExponents

__all__ = [
    "LyapunovExponents",
    "OrbitBranch",
    "PeriodicOrbit",
    "PoincareSection",
    "lyapunov_exponents",
    "periodic_orbit",
    "poincare_section",
]
