"""The address of a scenario on the bench: by name while it is a shipped one, else by its whole content."""

from __future__ import annotations

import base64
import json
import zlib

from ..errors import ScenarioError
from ..scenario import files
from . import limits

LONGEST = 64_000  # characters; the page takes no longer code (web/src/lab/share.ts)


def page_of(name_or_path: str) -> str:
    """Return what comes behind the lab's address to open a scenario.

    Examples
    --------
    >>> page_of("tilted-turntable")
    '#/bench?name=tilted-turntable'
    """
    from ..scenario import ScenarioFile
    from ..scenario.path_file import PathFile

    if name_or_path in files.names():
        return f"#/bench?name={name_or_path}"
    tables = files.tables_of(name_or_path)
    limits.check_size(tables)
    kind = PathFile if files.rolls_along_path(tables) else ScenarioFile
    code = encode(files.parse(kind.read(tables, name_or_path).to_toml(), name_or_path))
    if len(code) > LONGEST:
        remedy = "Start the lab without it, and open the file there, or drop it on the page."
        raise ScenarioError("scenario", "must be short enough for an address", f"{len(code)} characters", remedy)
    return f"#/bench?s={code}"


def encode(tables: object) -> str:
    """Return the code of a scenario for an address: JSON, deflated, in base64url.

    Examples
    --------
    >>> encode({"title": "A"})
    'q1YqySzJSVWyUlByVKoFAA'
    """
    deflate = zlib.compressobj(9, zlib.DEFLATED, -zlib.MAX_WBITS)
    packed = deflate.compress(json.dumps(tables).encode("ascii")) + deflate.flush()
    return base64.urlsafe_b64encode(packed).decode("ascii").rstrip("=")
