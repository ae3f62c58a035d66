"""Is the motion regular? Sections, Lyapunov exponents, periodic orbits, maps over starts."""

from .bifurcation import BifurcationDiagram, bifurcation_diagram
from .branch import OrbitBranch
from .crossings import poincare_section
from .exponents import lyapunov_exponents
from .maps import StartMap, basins_of_attraction, lyapunov_map
from .orbit import PeriodicOrbit, periodic_orbit
from .section import PoincareSection
from .spectrum import LyapunovExponents

__all__ = [
    "BifurcationDiagram",
    "LyapunovExponents",
    "OrbitBranch",
    "PeriodicOrbit",
    "PoincareSection",
    "StartMap",
    "basins_of_attraction",
    "bifurcation_diagram",
    "lyapunov_exponents",
    "lyapunov_map",
    "periodic_orbit",
    "poincare_section",
]
