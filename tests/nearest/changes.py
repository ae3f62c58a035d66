"""What has changed since a commit, and which of it can change what the code does."""

from __future__ import annotations

import ast
import subprocess
from pathlib import Path

_DOCUMENTED = ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef


def changed(since: str) -> list[str]:
    """Return the files that differ from a commit, new ones too; those that are gone stand for whoever imports them."""
    named = git("diff", "--name-only", "--no-renames", since) + git("ls-files", "--others", "--exclude-standard")
    return sorted(set(named.splitlines()))


def acts_otherwise(file: str, since: str) -> bool:
    """Return whether a Python file differs in more than its comments, docstrings and layout."""
    now = Path(file)
    try:
        return not now.exists() or meaning(now.read_text(encoding="utf-8")) != meaning(git("show", f"{since}:{file}"))
    except (SyntaxError, subprocess.CalledProcessError):  # it was not there, or is not finished
        return True


def meaning(source: str) -> str:
    """Return what Python makes of a source, without its docstrings."""
    tree = ast.parse(source)
    for node in ast.walk(tree):
        if isinstance(node, _DOCUMENTED) and ast.get_docstring(node, clean=False) is not None:
            node.body[:1] = [] if len(node.body) > 1 else [ast.Pass()]
    return ast.dump(tree)


def git(*words: str) -> str:
    """Return what git prints."""
    return subprocess.run(["git", *words], check=True, capture_output=True, text=True).stdout  # noqa: S603, S607
