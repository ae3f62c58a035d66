"""The engines that adapters ship for: one file of data each, and the environment that is made from it.

A file says what is installed, in which profiles the engine is scored, and what is switched to find a cause. An engine
that cannot be installed says why.
"""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
import tomllib
import venv
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ...errors import UnknownNameError
from ...files import hold
from ...solve.integrator_cache import cache_folder
from ..running import STARTING, Adapter

_HERE = Path(__file__).parent
_READY = "ready"  # a file in an environment that is whole
_PATIENCE = 1200.0  # s for an installer
SHIPPED = "as shipped"
BEST = "best"


class CannotInstallError(Exception):
    """An engine cannot be installed; the message says why."""


@dataclass(frozen=True)
class Setting:
    """A way to run an engine.

    Parameters
    ----------
    name : str
        "as shipped", "best", or what an ablation switches.
    values : mapping
        What the adapter is told.
    source : str
        Where the engine's documentation recommends it; what an ablation shows.
    of : str
        Of an ablation: the profile that it differs from in one thing.
    """

    name: str
    values: Mapping[str, Any] = field(default_factory=dict)
    source: str = ""
    of: str = ""


@dataclass(frozen=True)
class Engine:
    """An engine: how it is installed, and how it is set.

    Parameters
    ----------
    name : str
        As the command line calls it.
    title : str
        As its makers do.
    packages : tuple of str
        Pinned, as the installer takes them; none: it runs where trundle does.
    settings : tuple of Setting
        Profiles first.
    cannot : str
        Why it is not scored.
    starting : float
        s that its first answer may take more than others.

    Examples
    --------
    >>> from trundle.conformance import engines
    >>> [setting.name for setting in engines.engine("mujoco").profiles]
    ['as shipped', 'best']
    """

    name: str
    title: str
    packages: tuple[str, ...] = ()
    settings: tuple[Setting, ...] = ()
    cannot: str = ""
    starting: float = STARTING

    @property
    def profiles(self) -> tuple[Setting, ...]:
        """The settings that are scored."""
        return tuple(each for each in self.settings if not each.of)

    @property
    def ablations(self) -> tuple[Setting, ...]:
        """The settings that look for a cause."""
        return tuple(each for each in self.settings if each.of)

    @property
    def environment(self) -> Path:
        """The folder of its environment, in the user's cache."""
        said = " ".join([*self.packages, sys.version])
        return cache_folder() / "engines" / f"{self.name}-{hashlib.sha256(said.encode()).hexdigest()[:12]}"

    @property
    def python(self) -> Path:
        """Its interpreter."""
        return _python(self.environment) if self.packages else Path(sys.executable)

    @property
    def installed(self) -> bool:
        """Whether its environment is there."""
        return not self.packages or (self.environment / _READY).exists()

    def install(self) -> None:
        """Make its environment with Python's own installer, unless it is there.

        Raises
        ------
        CannotInstallError
            With the installer's last words.
        """
        folder = self.environment
        if self.cannot:
            raise CannotInstallError(self.cannot)
        if self.installed:
            return
        try:
            folder.mkdir(parents=True, exist_ok=True)
            lock = hold(folder)
            if lock is None and os.name == "posix":
                raise CannotInstallError(f"another process is making {folder}")
            try:
                self._make(folder)
            finally:
                if lock is not None:
                    os.close(lock)
        except subprocess.TimeoutExpired:
            raise CannotInstallError(f"the installer took more than {_PATIENCE:g} s") from None
        except OSError as error:
            raise CannotInstallError(f"{folder}: {error.strerror or error}") from None

    def _make(self, folder: Path) -> None:
        venv.EnvBuilder(clear=True, with_pip=True, symlinks=os.name == "posix").create(folder)
        command = [str(_python(folder)), "-m", "pip", "install", "--quiet", "--no-input", "--only-binary", ":all:"]
        told = subprocess.run(  # noqa: S603  our own installer
            [*command, "--disable-pip-version-check", *self.packages],
            capture_output=True,
            text=True,
            timeout=_PATIENCE,
            check=False,
        )
        if told.returncode:
            lines = [line for line in told.stderr.splitlines() if line.startswith("ERROR")] or [told.stderr.strip()]
            raise CannotInstallError(lines[-1].removeprefix("ERROR:").strip()[:300])
        (folder / _READY).touch()

    def adapter(self, limit: float) -> Adapter:
        """Return its adapter, to be started in its environment.

        Parameters
        ----------
        limit : float
            s for an answer.

        Returns
        -------
        Adapter
            Not started yet.
        """
        own = not self.packages
        ours = str(_HERE.parents[2]) if own else ""  # trundle itself is imported from where this file is
        path = {"PYTHONPATH": os.pathsep.join(filter(None, (ours, os.environ.get("PYTHONPATH", "") if own else "")))}
        return Adapter([str(self.python), "-m", f"adapters.{self.name}"], _HERE, limit, path, self.starting)


def _python(environment: Path) -> Path:
    """Return the interpreter of an environment."""
    return environment / ("Scripts/python.exe" if os.name == "nt" else "bin/python")


def names() -> list[str]:
    """Return the names of all engines.

    Examples
    --------
    >>> "mujoco" in names(), "chrono" in names()
    (True, True)
    """
    return sorted(path.stem for path in _HERE.glob("*.toml"))


def engine(name: str) -> Engine:
    """Return an engine by its name.

    Examples
    --------
    >>> engine("mujoko")
    Traceback (most recent call last):
    ...
    trundle.errors.UnknownNameError: unknown engine 'mujoko'. Did you mean 'mujoco'? There are: ...
    """
    if name not in names():
        raise UnknownNameError("engine", name, names())
    told = tomllib.loads((_HERE / f"{name}.toml").read_text(encoding="utf-8"))
    settings = [
        Setting(key, each.get("set", {}), each.get("source", ""), each.get("of", ""))
        for key, each in told.get("settings", {}).items()
    ]
    return Engine(
        name,
        told["title"],
        tuple(told.get("packages", ())),
        tuple(settings),
        told.get("cannot", ""),
        told.get("starting", STARTING),
    )
