"""The `trundle` command: what happens around the commands themselves, which are in `app`.

Exit status: 0, all is well; 2, bad input; 3, a figure of the card failed; 4, the data of a check
cannot decide; 130, interrupted; 1, anything else.
"""

from __future__ import annotations

import contextlib
import gc
import os
import sys
from collections.abc import Sequence
from typing import Any

from .signals import INTERRUPTED, Ending, ending

OTHER, BAD_INPUT, CARD_FAILED, CANNOT_DECIDE = 1, 2, 3, 4


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command and leave Python with its exit status.

    Examples
    --------
    >>> import contextlib, io
    >>> printed = io.StringIO()
    >>> with contextlib.redirect_stdout(printed), contextlib.suppress(SystemExit):
    ...     main(["list"])
    >>> "tilted-turntable" in printed.getvalue()
    True
    """
    gc.disable()  # a command is over before it finds anything, and its passes over fresh imports take half a second
    try:
        status = run(arguments)
    finally:
        gc.enable()
    if status == INTERRUPTED:  # Python may die of the signal instead of leaving with the status
        for stream in (sys.stdout, sys.stderr):
            with contextlib.suppress(OSError, ValueError):
                stream.flush()
        os._exit(status)
    sys.exit(status)


def run(arguments: Sequence[str] | None = None) -> int:
    """Run the command: every way out ends in one message at most, and a status.

    Examples
    --------
    >>> run(["list", "--quiet"])
    2
    """
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")  # a terminal that has no Greek letters
    handler = Ending()
    try:
        with ending() as handler:
            from .app import command

            status = command().main(arguments, prog_name="trundle", standalone_mode=False)
            sys.stdout.flush()
    except KeyboardInterrupt:
        status = INTERRUPTED
    except BrokenPipeError:  # the reader of our output has had enough
        status = _hush()
    except Exception as error:  # noqa: BLE001  the last resort: no traceback reaches a user
        return _explain(error)
    if status == INTERRUPTED:
        _say("interrupted; the files are written" if handler.written else "interrupted; nothing written")
    return int(status or 0)


def _explain(error: Exception) -> int:
    """Say what went wrong in one message, and return the status that goes with it."""
    from ..errors import InvalidValueError, MissingExtraError, TrundleError, UnknownNameError

    if os.environ.get("TRUNDLE_DEBUG"):
        import traceback

        traceback.print_exception(error)
    if hasattr(error, "format_message") and hasattr(error, "exit_code"):  # typer's: a wrong option or command
        return _explain_usage(error)
    if isinstance(error, (InvalidValueError, UnknownNameError, MissingExtraError)):
        for line in str(error).split("\n"):  # a scenario file may have several mistakes
            _say(line)
        return BAD_INPUT
    if isinstance(error, TrundleError):
        _say(str(error))
    elif isinstance(error, OSError):  # the disk behind the standard output is full, for one
        place = f" ({error.filename})" if error.filename else ""
        _say(f"the system says: {error.strerror or error}{place}")
    elif isinstance(error, MemoryError):
        _say("there is not enough memory for this run: ask for fewer samples. Nothing was written.")
    else:
        _say(
            f"this is a bug in trundle, {type(error).__name__}: {error}\n"
            "Please report it with the traceback, which TRUNDLE_DEBUG=1 in the environment prints."
        )
    return OTHER


def _explain_usage(error: Any) -> int:
    from ..scenario.files import names

    context = getattr(error, "ctx", None)
    if context is not None:
        print(context.get_usage(), file=sys.stderr)  # noqa: T201
    message = error.format_message()
    forgotten = next((name for name in names() if f"'{name}'" in message), None)
    if forgotten and context is not None and context.parent is None:
        message += f" Did you mean `trundle run {forgotten}`?"
    _say(message)
    return BAD_INPUT


def _say(message: str) -> None:
    with contextlib.suppress(OSError):
        print(f"trundle: {message}", file=sys.stderr)  # noqa: T201


def _hush() -> int:
    """Send what is still to be flushed nowhere, so that Python does not complain about it on its way out."""
    with contextlib.suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return OTHER
