"""Which numbers of a scenario a measured track tells, and how well."""

from .alternatives import Alternative, Alternatives
from .api import fit
from .camera import Camera
from .plan import FitPlan, plan_fit
from .result import Estimate, Fit
from .sampling import Samples

__all__ = ["Alternative", "Alternatives", "Camera", "Estimate", "Fit", "FitPlan", "Samples", "fit", "plan_fit"]
