"""Find each place of a source file that asks for a concrete part.

Counted is each class that is named in the second place of `isinstance` and `issubclass`, in a class pattern of `match`,
as the key of a dictionary, in a row of a table (a sequence in a sequence), in a comparison with `type(x)`, or where
`singledispatch` is told of a class. A tuple or union of classes that has a name is opened.
"""

from __future__ import annotations

import ast
import importlib
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from importlib.util import resolve_name
from pathlib import Path
from types import UnionType
from typing import get_args

from .parts import kind_of


@dataclass(frozen=True)
class Place:
    """A class that is asked for."""

    kind: str
    part: str
    file: str
    line: int


def places(root: Path, package: str) -> Iterator[Place]:
    """Find all in the sources of a package, file by file."""
    for file in sorted((root / package).rglob("*.py")):
        name = ".".join(file.relative_to(root).with_suffix("").parts)
        yield from in_source(file.read_text(encoding="utf-8"), name, str(file.relative_to(root)))


def in_source(source: str, module: str, file: str) -> Iterator[Place]:
    """Find all in one source; `module` is its name, and ends in `__init__` for that of a package."""
    tree = ast.parse(source)
    names = _Names(tree, module.rpartition(".")[0])
    for asked in ast.walk(tree):
        for node in _asked_for(asked):
            for part in names.classes(node):
                kind = kind_of(part)
                if kind and not f"{module}.".startswith(f"{kind.home}."):
                    yield Place(kind.name, part.__name__, file, node.lineno)


def _asked_for(node: ast.AST) -> Iterator[ast.expr]:
    """Return the expressions of classes for which a node asks."""
    match node:
        case ast.Call(func=ast.Name(id="isinstance" | "issubclass"), args=[_, classes]):
            yield classes
        case ast.Call(func=ast.Attribute(attr="register"), args=[classes, *_]):
            yield classes
        case ast.FunctionDef(args=ast.arguments(args=[ast.arg(annotation=ast.expr() as classes), *_])) if any(
            isinstance(one, ast.Attribute) and one.attr == "register" for one in node.decorator_list
        ):
            yield classes
        case ast.MatchClass(cls=classes):
            yield classes
        case ast.Dict(keys=keys):
            yield from filter(None, keys)
        case ast.Compare(left=left, comparators=[*others]) if any(map(_is_type, (left, *others))):
            yield from (one for one in (left, *others) if not _is_type(one))
        case ast.Tuple(elts=rows) | ast.List(elts=rows) | ast.Set(elts=rows):
            for row in rows:
                if isinstance(row, ast.Tuple | ast.List):
                    yield row


def _is_type(node: ast.expr) -> bool:
    return (isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "type") or (
        isinstance(node, ast.Attribute) and node.attr == "__class__"
    )


class _Names:
    """What the names of a file stand for: what it imports anywhere, and the sequences that it gives a name."""

    def __init__(self, tree: ast.Module, package: str) -> None:
        self.values: dict[str, ast.expr] = {}
        self.imported: dict[str, tuple[str, str]] = {}
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom):
                source = resolve_name("." * node.level + (node.module or ""), package)
                self.imported |= {one.asname or one.name: (source, one.name) for one in node.names}
            elif isinstance(node, ast.Import):
                self.imported |= {one.asname: (one.name, "") for one in node.names if one.asname}
                self.imported |= {top: (top, "") for one in node.names if (top := one.name.partition(".")[0])}
            elif isinstance(node, ast.Assign) and isinstance(node.value, ast.Tuple | ast.List | ast.Set | ast.BinOp):
                self.values |= {one.id: node.value for one in node.targets if isinstance(one, ast.Name)}

    def classes(self, node: ast.expr, within: tuple[str, ...] = ()) -> Iterator[type]:
        """Return the classes in an expression."""
        match node:
            case ast.Tuple(elts=parts) | ast.List(elts=parts) | ast.Set(elts=parts):
                for part in parts:
                    yield from self.classes(part, within)
            case ast.BinOp(left=left, op=ast.BitOr() | ast.Add(), right=right):
                yield from self.classes(left, within)
                yield from self.classes(right, within)
            case ast.Starred(value=value):
                yield from self.classes(value, within)
            case ast.Name(id=name) if name in self.values and name not in within:
                yield from self.classes(self.values[name], (*within, name))
            case ast.Name() | ast.Attribute():
                yield from _opened(self._thing(node))

    def _thing(self, node: ast.expr) -> object:
        """Return what a name, or a name in a module, stands for; None for all that is not trundle's."""
        if isinstance(node, ast.Attribute):
            return getattr(self._thing(node.value), node.attr, None)
        source, name = self.imported.get(node.id, ("", "")) if isinstance(node, ast.Name) else ("", "")
        return _from(source, name) if source.partition(".")[0] == "trundle" else None


@cache
def _from(source: str, name: str) -> object:
    module = importlib.import_module(source)
    if not name or hasattr(module, name):
        return getattr(module, name) if name else module
    try:
        return importlib.import_module(f"{source}.{name}")
    except ModuleNotFoundError:  # a name that only type checkers see
        return None


def _opened(thing: object) -> Iterator[type]:
    if isinstance(thing, type):
        yield thing
    elif isinstance(thing, tuple | list | set | frozenset | UnionType):
        for one in get_args(thing) if isinstance(thing, UnionType) else thing:
            yield from _opened(one)
