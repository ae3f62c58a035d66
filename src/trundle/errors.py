"""What trundle raises: each message states the rule, the value received and the remedy."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from difflib import get_close_matches
from typing import Self

MOST_TOLD = 20  # errors of one file


class TrundleError(Exception):
    """Anything that trundle refuses or cannot do; every other kind derives from it."""


class InvalidValueError(TrundleError, ValueError):
    """A value breaks a rule that the reader can mend.

    Parameters
    ----------
    key : str
        Name of the value as the reader wrote it, such as ``"body.radius"``.
    rule : str
        What is allowed, as the end of a sentence: ``"must be positive"``.
    received : object
        The value that came.
    remedy : str
        What to do about it.

    Examples
    --------
    >>> print(InvalidValueError("tilt", "must lie in (-90°, 90°)", "172 deg", "Did you mean 1.72 deg?"))
    `tilt` must lie in (-90°, 90°); got '172 deg'. Did you mean 1.72 deg?
    """

    def __init__(self, key: str, rule: str, received: object, remedy: str = "") -> None:
        self.key, self.rule, self.received, self.remedy = key, rule, received, remedy
        super().__init__(f"`{key}` {rule}; got {shown(received)}.{' ' + remedy if remedy else ''}")

    def __reduce__(self) -> tuple[type, tuple[object, ...]]:
        return type(self), (self.key, self.rule, self.received, self.remedy)


class ScenarioError(InvalidValueError):
    """A scenario file, or a key in it, is not as the format asks.

    Parameters
    ----------
    key, rule, received, remedy : see InvalidValueError
        The key is its path in the file, such as ``"loads[0].value[1]"``.
    source : str
        The file, where there is one.
    others : sequence of ScenarioError
        What else is wrong with the same file: the message has a line for each.

    Examples
    --------
    >>> other = ScenarioError("body.mass", "must be positive", -1, source="my.toml")
    >>> print(ScenarioError("run.every", "must be positive", 0, "A step is longer than 0 s.", "my.toml", [other]))
    my.toml: `run.every` must be positive; got 0. A step is longer than 0 s.
    my.toml: `body.mass` must be positive; got -1.
    """

    def __init__(
        self,
        key: str,
        rule: str,
        received: object,
        remedy: str = "",
        source: str = "",
        others: Iterable[ScenarioError] = (),
    ) -> None:
        super().__init__(key, rule, received, remedy)
        self.source, self.others = source, tuple(others)
        lines = [f"{source + ': ' if source else ''}{self.args[0]}", *map(str, self.others)]
        if len(lines) > MOST_TOLD:
            lines[MOST_TOLD:] = [f"{source + ': ' if source else ''}{len(lines) - MOST_TOLD} more errors like these."]
        self.args = ("\n".join(lines),)

    @classmethod
    def of(cls, errors: Iterable[InvalidValueError], source: str = "") -> Self:
        """Return one error that tells several.

        Parameters
        ----------
        errors : iterable of InvalidValueError
            At least one.
        source : str
            The file, where there is one.

        Returns
        -------
        ScenarioError
            The first, with the others.

        Examples
        --------
        >>> found = [InvalidValueError("run.every", "must be positive", 0)]
        >>> print(ScenarioError.of(found, "my.toml"))
        my.toml: `run.every` must be positive; got 0.
        """
        first, *others = (cls(one.key, one.rule, one.received, one.remedy, source) for one in errors)
        return cls(first.key, first.rule, first.received, first.remedy, source, others)

    def naming(self, options: Mapping[str, str]) -> Self:
        """Return the same with other names for some keys, which then are of no file.

        Parameters
        ----------
        options : mapping
            The option of a command that a key stands for.

        Returns
        -------
        ScenarioError
            One that tells the same.

        Examples
        --------
        >>> print(ScenarioError("run.every", "must be positive", 0, "", "my.toml").naming({"run.every": "--every"}))
        `--every` must be positive; got 0.
        """
        told: list[ScenarioError] = [self, *self.others]
        first, *others = (
            type(self)(options.get(one.key, one.key), one.rule, one.received, one.remedy, source)
            for one in told
            for source in ["" if one.key in options else one.source]
        )
        return type(self)(first.key, first.rule, first.received, first.remedy, first.source, others)

    def __reduce__(self) -> tuple[type, tuple[object, ...]]:
        return type(self), (self.key, self.rule, self.received, self.remedy, self.source, self.others)


class RunFileError(InvalidValueError):
    """A file is not one that a run was saved to, or it is damaged.

    Parameters
    ----------
    key, rule, received, remedy : see InvalidValueError
        The key is "file", or a variable or attribute in it.
    source : str
        The file.

    Examples
    --------
    >>> print(RunFileError("time", "must ascend", "0.1 s after 0.2 s", "Save the run again.", "run.nc"))
    run.nc: `time` must ascend; got '0.1 s after 0.2 s'. Save the run again.
    """

    def __init__(self, key: str, rule: str, received: object, remedy: str, source: str) -> None:
        super().__init__(key, rule, received, remedy)
        self.source = source
        self.args = (f"{source}: {self.args[0]}",)

    def __reduce__(self) -> tuple[type, tuple[object, ...]]:
        return type(self), (self.key, self.rule, self.received, self.remedy, self.source)


class OutOfDomainError(TrundleError):
    """A closed form or a method was asked for a system outside its stated domain."""


class TurnsTooFastError(OutOfDomainError):
    """A closed form holds, but its orientation is a quadrature that cannot follow so fast a turning."""


class SolverError(TrundleError):
    """A numerical method did not reach the tolerance or the time asked for."""


class UnknownNameError(TrundleError, AttributeError):
    """A name is not among those that exist; the message lists them.

    Examples
    --------
    >>> print(UnknownNameError("frame", "wrold", ["support", "world", "corotating"]))
    unknown frame 'wrold'. Did you mean 'world'? There are: support, world, corotating
    """

    def __init__(self, kind: str, received: str, known: Iterable[str]) -> None:
        self.kind, self.received, self.known = kind, received, list(known)
        super().__init__(
            f"unknown {kind} {received!r}.{did_you_mean(received, self.known)} There are: " + ", ".join(self.known)
        )

    def __reduce__(self) -> tuple[type, tuple[object, ...]]:
        return type(self), (self.kind, self.received, self.known)


class MissingExtraError(TrundleError, ImportError):
    """Something was asked for that only some users need, and the extra that brings it is not installed.

    Parameters
    ----------
    asked : str
        What the reader asked for, as they wrote it: ``"trundle lab"``.
    extra : str
        Its name in pyproject.toml.
    instead : str
        What does without it, as a sentence.

    Examples
    --------
    >>> print(MissingExtraError("trundle lab", "lab"))
    `trundle lab` needs the extra `lab`, which is not installed here: pip install 'trundle[lab]'.
    """

    def __init__(self, asked: str, extra: str, instead: str = "") -> None:
        self.asked, self.extra, self.instead = asked, extra, instead
        rule = f"`{asked}` needs the extra `{extra}`, which is not installed here"
        super().__init__(f"{rule}: pip install 'trundle[{extra}]'.{' ' + instead if instead else ''}")

    def __reduce__(self) -> tuple[type, tuple[object, ...]]:
        return type(self), (self.asked, self.extra, self.instead)


def did_you_mean(received: str, known: Iterable[str]) -> str:
    """Suggest the known name closest to a mistyped one.

    Examples
    --------
    >>> did_you_mean("radios", ["radius", "mass"])
    " Did you mean 'radius'?"
    """
    close = get_close_matches(str(received), list(known), n=1)
    return f" Did you mean {close[0]!r}?" if close else ""


def shown(received: object) -> str:
    """Return a value as a message shows it."""
    try:
        text = repr(received)
    except (ValueError, RecursionError):  # an integer of more than 4300 digits, a structure nested too deep
        return f"a value of type {type(received).__name__} too large to show"
    return text if len(text) <= 120 else text[:117] + "..."
