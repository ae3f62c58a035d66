"""Physics engines against motions that are known exactly: the cases, the adapters, and the score."""

from .case import Case, Motion, cases
from .measuring import Errors
from .models import engine_model
from .pushed_box import PushedBox
from .results import Row, Score
from .rolling import Rolling
from .scoring import Entrant, score

__all__ = [
    "Case",
    "Entrant",
    "Errors",
    "Motion",
    "PushedBox",
    "Rolling",
    "Row",
    "Score",
    "cases",
    "engine_model",
    "score",
]
