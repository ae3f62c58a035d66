"""The command `trundle lab`: the ball in a browser."""

from __future__ import annotations

from typing import Annotated

import typer

from ..errors import InvalidValueError
from ..extras import need
from . import screen, signals


def lab(
    scenario: Annotated[
        str | None,
        typer.Argument(metavar="SCENARIO", help="What to open: the name of a shipped one, or a TOML file."),
    ] = None,
    host: Annotated[str, typer.Option(metavar="ADDRESS", help="Where to listen.")] = "127.0.0.1",
    port: Annotated[
        int | None,
        typer.Option(min=0, max=65535, help="Which port; absent: 8765, or any other that is free.", show_default=False),
    ] = None,
    no_open: Annotated[bool, typer.Option("--no-open", help="Do not open a browser.")] = False,
    network: Annotated[
        bool, typer.Option("--network", help="Let others on the network in, where --host is not this machine alone.")
    ] = False,
    embed_from: Annotated[
        list[str] | None,
        typer.Option(metavar="HOST", help="Whose pages may show the lab in a frame; may stand several times."),
    ] = None,
) -> None:
    """Serve the lab on this machine and open it in a browser: a turntable to spin and tilt, a ball to put down.

    With a scenario it opens that. Everything is computed here, by this package; nothing is asked of any other machine.
    Ctrl-C ends it.
    """
    need("lab", "trundle lab")
    import gc

    from ..lab.links import page_of
    from ..lab.security import check_embedder
    from ..lab.serving import is_loopback, serve
    from ..lab.settings import DEFAULT_PORT, Settings

    for each in embed_from or []:
        check_embedder(each)
    exposed = not is_loopback(host)
    if exposed and not network:
        remedy = "Anyone on the network could then use this machine to compute; add --network if that is meant."
        raise InvalidValueError("--host", "must be an address of this machine alone", host, remedy)
    if exposed:
        screen.note(f"trundle: warning: anyone who reaches {host} can now use this machine to compute, unencrypted")

    page = "" if scenario is None else page_of(scenario)

    def told(address: str, taken: int) -> None:
        gc.freeze()  # what is loaded stays: a pass over it would let a visitor wait for a tenth of a second
        if port is None and taken != DEFAULT_PORT:
            screen.note(f"trundle: port {DEFAULT_PORT} is taken, so this is another")
        screen.out(f"The lab is at {address} (Ctrl-C ends it)")
        if page and no_open:
            screen.out(f"{scenario} is at {address}{page}")

    settings = Settings(host=host, exposed=exposed, embed_from=tuple(embed_from or ()))
    gc.enable()  # unlike other commands, this one lasts
    try:
        serve(settings, port, page=page, open_browser=not no_open, told=told)
    except KeyboardInterrupt:
        signals.heard()
    screen.out("The lab has ended.")
