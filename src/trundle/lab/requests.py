"""What may be asked, and what each route says of itself in the OpenAPI schema."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator
from starlette.responses import Response

from ..views.viewer.exports import FORMATS
from .limits import MOST_FIELDS, MOST_ROWS, MOST_SAMPLES, MOST_SIDE, MOST_TRIED

if TYPE_CHECKING:
    Ending = str
else:
    Ending = Literal[tuple(ending.removeprefix(".") for ending in FORMATS)]

SCENE, JSON, PICTURE = "application/octet-stream", "application/json", "image/svg+xml"
OPENED = ("text/plain", "application/octet-stream")  # and any other: what it is, its content tells


EXAMPLE: dict[str, Any] = {
    "title": "Ball on a record player",
    "body": {"kind": "solid-sphere", "radius": "20 mm", "mass": "260 g"},
    "support": {"kind": "plane", "rim": "15 cm", "motion": {"kind": "spin", "rate": "33.3 rpm"}},
    "start": {"position": ["8 cm", 0], "velocity": [0, "3 cm/s"]},
    "run": {"duration": "5 s", "every": "20 ms"},
}


class _Asked(BaseModel):
    model_config = ConfigDict(extra="forbid")


Tables = Annotated[
    dict[str, Any],
    Field(description="A scenario, as its TOML file says it; `/api/schema` describes it.", examples=[EXAMPLE]),
]
Samples = Annotated[int | None, Field(ge=2, le=MOST_SAMPLES, description="How many samples to show at most.")]


Tolerance = Annotated[
    float | None,
    Field(
        ge=1e-15, le=1e-3, description="Of a numerical method, relative, for each step; absent: the finest there is."
    ),
]


class AboutScenario(_Asked):
    """A question about one scenario."""

    scenario: Tables


class ToStartAny(_Asked):
    """Scenarios of which it is asked whether they can start."""

    scenarios: Annotated[list[Tables], Field(min_length=1, max_length=MOST_TRIED)]


class ToDraw(AboutScenario):
    """A scenario to be drawn."""

    samples: Samples = None
    card: bool = Field(default=False, description="Whether to verify the run, which takes seconds.")


_MeshName = Annotated[str, Field(max_length=64)]


class ToSimulate(ToDraw):
    """A scenario to be run and drawn."""

    tolerance: Tolerance = None
    curves: bool = Field(default=True, description="Whether to send what may be drawn over time, a third of a scene.")
    known: Annotated[list[_MeshName], Field(max_length=64)] | None = Field(
        default=None, description="Names of meshes that came before: they are not sent again, in whatever size."
    )


_Finite = Annotated[float, Field(allow_inf_nan=False)]
Triple = Annotated[list[_Finite], Field(min_length=3, max_length=3)]


class Put(_Asked):
    """A body at an instant, in the inertial support frame, SI; the velocities and the orientation for a nudge only."""

    position: Triple = Field(description="Of the centre of mass.")
    contact: Triple
    velocity: Triple | None = None
    angular_velocity: Triple | None = None
    orientation: Annotated[list[_Finite], Field(min_length=4, max_length=4)] | None = None
    time: _Finite = 0.0
    support: Annotated[list[_Finite], Field(max_length=16)] = Field(
        default=[], description="The coordinates of the support's own motion."
    )
    height: _Finite | None = Field(default=None, description="Over the support; absent: it touches.")

    @model_validator(mode="after")
    def _check(self) -> Self:
        if self.height is not None and self.height < 0:
            raise ValueError("height must not be negative")
        return self


class ToStart(AboutScenario):
    """A start made by hand: the body is dragged there; or thrown from there; or nudged there, and goes on."""

    at: Put
    velocity: Triple | None = Field(default=None, description="With which it is thrown.")
    nudge: Triple | None = Field(default=None, description="What is added to its velocity.")

    @model_validator(mode="after")
    def _check(self) -> Self:
        known = (self.at.velocity, self.at.angular_velocity, self.at.orientation)
        if self.nudge is not None and None in known:
            raise ValueError("a nudge needs velocity, angular_velocity and orientation")
        return self


class ToRoll(_Asked):
    """A ball to be rolled along a curve on a plane."""

    radius: float | Annotated[str, Field(max_length=200)] = Field(description="Of the ball: m, or a text with a unit.")
    curve: dict[str, Any] = Field(description="One piece, as a [[path]] table says it, or several under `path`.")
    samples: Samples = None
    card: bool = False


class ToExport(AboutScenario):
    """A scenario to be saved in some format."""

    format: Ending


_Chosen = Annotated[dict[Annotated[str, Field(max_length=40)], _Finite], Field(max_length=20)]


class ToTry(_Asked):
    """What a learner chose in a challenge, to be run."""

    values: _Chosen = Field(default={}, description="By the names of the challenge's controls, in their units.")
    body: Annotated[str, Field(max_length=80)] = Field(default="", description="Which, where there are several.")
    samples: Samples = None


class ToJudge(_Asked):
    """An answer to a challenge."""

    values: _Chosen = {}
    answer: _Finite | Annotated[str, Field(max_length=80)] | None = None


_Word = Annotated[str, Field(max_length=200)]
_Spelt = _Finite | Annotated[str, Field(max_length=200)]
Row = Annotated[list[_Finite | None], Field(max_length=MOST_FIELDS)]


class Span(_Asked):
    """One side of a map: a number of the scenario, and how far it goes."""

    key: str = Field(max_length=200, description="Of the number, such as `start.angular_velocity[2]`.")
    start: _Spelt = Field(alias="from", description="SI, or a text with a unit.")
    end: _Spelt = Field(alias="to")
    count: int = Field(ge=2, le=MOST_SIDE)
    scale: Literal["linear", "log"] = "linear"


class ToPoint(AboutScenario):
    """A point of a map: one member of a sweep over two numbers of a scenario."""

    over: Annotated[list[Span], Field(min_length=2, max_length=2)]
    place: int = Field(ge=0, lt=MOST_FIELDS, description="Of the field: the second number runs first.")


class ToMap(AboutScenario):
    """A map that is to be computed, or gone on with."""

    over: Annotated[list[Span], Field(min_length=2, max_length=2)]
    measure: str = Field(max_length=500, description="What is measured of each member, such as `max hypot(x, y)`.")
    places: Annotated[list[Annotated[int, Field(ge=0, lt=MOST_FIELDS)]], Field(max_length=MOST_FIELDS)] = Field(
        default=[], description="Fields that are known already."
    )
    values: Row = Field(default=[], description="What was found there; null: there is no value.")

    @model_validator(mode="after")
    def _check(self) -> Self:
        if len(self.places) != len(self.values):
            raise ValueError("places and values must be of one length")
        return self


class ToFit(AboutScenario):
    """Measured motion, and the numbers that are to be found from it."""

    columns: dict[Annotated[str, Field(max_length=40)], Annotated[list[_Finite | None], Field(max_length=MOST_ROWS)]]
    title: Annotated[str, Field(max_length=200)] = Field(default="data", description="Of the track.")
    free: Annotated[list[Annotated[str, Field(max_length=200)]], Field(max_length=20)] = []
    noise: Annotated[str, Field(max_length=40)] | None = Field(
        default=None, description="Standard deviation of a value, with a unit; absent: estimated."
    )
    accuracy: Annotated[_Finite, Field(ge=0, le=1)] = Field(
        default=0.0, description="By how much a camera may shift all that it sees at one place, m."
    )
    view: View | None = Field(default=None, description="Of a film, in which the fitted ball is to be drawn.")


class View(_Asked):
    """The camera of a film, as it was found: focal length and axis in px, rotation vector, place of the lens, SI."""

    focal: Annotated[_Finite, Field(gt=0)]
    centre: Annotated[list[_Finite], Field(min_length=2, max_length=2)]
    turn: Triple
    place: Triple
    distortion: _Finite
    ball: Annotated[_Finite, Field(gt=0, description="Radius of the ball.")]


_Length = _Finite | Annotated[str, Field(max_length=60)]
_Colour = Annotated[str, Field(max_length=40)]


class ToFollow(_Asked):
    """What a film does not say of itself; as of `trundle.track_film`."""

    ball_radius: _Length
    rim_radius: _Length | None = None
    marks: Annotated[list[Annotated[list[_Length], Field(min_length=4, max_length=4)]], Field(max_length=40)] | None = (
        Field(default=None, description="Each two pixels, to the right and down, and two lengths.")
    )
    height: _Length | None = None
    focal: _Finite | None = None
    distortion: _Finite = 0.0
    colour: _Colour | None = None
    mark_colour: _Colour | None = None
    table_rate: _Length | None = None
    slow: _Finite | None = None
    frame_rate: _Finite | None = None
    readout: _Length | None = None
    begin: _Length | None = None
    end: _Length | None = None


class HowToRead(_Asked):
    """What a file with a track does not say of itself; as of `trundle.read_track`."""

    name: Annotated[str, Field(max_length=300)] = Field(description="Of the file: its ending says what it is.")
    track: _Word | None = None
    columns: _Word | None = Field(default=None, description="Names that do not tell: `t=frame_time, x=u`.")
    units: _Word | None = Field(default=None, description="Of places, such as cm.")
    time: _Word | None = Field(default=None, description="Unit of the time: ms, or frame.")
    angles: _Word | None = None
    rate: _Word | None = Field(default=None, description="Frames a second.")
    pixel: _Word | None = Field(default=None, description="The size of one, such as 0.8 mm.")
    y: Literal["up", "down"] | None = None
    sense: Literal["clockwise", "anticlockwise"] | None = None
    decimal: Literal["point", "comma"] | None = None


class Told(BaseModel):
    """What is wrong."""

    message: str
    key: str | None
    kind: str


class Wrong(BaseModel):
    """An answer that is an error."""

    error: Told


_MEANINGS = {
    400: "The request cannot be read.",
    403: "Asked by a page of another origin.",
    404: "There is no such thing.",
    408: "The request did not arrive in time.",
    413: "The request is too long.",
    421: "Asked for another host.",
    422: "What was sent is not as it should be; the message says what.",
    429: "You ask for more at once than one visitor may; Retry-After says when to ask again.",
    503: "Too many ask at once.",
    504: "It takes too long.",
}


def described(summary: str, *more: int, scene: bool = False, content: dict[str, Any] | None = None) -> dict[str, Any]:
    """Return what a route says of itself in the OpenAPI schema.

    Examples
    --------
    >>> sorted(described("One of them.", 404)["responses"])[:3]
    [200, 304, 403]
    """
    told: dict[int | str, dict[str, Any]] = {
        status: {"model": Wrong, "description": _MEANINGS[status]}
        for status in (403, 408, 413, 421, 422, 429, 503, 504, *more)
    }
    binary = {"schema": {"type": "string", "format": "binary"}}
    told[200] = {"description": "What was asked for.", "content": content or ({SCENE: binary} if scene else {JSON: {}})}
    told[304] = {"description": "The asker has this answer already."}
    return {"summary": summary, "responses": told, "response_class": Response}
