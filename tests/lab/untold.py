"""Which texts no catalogue has: those that stay plain in the pseudo-language, as the page itself says them."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from tests.fields.systems import node

_SCRIPT = Path(__file__).with_suffix(".mjs")
# Names and formulas that are no words of a language.
_NO_WORDS = {"name", "kind", "scenario", "path", "toml", "symbol", "latex", "unit", "example", "default", "units"}


def untold(texts: Iterable[str]) -> list[str]:
    """Return those of some texts that a reader of another language would see in English."""
    asked = json.dumps(list(dict.fromkeys(text for text in texts if text)))
    command = [node(), "--no-warnings", str(_SCRIPT)]
    done = subprocess.run(command, input=asked, capture_output=True, text=True, check=False)  # noqa: S603
    assert done.returncode == 0, done.stderr[-2000:]
    found: list[str] = json.loads(done.stdout)
    return found


def words_in(value: Any) -> Iterator[str]:
    """Yield all that is said in an answer of the server."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict):
        for key, part in value.items():
            if key not in _NO_WORDS:
                yield from words_in(part)
    elif isinstance(value, (list, tuple)):
        for part in value:
            yield from words_in(part)
