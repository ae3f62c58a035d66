"""The lab's application: its routes, and what each of them asks of the workers."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Annotated

from fastapi import FastAPI, Query, Request
from fastapi.exceptions import RequestValidationError
from starlette.exceptions import HTTPException
from starlette.responses import JSONResponse, Response

from ..views.viewer.exports import FORMATS
from . import answers, exports, filming, maps, measuring, pages
from .errors import Refusal, RefusedError, of_validation
from .lanes import LeftError
from .requests import (
    JSON,
    OPENED,
    PICTURE,
    AboutScenario,
    HowToRead,
    ToDraw,
    ToExport,
    ToFit,
    ToFollow,
    ToJudge,
    ToMap,
    ToPoint,
    ToRoll,
    ToSimulate,
    ToStart,
    ToStartAny,
    ToTry,
    described,
)
from .security import Guard
from .service import Lab
from .settings import Settings

_BINARY = {"type": "string", "format": "binary"}
Name = Annotated[str, Query(max_length=300)]
Seconds = Annotated[float, Query(ge=0, le=1e6, allow_inf_nan=False)]


def create_app(settings: Settings | None = None) -> FastAPI:
    """Make the application that serves the lab.

    Examples
    --------
    >>> from starlette.testclient import TestClient
    >>> with TestClient(create_app(), base_url="http://127.0.0.1") as client:
    ...     client.get("/api/scenarios/tilted-turntable").json()["scenario"]["body"]["radius"]
    '25 mm'
    """
    chosen = settings or Settings()
    lab = Lab(chosen)

    @asynccontextmanager
    async def living(_: FastAPI) -> AsyncIterator[None]:
        starting = asyncio.create_task(lab.start())  # the page can be shown meanwhile
        try:
            yield
        finally:
            starting.cancel()
            await asyncio.wait({starting})
            await lab.stop()

    app = FastAPI(
        title="trundle lab",
        version="1",
        lifespan=living,
        docs_url=None,  # these pages would load scripts from elsewhere
        redoc_url=None,
        openapi_url="/api/openapi.json",
        separate_input_output_schemas=False,
    )
    app.state.lab = lab
    _reading(app, lab)
    _asking(app, lab)
    _judging(app, lab)
    _mapping(app, lab)
    _measuring(app, lab)
    _filming(app, lab)
    _files(app, lab)
    _refusing(app)
    pages.add_routes(app, chosen)
    app.add_middleware(Guard, settings=chosen)
    return app


def _reading(app: FastAPI, lab: Lab) -> None:
    """Add the routes that only read."""

    @app.get("/api/scenarios", **described("The scenarios that ship with trundle."))
    async def scenarios(request: Request) -> Response:
        return await lab.shared(request, answers.catalogue)

    @app.get("/api/scenarios/{name}", **described("One of them, as TOML and as JSON.", 404))
    async def scenario(request: Request, name: str) -> Response:
        return await lab.at_once(request, answers.text_of, name)

    drawn = {PICTURE: {"schema": {"type": "string"}}}

    @app.get("/api/scenarios/{name}/picture", **described("A small picture of it.", 404, content=drawn))
    async def picture(request: Request, name: str) -> Response:
        return await lab.shared(request, answers.picture_of, name)

    @app.get("/api/challenges", **described("The challenges: all that a page may know of them."))
    async def challenges(request: Request) -> Response:
        return await lab.at_once(request, answers.challenges)

    @app.get("/api/ready", **described("Whether a worker has answered yet: until then they are starting."))
    async def ready() -> Response:
        return JSONResponse({"ready": lab.ready}, headers={"cache-control": "no-store"})

    @app.get("/api/schema", **described("The JSON schema of scenario files."))
    async def schema(request: Request) -> Response:
        return await lab.shared(request, answers.schema)

    @app.get("/api/parts", **described("What a scenario may be made of: each kind of part, and all of its numbers."))
    async def parts(request: Request) -> Response:
        return await lab.shared(request, answers.parts, here=True)  # before any worker is there


def _asking(app: FastAPI, lab: Lab) -> None:
    """Add the routes that compute."""

    @app.post("/api/simulate", **described("Run a scenario: a packed scene.", scene=True))
    async def simulate(request: Request, asked: ToSimulate) -> Response:
        wanted = asked.samples, asked.card, asked.tolerance, asked.curves, asked.known
        return await lab.answer(request, answers.simulate, asked.scenario, *wanted, slow=asked.card)

    @app.post("/api/card", **described("The verification card of a run, in full precision."))
    async def card(request: Request, asked: AboutScenario) -> Response:
        return await lab.answer(request, answers.card, asked.scenario, slow=True)

    @app.post("/api/derivation", **described("How the motion follows, step by step."))
    async def derivation(request: Request, asked: AboutScenario) -> Response:
        return await lab.answer(request, answers.derivation, asked.scenario, slow=True)

    @app.post("/api/twin", **described("The charge in crossed fields that moves so: a packed scene.", scene=True))
    async def twin(request: Request, asked: ToDraw) -> Response:
        return await lab.answer(request, answers.twin, asked.scenario, asked.samples)

    @app.post("/api/start", **described("A start made by hand, in the words of a scenario."))
    async def start(request: Request, asked: ToStart) -> Response:
        at = asked.at.model_dump(exclude_none=True)
        return await lab.answer(request, answers.start, asked.scenario, at, asked.velocity, asked.nudge)

    @app.post("/api/possible", **described("Of each scenario why it cannot start; null where it can."))
    async def possible(request: Request, asked: ToStartAny) -> Response:
        return await lab.answer(request, answers.possible, asked.scenarios)

    @app.post("/api/roll", **described("Roll a ball along a curve: a packed scene.", scene=True))
    async def roll(request: Request, asked: ToRoll) -> Response:
        wanted = asked.radius, asked.curve, asked.samples, asked.card
        return await lab.answer(request, answers.roll, *wanted, slow=asked.card)


def _judging(app: FastAPI, lab: Lab) -> None:
    """Add the routes of the challenges."""

    @app.post("/api/challenges/{name}/run", **described("Run what was chosen: a packed scene.", 404, scene=True))
    async def run(request: Request, name: str, asked: ToTry) -> Response:
        return await lab.answer(request, answers.tried, name, asked.values, asked.body, asked.samples)

    @app.post("/api/challenges/{name}/answer", **described("Whether an answer is right.", 404))
    async def judge(request: Request, name: str, asked: ToJudge) -> Response:
        return await lab.answer(request, answers.judged, name, asked.values, asked.answer)


def _mapping(app: FastAPI, lab: Lab) -> None:
    """Add the routes that compute maps."""

    @app.get("/api/sweeps", **described("The sweeps that ship with trundle, and what a map may measure."))
    async def sweeps(request: Request) -> Response:
        return await lab.shared(request, maps.sweeps)

    @app.post("/api/map/numbers", **described("The numbers of a scenario that a map may go over."))
    async def numbers(request: Request, asked: AboutScenario) -> Response:
        return await lab.answer(request, maps.map_numbers, asked.scenario)

    @app.post("/api/map", **described("Go on with a map for a second: what was run, and the picture."))
    async def draw(request: Request, asked: ToMap) -> Response:
        spans = [span.model_dump(by_alias=True) for span in asked.over]
        known = asked.places, asked.values
        return await lab.answer(request, maps.draw_map, asked.scenario, spans, asked.measure, *known, slow=True)

    @app.post("/api/map/point", **described("The scenario of one field of a map."))
    async def point(request: Request, asked: ToPoint) -> Response:
        spans = [span.model_dump(by_alias=True) for span in asked.over]
        return await lab.answer(request, maps.map_point, asked.scenario, spans, asked.place)


def _measuring(app: FastAPI, lab: Lab) -> None:
    """Add the routes that read measured motion and fit it."""
    takes = {"requestBody": {"required": True, "content": {OPENED[-1]: {"schema": _BINARY}}}}

    @app.get("/api/tracks", **described("Measured tracks to try a fit on: the truth is known."))
    async def tracks(request: Request) -> Response:
        return await lab.shared(request, measuring.examples)

    @app.post("/api/track", **described("The track in a file, or what has to be said of it."), openapi_extra=takes)
    async def track(request: Request, how: Annotated[HowToRead, Query()]) -> Response:
        told = how.model_dump(exclude_none=True)
        return await lab.with_folder(request, measuring.read, await request.body(), told)

    @app.post("/api/fit", **described("Fit numbers of a scenario to measured motion."))
    async def fit(request: Request, asked: ToFit) -> Response:
        view = None if asked.view is None else asked.view.model_dump()
        wanted = asked.columns, asked.free, asked.noise, asked.title, asked.accuracy, view
        most = lab.settings.fit_time
        return await lab.answer(request, measuring.fitted, asked.scenario, *wanted, slow=True, most=most)


def _filming(app: FastAPI, lab: Lab) -> None:
    """Add the routes of films, which are kept for a while."""
    takes = {"requestBody": {"required": True, "content": {OPENED[-1]: {"schema": _BINARY}}}}
    bounds = lab.settings

    @app.get("/api/film", **described("How large a film may be, and how long it is kept and followed."))
    async def limits() -> Response:
        lab.films.check()
        most = {"bytes": bounds.film_bytes, "kept": bounds.film_life, "followed": bounds.film_time}
        return JSONResponse(most, headers={"cache-control": "no-store"})

    @app.post("/api/film", **described("Keep a film: its token, and what it says of itself."), openapi_extra=takes)
    async def take(request: Request, name: Name) -> Response:
        film = await lab.films.take(request, name, filming.ending_of(name))
        try:
            with lab.films.in_use(film):
                return await lab.answer(request, filming.looked_at, film.token, slow=True, unkept=(str(film.path),))
        except BaseException:
            lab.films.remove(film)
            raise

    @app.delete("/api/film/{token}", **described("Remove a film."))
    async def remove(token: str) -> Response:
        lab.films.remove(lab.films.find(token))
        return JSONResponse({})

    @app.get(
        "/api/film/{token}/picture",
        **described("The picture at a time.", 404, content={filming.JPEG: {"schema": _BINARY}}),
    )
    async def picture(request: Request, token: str, at: Seconds = 0.0) -> Response:
        film = lab.films.find(token)
        with lab.films.in_use(film):
            return await lab.answer(request, filming.still, token, str(film.path), at, slow=True)

    @app.get(
        "/api/film/{token}/pictures", **described("Pictures from some time on, of a film that lasts so long.", 404)
    )
    async def pictures(request: Request, token: str, length: Seconds, begin: Seconds = 0.0) -> Response:
        film = lab.films.find(token)
        with lab.films.in_use(film):
            return await lab.answer(request, filming.reel, token, str(film.path), begin, length, slow=True)

    @app.get("/api/film/{token}/progress", **described("How much of it has been followed, 0 to 1.", 404))
    async def progress(token: str) -> Response:
        return JSONResponse({"done": lab.films.find(token).progress}, headers={"cache-control": "no-store"})

    @app.post("/api/film/{token}/track", **described("Follow the ball through it.", 404))
    async def follow(request: Request, token: str, asked: ToFollow) -> Response:
        film = lab.films.find(token)
        with lab.films.in_use(film, follow=True):
            film.forget_progress()
            wanted = token, asked.model_dump(exclude_none=True)
            unkept = str(film.path), film.name
            return await lab.answer(request, filming.followed, *wanted, slow=True, unkept=unkept, most=bounds.film_time)


def _files(app: FastAPI, lab: Lab) -> None:
    """Add the routes that give files and take them."""
    media_types = {form.media_type for form in FORMATS.values()}
    kinds = {kind: {"schema": _BINARY} for kind in sorted(media_types)}
    takes = {kind: {"schema": _BINARY} for kind in OPENED}

    @app.post("/api/export", **described("A scenario, or its run, as a file.", content=kinds))
    async def export(request: Request, asked: ToExport) -> Response:
        return await lab.with_folder(request, exports.export, asked.scenario, asked.format)

    body = {"requestBody": {"required": True, "content": takes}}

    @app.post("/api/open", **described("The scenario in a TOML file or a run.nc."), openapi_extra=body)
    async def opened(request: Request) -> Response:
        return await lab.with_folder(request, exports.opened, await request.body())


def _refusing(app: FastAPI) -> None:
    """Let every error be told in the one form."""

    @app.exception_handler(RefusedError)
    async def refused(_: Request, error: RefusedError) -> Response:
        return _refusal(error.refusal)

    @app.exception_handler(RequestValidationError)
    async def invalid(_: Request, error: RequestValidationError) -> Response:
        return _refusal(of_validation(error.errors()))

    @app.exception_handler(HTTPException)
    async def other(_: Request, error: HTTPException) -> Response:
        status = 422 if error.status_code == 400 else error.status_code
        message = {404: "There is no such address here.", 405: "This address is not asked in this way."}
        told = Refusal(status, message.get(status, str(error.detail)), None, "HTTPError")
        return _refusal(told, dict(error.headers or {}))

    @app.exception_handler(LeftError)
    async def left(_: Request, error: LeftError) -> Response:  # noqa: ARG001
        return Response(status_code=499)  # nobody reads it

    @app.exception_handler(Exception)
    async def mistake(_: Request, error: Exception) -> Response:
        return _refusal(Refusal(500, f"This is a bug in trundle, {type(error).__name__}.", None, "BugError"))


def _refusal(refusal: Refusal, headers: dict[str, str] | None = None) -> Response:
    return Response(refusal.body, refusal.status, {**(headers or {}), **dict(refusal.headers)}, JSON)
