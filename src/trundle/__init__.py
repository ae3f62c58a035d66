"""The dynamics of bodies that roll without slipping."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from . import conformance, tracks, units
    from .analysis.analogy import ChargedParticle, Twin, to_turntable, twin
    from .analysis.chaos import (
        BifurcationDiagram,
        LyapunovExponents,
        OrbitBranch,
        PeriodicOrbit,
        PoincareSection,
        StartMap,
        basins_of_attraction,
        bifurcation_diagram,
        lyapunov_exponents,
        lyapunov_map,
        periodic_orbit,
        poincare_section,
    )
    from .analysis.checking import Check, Mistake, check, check_equations
    from .analysis.derivation import derive
    from .analysis.fit import Camera, Estimate, Fit, FitPlan, fit, plan_fit
    from .analysis.geometry import Arc, Curve, PathScenario, RolledPath, Rotation, Straight, roll_along
    from .analysis.holonomy import ConstraintAnalysis, PfaffianSystem
    from .analysis.imperfections import Sensitivity, air_drag, sensitivity
    from .analysis.many import Starts, place_many, simulate_many
    from .analysis.sensitivities import Sensitivities, sensitivities
    from .analysis.statics import Equilibria, Equilibrium, equilibria
    from .analysis.steady import PeriodicMotion, SteadyMotion, SteadyMotions, periodic_motion, steady_motions
    from .analysis.sweep import Sweep, Tolerance, sweep, tolerance
    from .analysis.vakonomic import VakonomicComparison, VakonomicPath, compare_vakonomic, vakonomic_path
    from .errors import (
        InvalidValueError,
        MissingExtraError,
        OutOfDomainError,
        ScenarioError,
        SolverError,
        TrundleError,
        UnknownNameError,
    )
    from .fields import MotionFormula, VectorField
    from .mechanics.bodies import Body, Isotropic, Principal, RatioInertia, Tensor
    from .mechanics.loads import (
        Drag,
        Force,
        Load,
        Magnus,
        Motor,
        PivotFriction,
        Potential,
        QuadraticDrag,
        RollingCouple,
        RollingResistance,
        Torque,
    )
    from .mechanics.motions import (
        Combined,
        Fixed,
        FreeAxle,
        Motion,
        Move,
        PrecessingTilt,
        Rock,
        Shake,
        Spin,
        SpinBy,
        Tilt,
        UnevenSpin,
        Wobble,
    )
    from .mechanics.shapes import (
        CylinderShape,
        Disc,
        Ellipsoid,
        HalfCylinder,
        Hemisphere,
        Shape,
        Sphere,
        SupportFunction,
        Torus,
    )
    from .mechanics.surfaces import (
        Bowl,
        Cone,
        Cylinder,
        Dome,
        EllipsoidalBowl,
        HeightField,
        Paraboloid,
        Plane,
        Revolution,
        Surface,
        TorusTrack,
    )
    from .mechanics.system import RollingSystem, State, Support
    from .simulation.simulate import Scenario, simulate
    from .simulation.trajectory import Event, Trajectory
    from .solve.exact import ClosedForm
    from .tracks import Track, read_track
    from .tracks.film import FilmTrack, track_film
    from .verify import Card

# Public name -> module that holds it: `import trundle` loads nothing until a name is used.
_HOMES = {
    "analysis.analogy": ("ChargedParticle", "Twin", "twin", "to_turntable"),
    "analysis.chaos": (
        "lyapunov_exponents",
        "LyapunovExponents",
        "poincare_section",
        "PoincareSection",
        "periodic_orbit",
        "PeriodicOrbit",
        "OrbitBranch",
        "lyapunov_map",
        "basins_of_attraction",
        "bifurcation_diagram",
        "BifurcationDiagram",
        "StartMap",
    ),
    "errors": (
        "TrundleError",
        "InvalidValueError",
        "MissingExtraError",
        "ScenarioError",
        "OutOfDomainError",
        "SolverError",
        "UnknownNameError",
    ),
    "analysis.geometry": ("roll_along", "Straight", "Arc", "Curve", "RolledPath", "Rotation", "PathScenario"),
    "analysis.holonomy": ("PfaffianSystem", "ConstraintAnalysis"),
    "analysis.imperfections": ("sensitivity", "Sensitivity", "air_drag"),
    "analysis.many": ("place_many", "Starts", "simulate_many"),
    "fields": ("VectorField", "MotionFormula"),
    "mechanics.bodies": ("Body", "Isotropic", "Principal", "RatioInertia", "Tensor"),
    "mechanics.shapes": (
        "Disc",
        "Ellipsoid",
        "HalfCylinder",
        "Hemisphere",
        "CylinderShape",
        "Shape",
        "Sphere",
        "SupportFunction",
        "Torus",
    ),
    "mechanics.surfaces": (
        "Bowl",
        "Cone",
        "Cylinder",
        "Dome",
        "EllipsoidalBowl",
        "HeightField",
        "Paraboloid",
        "Plane",
        "Revolution",
        "Surface",
        "TorusTrack",
    ),
    "mechanics.motions": (
        "Combined",
        "Fixed",
        "FreeAxle",
        "Motion",
        "Move",
        "PrecessingTilt",
        "Rock",
        "Shake",
        "Spin",
        "SpinBy",
        "Tilt",
        "UnevenSpin",
        "Wobble",
    ),
    "mechanics.loads": (
        "Drag",
        "Force",
        "Load",
        "Magnus",
        "Motor",
        "PivotFriction",
        "Potential",
        "QuadraticDrag",
        "RollingCouple",
        "RollingResistance",
        "Torque",
    ),
    "mechanics.system": ("RollingSystem", "State", "Support"),
    "solve.exact": ("ClosedForm",),
    "analysis.derivation": ("derive",),
    "simulation.simulate": ("simulate", "Scenario"),
    "analysis.fit": ("fit", "plan_fit", "Fit", "FitPlan", "Estimate", "Camera"),
    "analysis.sensitivities": ("sensitivities", "Sensitivities"),
    "analysis.statics": ("equilibria", "Equilibria", "Equilibrium"),
    "analysis.steady": ("steady_motions", "SteadyMotions", "SteadyMotion", "periodic_motion", "PeriodicMotion"),
    "simulation.trajectory": ("Trajectory", "Event"),
    "analysis.sweep": ("sweep", "Sweep", "tolerance", "Tolerance"),
    "analysis.vakonomic": ("compare_vakonomic", "vakonomic_path", "VakonomicComparison", "VakonomicPath"),
    "tracks": ("read_track", "Track"),
    "tracks.film": ("track_film", "FilmTrack"),
    "verify": ("Card",),
    "analysis.checking": ("check", "check_equations", "Check", "Mistake"),
}
_ROOMS = ("conformance", "tracks", "units")  # public as a whole
_HOME_OF = {name: home for home, names in _HOMES.items() for name in names}

__all__ = [
    "Arc",
    "BifurcationDiagram",
    "Body",
    "Bowl",
    "Camera",
    "Card",
    "ChargedParticle",
    "Check",
    "ClosedForm",
    "Combined",
    "Cone",
    "ConstraintAnalysis",
    "Curve",
    "Cylinder",
    "CylinderShape",
    "Disc",
    "Dome",
    "Drag",
    "Ellipsoid",
    "EllipsoidalBowl",
    "Equilibria",
    "Equilibrium",
    "Estimate",
    "Event",
    "FilmTrack",
    "Fit",
    "FitPlan",
    "Fixed",
    "Force",
    "FreeAxle",
    "HalfCylinder",
    "HeightField",
    "Hemisphere",
    "InvalidValueError",
    "Isotropic",
    "Load",
    "LyapunovExponents",
    "Magnus",
    "MissingExtraError",
    "Mistake",
    "Motion",
    "MotionFormula",
    "Motor",
    "Move",
    "OrbitBranch",
    "OutOfDomainError",
    "Paraboloid",
    "PathScenario",
    "PeriodicMotion",
    "PeriodicOrbit",
    "PfaffianSystem",
    "PivotFriction",
    "Plane",
    "PoincareSection",
    "Potential",
    "PrecessingTilt",
    "Principal",
    "QuadraticDrag",
    "RatioInertia",
    "Revolution",
    "Rock",
    "RolledPath",
    "RollingCouple",
    "RollingResistance",
    "RollingSystem",
    "Rotation",
    "Scenario",
    "ScenarioError",
    "Sensitivities",
    "Sensitivity",
    "Shake",
    "Shape",
    "SolverError",
    "Sphere",
    "Spin",
    "SpinBy",
    "StartMap",
    "Starts",
    "State",
    "SteadyMotion",
    "SteadyMotions",
    "Straight",
    "Support",
    "SupportFunction",
    "Surface",
    "Sweep",
    "Tensor",
    "Tilt",
    "Tolerance",
    "Torque",
    "Torus",
    "TorusTrack",
    "Track",
    "Trajectory",
    "TrundleError",
    "Twin",
    "UnevenSpin",
    "UnknownNameError",
    "VakonomicComparison",
    "VakonomicPath",
    "VectorField",
    "Wobble",
    "__version__",
    "air_drag",
    "basins_of_attraction",
    "bifurcation_diagram",
    "check",
    "check_equations",
    "compare_vakonomic",
    "conformance",
    "derive",
    "equilibria",
    "fit",
    "lyapunov_exponents",
    "lyapunov_map",
    "periodic_motion",
    "periodic_orbit",
    "place_many",
    "plan_fit",
    "poincare_section",
    "read_track",
    "roll_along",
    "sensitivities",
    "sensitivity",
    "simulate",
    "simulate_many",
    "steady_motions",
    "sweep",
    "to_turntable",
    "tolerance",
    "track_film",
    "tracks",
    "twin",
    "units",
    "vakonomic_path",
]


def __getattr__(name: str) -> Any:
    if name in _HOME_OF:
        value = getattr(import_module(f".{_HOME_OF[name]}", __name__), name)
    elif name in _ROOMS:
        value = import_module(f".{name}", __name__)
    elif name == "__version__":
        from importlib.metadata import version

        value = version("trundle")
    elif name.startswith("_"):
        raise AttributeError(name)
    else:
        from .errors import UnknownNameError

        raise UnknownNameError("name in trundle", name, sorted(_HOME_OF))
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
