"""What the lab answers where it cannot do what was asked: one form of JSON, and the status that goes with it."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any

from ..errors import InvalidValueError, ScenarioError, TrundleError, shown


@dataclass(frozen=True)
class Refusal:
    """An answer that is an error, as a worker sends it.

    Examples
    --------
    >>> Refusal(413, "too big", "body").body
    b'{"error": {"message": "too big", "key": "body", "parts": [], "kind": "RequestError"}}'
    """

    status: int  # of HTTP
    message: str  # for the reader
    key: str | None = None  # the key of the scenario that is meant
    kind: str = "RequestError"  # the kind of error
    headers: tuple[tuple[str, str], ...] = ()  # that the answer carries besides
    parts: tuple[dict[str, str], ...] = ()  # key, rule, value received and remedy apart, for another language

    @property
    def body(self) -> bytes:
        """The JSON, in ASCII: what was received may hold half a character."""
        return json.dumps({"error": {**self.told, "kind": self.kind}}).encode("ascii")

    @property
    def told(self) -> dict[str, Any]:
        """What is wrong, as a page is told."""
        return {"message": self.message, "key": self.key, "parts": list(self.parts)}


class RefusedError(TrundleError):
    """Carries a refusal through the server."""

    def __init__(self, refusal: Refusal) -> None:
        super().__init__(refusal.message)
        self.refusal = refusal


def refused(
    status: int, message: str, key: str | None = None, kind: str = "RequestError", *, after: int | None = None
) -> RefusedError:
    """Return a refusal to raise.

    Examples
    --------
    >>> refused(413, "too big").refusal.status
    413
    """
    headers = () if after is None else (("retry-after", str(after)),)
    return RefusedError(Refusal(status, message, key, kind, headers))


def refusal_of(error: BaseException) -> Refusal | None:
    """Return what to answer to an error of the package, or None where the error is a mistake of ours.

    Examples
    --------
    >>> from trundle.errors import ScenarioError
    >>> refusal_of(ScenarioError("body.mass", "must be positive", -1)).key
    'body.mass'
    """
    if isinstance(error, RefusedError):
        return error.refusal
    if isinstance(error, TrundleError):
        key = getattr(error, "key", None)
        parts = _parts(error) if isinstance(error, InvalidValueError) else ()
        return Refusal(422, str(error), str(key) if key else None, type(error).__name__, parts=parts)
    if isinstance(error, RecursionError):
        return Refusal(422, "`scenario` nests too deep. A scenario is a page of plain tables.", "scenario")
    if isinstance(error, MemoryError):
        return Refusal(422, "This takes more memory than there is. Ask for fewer samples.", "run", "MemoryError")
    return None


def _parts(error: InvalidValueError) -> tuple[dict[str, str], ...]:
    """Return what an error says of each value, apart."""
    every = (error, *error.others) if isinstance(error, ScenarioError) else (error,)
    return tuple(
        {"key": one.key, "rule": one.rule, "received": shown(one.received), "remedy": one.remedy} for one in every
    )


def of_validation(errors: Any) -> Refusal:
    """Return one refusal for what pydantic found wrong with the request around a scenario.

    Examples
    --------
    >>> found = [{"loc": ("body", "samples"), "msg": "Input should be less than or equal to 10000", "type": "x"}]
    >>> of_validation(found).message
    '`samples`: input should be less than or equal to 10000.'
    """
    first = errors[0]
    path = [str(part) for part in first["loc"] if part not in ("body", "path", "query")]
    if first["type"] == "json_invalid":
        return Refusal(422, f"The request is not valid JSON: {first.get('ctx', {}).get('error', 'it ends early')}.")
    key = ".".join(path)
    said = str(first["msg"])
    if first["type"] == "string_unicode":
        got = ascii(first["input"])[:60]
        said = f"must be text of whole characters; got {got}. Leave out what is half a character: \\ud800 to \\udfff"
    said = said[:1].lower() + said[1:]
    more = f" ({len(errors) - 1} more.)" if len(errors) > 1 else ""
    subject = f"`{key[:200]}`" if key else "The request"
    return Refusal(422, f"{subject}: {said}.{more}", key[:200] or None)
