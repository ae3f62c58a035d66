"""`trundle site`: a static site of live pages, for any web host."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from . import screen, signals
from .options import Quiet


def site(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="The folder to write; it may be there already.")],
    scenarios: Annotated[
        list[str] | None,
        typer.Argument(metavar="[SCENARIO]...", help="Shipped ones or TOML files; absent: all that ship."),
    ] = None,
    quiet: Quiet = False,
) -> None:
    """Write a site of gallery, tour and live pages: plain files with relative links, for any web host.

    Each scenario has a page that computes its motion where it is opened, with sliders; one that no page can compute
    has its film. The gallery has the code that embeds each. All of it also opens from a memory stick.

    Exit status: 0, all is well; 2, bad input; 130, interrupted; 1, all else.
    """
    from ..lab.challenges import on_site
    from ..live.site import site_of
    from .writing import check_folder, write_together

    folder = folder.expanduser()
    check_folder(folder, ("index.html",), key="DIR")
    with screen.ProgressBar(wanted=not quiet) as progress:
        found = site_of(scenarios or (), challenges=on_site(), progress=progress)
    signals.check()
    write_together(folder, {name: partial(_write, content) for name, content in found.items()})
    if not quiet:
        size = sum(map(len, found.values())) / 1e6
        screen.out(f"Wrote {folder / 'index.html'} and {len(found) - 1} pages beside it ({size:.1f} MB)")


def _write(content: bytes, path: Path) -> None:
    path.write_bytes(content)
