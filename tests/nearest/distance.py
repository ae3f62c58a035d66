"""How far each file of tests is from a module: how many imports lie between them."""

from __future__ import annotations

import re
from pathlib import Path

import grimp

import trundle as tr

_OFFERED = re.compile(r"\btr\.([A-Za-z_]\w*)")


class Distances:
    """The imports of the package and of its tests, those within functions too, and those that only types need not."""

    def __init__(self) -> None:
        self.graph = grimp.build_graph("trundle", "tests", exclude_type_checking_imports=True, cache_dir=None)
        for module in self.graph.find_modules_that_directly_import("trundle"):
            # The package offers its names without importing them: who takes one imports what it is from.
            for home in self._homes(file_of(module)) & self.graph.modules:
                self.graph.add_import(importer=module, imported=home)

    @staticmethod
    def _homes(file: Path) -> set[str]:
        source = file.read_text(encoding="utf-8")
        names = set(_OFFERED.findall(source)) | set(re.findall(r"\w+", " ".join(_FROM.findall(source))))
        things = [getattr(tr, name) for name in names if name in tr.__all__]
        return {getattr(thing, "__module__", None) or getattr(thing, "__name__", "") for thing in things}

    def tests(self, files: set[str]) -> list[tuple[int, str]]:
        """Return all files of tests that depend on any of some files, the nearest first, and how near they are."""
        here = {module_of(file) for file in files} & self.graph.modules
        known, distance, found = set(here), 0, []
        while here:
            tests = [module for module in here if ".test_" in module]
            found += sorted((distance, len(self.graph.find_modules_directly_imported_by(one)), one) for one in tests)
            here = {one for module in here for one in self.graph.find_modules_that_directly_import(module)} - known
            known |= here
            distance += 1
        return [(far, str(file_of(module))) for far, _, module in found]


_FROM = re.compile(r"^ *from trundle import (\([^)]*\)|.*)", re.MULTILINE)


def module_of(file: str) -> str:
    """Return the module that a file is."""
    return ".".join(Path(file).with_suffix("").parts).removeprefix("src.").removesuffix(".__init__")


def file_of(module: str) -> Path:
    """Return the file that a module is, from the root on."""
    path = Path(*(("src",) if module.partition(".")[0] == "trundle" else ()), *module.split("."))
    return path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
