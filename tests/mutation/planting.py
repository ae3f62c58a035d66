"""Plant a fault in trundle's own source, as it stands in this process, and take it out again.

A mutant is a piece of source text and what stands in its place. The changed file is compiled, and its functions lend
their code to those that are loaded: whoever imported them, runs the fault.
"""

from __future__ import annotations

import importlib
import types
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from trundle.solve import tracing


@dataclass(frozen=True)
class Mutant:
    """A fault in one file of the package.

    Parameters
    ----------
    name : str
        What is wrong, in words.
    module : str
        Such as "mechanics.contact".
    old, new : str
        Source text that stands there once, and what is put in its place.
    shows : str
        The run that shows it: one of `tests.mutation.runs.RUNS`.
    shared : str
        Why no card can tell: what solver and check share; empty for all others.
    refused : str
        What the run itself says instead of giving a result; empty for all others.
    """

    name: str
    module: str
    old: str
    new: str
    shows: str
    shared: str = ""
    refused: str = ""

    @property
    def room(self) -> str:
        """Where it is planted, for a table."""
        return self.module.replace("__init__", "").rstrip(".")


@contextmanager
def planted(mutant: Mutant) -> Iterator[None]:
    """Run with a fault in its place."""
    live = importlib.import_module(f"trundle.{mutant.module}")
    path = Path(str(live.__file__))
    source = path.read_text(encoding="utf-8")
    assert source.count(mutant.old) == 1, f"{mutant.name}: the text stands {source.count(mutant.old)} times in {path}"
    changed = types.ModuleType(live.__name__)
    changed.__dict__.update({key: getattr(live, key) for key in ("__package__", "__file__", "__spec__")})
    if hasattr(live, "__path__"):
        changed.__dict__["__path__"] = live.__path__
    exec(compile(source.replace(mutant.old, mutant.new), str(path), "exec"), changed.__dict__)  # noqa: S102
    fresh = dict(_functions(changed))
    swapped = [(function, function.__code__) for name, function in _functions(live) if name in fresh]
    plain = (int, float, str, tuple)
    numbers = {
        key: value
        for key, value in vars(live).items()
        if isinstance(value, plain) and not key.startswith("__") and changed.__dict__.get(key, value) != value
    }
    same = [code for name, function in _functions(live) if name in fresh for code in [fresh[name].__code__]]
    assert numbers or any(code != now for (_, code), now in zip(swapped, same, strict=True)), (
        f"{mutant.name}: no change"
    )
    tracing._memory().clear()  # of laws traced without it
    try:
        for (function, _), code in zip(swapped, same, strict=True):
            function.__code__ = code
        for key in numbers:
            setattr(live, key, changed.__dict__[key])
        yield
    finally:
        tracing._memory().clear()
        for function, code in swapped:
            function.__code__ = code
        for key, value in numbers.items():
            setattr(live, key, value)


def _functions(module: types.ModuleType) -> Iterator[tuple[str, types.FunctionType]]:
    """Yield the functions that a module defines, with those of its classes, by qualified name."""
    for value in list(vars(module).values()):
        if getattr(value, "__module__", None) != module.__name__:
            continue
        for part in (value, *(vars(value).values() if isinstance(value, type) else ())):
            function = _bare(part)
            if function is not None and function.__code__.co_filename == module.__file__:
                yield function.__qualname__, function


def _bare(value: Any) -> types.FunctionType | None:
    """Return the function inside a method or property."""
    if isinstance(value, property):
        value = value.fget
    elif isinstance(value, cached_property):
        value = value.func
    value = getattr(value, "__func__", getattr(value, "__wrapped__", value))
    return value if isinstance(value, types.FunctionType) else None
