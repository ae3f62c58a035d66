"""JupyterLab in a process of its own, as a user starts it, with nothing of the user's."""

from __future__ import annotations

import json
import os
import re
import secrets
import subprocess
import sys
import threading
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

PATIENCE = 90  # s, for a start on a busy machine
_NO_NEWS = {"@jupyterlab/apputils-extension:notification": {"fetchNews": "false", "checkForUpdates": False}}


class NotebookError(Exception):
    """JupyterLab did not start."""


def write_notebook(path: Path, *cells: str) -> None:
    """Write a notebook of code cells."""
    import nbformat
    from nbformat.v4 import new_code_cell, new_notebook

    kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
    code = [new_code_cell(text, id=f"cell-{at}") for at, text in enumerate(cells)]
    nbformat.write(new_notebook(cells=code, metadata={"kernelspec": kernel}), path)


@contextmanager
def jupyterlab(folder: Path) -> Iterator[tuple[str, str]]:
    """Serve the notebooks of a folder on a free port of this machine; yields the origin and the token."""
    own = folder.with_name(folder.name + "-own")
    settings = own / "config" / "labconfig"
    settings.mkdir(parents=True)
    (settings / "default_setting_overrides.json").write_text(json.dumps(_NO_NEWS))
    token, log = secrets.token_hex(16), own / "log"
    with log.open("w") as stream:
        process = subprocess.Popen(  # noqa: S603
            [
                *(sys.executable, "-m", "jupyterlab", "--no-browser", "--allow-root"),
                *("--ServerApp.ip=127.0.0.1", "--ServerApp.port=0", f"--ServerApp.root_dir={folder}"),
                "--LabApp.check_for_updates_class=jupyterlab.NeverCheckForUpdate",
            ],
            env=os.environ
            | {
                "JUPYTER_TOKEN": token,
                "JUPYTER_CONFIG_DIR": str(own / "config"),
                "JUPYTER_DATA_DIR": str(own / "data"),
                "JUPYTER_RUNTIME_DIR": str(own / "runtime"),
                "IPYTHONDIR": str(own / "ipython"),
                "JUPYTER_PLATFORM_DIRS": "1",
            },
            stdin=subprocess.DEVNULL,
            stdout=stream,
            stderr=subprocess.STDOUT,
        )
    try:
        yield _origin(process, log, token), token
    finally:
        timer = threading.Timer(20, process.kill)
        timer.start()
        process.terminate()  # it shuts its kernels down
        process.wait()
        timer.cancel()


def _origin(process: subprocess.Popen[bytes], log: Path, token: str) -> str:
    until = time.monotonic() + PATIENCE
    while time.monotonic() < until and process.poll() is None:
        if found := re.search(r"(http://127\.0\.0\.1:\d+)/", log.read_text()):
            try:
                with urllib.request.urlopen(f"{found[1]}/api/status?token={token}", timeout=PATIENCE):  # noqa: S310
                    return found[1]
            except (urllib.error.URLError, ConnectionError):
                pass
        time.sleep(0.1)
    raise NotebookError(f"JupyterLab did not start within {PATIENCE} s:\n{log.read_text()}")
