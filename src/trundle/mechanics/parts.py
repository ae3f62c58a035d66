"""What a part of a system says about itself, once: its kind, and of each of its fields what it is and what it may be.

The tables of scenario files, their JSON schema, the checks and what is written back are made from this.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import MISSING, dataclass, field, fields
from functools import cache
from importlib import import_module
from inspect import get_annotations, signature
from types import MappingProxyType
from typing import Any, ClassVar, TypeVar, get_type_hints

from ..errors import InvalidValueError, UnknownNameError
from . import checks
from .algebra import Vector
from .expressions import Expression, varying, varying_vector
from .scalars import is_number, is_zero

ANY, POSITIVE, NOT_NEGATIVE = "any", "positive", "not negative"
_CHECKS = {ANY: checks.real, POSITIVE: checks.positive, NOT_NEGATIVE: checks.non_negative}
PartType = TypeVar("PartType", bound="Part")


@dataclass(frozen=True)
class Number:
    """A field that is one number.

    Parameters
    ----------
    dimension : str
        One of `trundle.units.UNITS`.
    sign : str
        `ANY`, `POSITIVE` or `NOT_NEGATIVE`.
    said : str
        One sentence; its symbol and unit need none.
    example : str or number, optional
        As it may stand in a file.
    varies : bool
        Whether it may be a formula in the time.
    words : mapping
        Texts that may stand instead, and what each means; itself where only the part can tell.
    limit : callable, optional
        A further check of (number in SI, as it was given); it raises `InvalidValueError`, its key ``""``.
    label : str, optional
        What stands at its control; absent: its key in words.

    Examples
    --------
    >>> Number("length", POSITIVE).read("25 mm", "radius")
    0.025
    """

    dimension: str
    sign: str = ANY
    said: str = ""
    example: Any = None
    varies: bool = False
    words: Mapping[str, Any] = field(default_factory=dict)
    limit: Callable[[Any, Any], None] | None = None
    label: str = ""

    def read(self, value: Any, key: str) -> Any:
        """Return the number in SI, checked; a formula as one, and what a word means."""
        if self.varies:
            return varying(value, self.dimension, key)
        if isinstance(value, str) and value in self.words:
            return self.words[value]
        if self.limit is not None:
            self._check_limit(value, key)
        return _CHECKS[self.sign](value, self.dimension, key)

    def _check_limit(self, value: Any, key: str) -> None:
        number = checks.real(value, self.dimension, key)
        try:
            if self.limit is not None and is_number(number):
                self.limit(number, value)
        except InvalidValueError as error:
            raise InvalidValueError(key, error.rule, error.received, error.remedy) from None


@dataclass(frozen=True)
class Numbers:
    """A field that is a vector: three numbers in one frame.

    Parameters
    ----------
    each : Number
        What each of them is.
    said : str
        One sentence.
    direction : bool
        Whether only its direction counts, so that it must have one.
    example : sequence of 3 strings or numbers, optional
        As it may stand in a file.
    label : str, optional
        What stands at the control of each, before its name; absent: its key in words.
    names : tuple of str
        What tells one from the other.

    Examples
    --------
    >>> Numbers(Number("length")).read(("1 cm", 0, 0), "place").x
    0.01
    """

    each: Number
    said: str = ""
    direction: bool = False
    example: Any = None
    label: str = ""
    names: tuple[str, ...] = ("x", "y", "z")

    def read(self, value: Any, key: str) -> Vector:
        """Return the vector in SI, checked."""
        if self.each.varies:
            return varying_vector(value, self.each.dimension, key)
        parts = checks.components(value, self.each.dimension, key)
        found = Vector(*(self.each.read(part, f"{key}[{i}]") for i, part in enumerate(parts)))
        if self.direction and all(map(is_zero, found)):
            raise InvalidValueError(key, "must have a direction", value, "Give for instance (1, 0, 0), the first axis.")
        return found


@dataclass(frozen=True)
class Formula:
    """A field that is a formula in named variables, SI.

    Parameters
    ----------
    variables : tuple of str
        What may stand in it.
    said : str
        One sentence.
    example : str
        As it may stand in a file.

    Examples
    --------
    >>> Formula(("x",)).read("2*x", "formula").at(x=3.0)
    6.0
    """

    variables: tuple[str, ...]
    said: str = ""
    example: str = "0.5*3*(x**2 + y**2)"

    def read(self, value: Any, key: str) -> Expression:
        """Return the formula, checked."""
        if isinstance(value, Expression):
            return value
        if isinstance(value, bool) or not isinstance(value, (str, int, float)):
            remedy = f"Write for instance '{self.example}'."
            raise InvalidValueError(key, f"must be a formula in {', '.join(self.variables)}", value, remedy)
        return Expression.parse(str(value), self.variables, key)


@dataclass(frozen=True)
class Choice:
    """A field that is one of some words.

    Parameters
    ----------
    words : tuple of str
        Which.
    of : str
        What it is a choice of, for messages, such as "side of a cone".
    said : str
        One sentence.

    Examples
    --------
    >>> Choice(("inside", "outside"), "side").read("inside", "side")
    'inside'
    """

    words: tuple[str, ...]
    of: str
    said: str = ""

    def read(self, value: Any, key: str) -> Any:  # noqa: ARG002  the message names what it is of
        """Return the word, checked."""
        if value not in self.words:
            raise UnknownNameError(self.of, str(value), self.words)
        return value


@dataclass(frozen=True)
class PartsOf:
    """A field that is a list of other parts of the same family.

    Parameters
    ----------
    said : str
        One sentence.
    """

    said: str = ""

    def read(self, value: Any, key: str) -> Any:  # noqa: ARG002  the part itself knows which go together
        """Return them as they are."""
        return value


@dataclass(frozen=True)
class Lengths:
    """A list of lengths of any size, or of such lists: points that a surface goes through.

    Parameters
    ----------
    said : str
        One sentence.
    rows : bool
        Whether it is a list of lists.
    """

    said: str = ""
    rows: bool = False


Field = Number | Numbers | Formula | Choice | PartsOf


class Part:
    """A part of a system: a dataclass whose fields say, in their annotations, what they are.

    Where a part is made, each field is read by what it says of itself; None where it is the default stays.
    """

    kind: ClassVar[str] = ""  # its name in files; none: it is not for files
    label: ClassVar[str] = ""  # its name in a list to choose from; absent: its kind in words
    table_of: ClassVar[str] = ""  # of a part that is made from points: the kind in whose table they stand
    given: Any  # and these points, by key

    def __post_init__(self) -> None:
        names = fields_of(type(self))
        for name, value in read_fields(type(self), {name: getattr(self, name) for name in names}).items():
            object.__setattr__(self, name, value)

    @property
    def word(self) -> str:
        """What messages call it: its kind, as a file names it, or the name of a class that files do not know."""
        return self.kind or self.table_of or type(self).__name__


def words_of(parts: Iterable[Part]) -> str:
    """Return what messages call several parts.

    Examples
    --------
    >>> import trundle as tr
    >>> words_of([tr.Drag(0.1), tr.Spin(2.0)])
    'drag, spin'
    """
    return ", ".join(part.word for part in parts)


Maker = type[Part] | Callable[..., Any]  # what is called with the fields: the class of a part, or a builder of `Body`


def read_fields(part: Maker, given: Mapping[str, Any]) -> dict[str, Any]:
    """Return what is given for the fields of a part, read by what each says of itself.

    Examples
    --------
    >>> from trundle.mechanics.bodies import Body
    >>> read_fields(Body.hoop, {"radius": "30 cm", "mass": 1})
    {'radius': 0.3, 'mass': 1.0}
    """
    says, defaults = fields_of(part), defaults_of(part)
    return {
        name: None if value is None and defaults.get(name, MISSING) is None else says[name].read(value, name)
        for name, value in given.items()
    }


def fields_of(part: Maker) -> Mapping[str, Field]:
    """Return what each field of a part, or each parameter of a builder of bodies, says of itself.

    Examples
    --------
    >>> from trundle.mechanics.motions import Spin
    >>> fields_of(Spin)["rate"].dimension
    'angular velocity'
    """
    return _fields(_plain(part))


def _plain(part: Maker) -> Any:
    """Return a class, or the function of a class method, which is the same each time one looks."""
    return getattr(part, "__func__", part)


@cache
def _fields(part: Any) -> Mapping[str, Field]:
    if not isinstance(part, type):
        hints = get_type_hints(part, include_extras=True).items()
        notes = {name: getattr(hint, "__metadata__", ()) for name, hint in hints}
        return MappingProxyType({name: n for name, each in notes.items() for n in each if isinstance(n, Field)})
    found = {each.name: note for each in fields(part) for note in _notes(part, each.name) if isinstance(note, Field)}
    return MappingProxyType(found)


def _notes(part: Any, name: str) -> tuple[Any, ...]:
    """Return what is annotated to a field; of a field without notes nothing is looked up, not even its type."""
    home = next(base for base in part.__mro__ if name in get_annotations(base))
    annotation = get_annotations(home)[name]
    if isinstance(annotation, str) and "Annotated" not in annotation:
        return ()
    alone = type(name, (), {"__annotations__": {name: annotation}, "__module__": home.__module__})
    return tuple(getattr(get_type_hints(alone, include_extras=True)[name], "__metadata__", ()))


def defaults_of(part: Maker) -> Mapping[str, Any]:
    """Return the defaults of those fields of a part that have one, as its class or builder has them.

    Examples
    --------
    >>> from trundle.mechanics.loads import PivotFriction
    >>> dict(defaults_of(PivotFriction))
    {'below': 0.01}
    """
    return _defaults(_plain(part))


@cache
def _defaults(part: Any) -> Mapping[str, Any]:
    if not isinstance(part, type):
        parameters = signature(part).parameters.values()
        return MappingProxyType({p.name: p.default for p in parameters if p.default is not p.empty})
    return MappingProxyType({f.name: f.default for f in fields(part) if f.default is not MISSING})


def kinds_of(family: type[PartType]) -> dict[str, type[PartType]]:
    """Return the parts of a family that files may name, by kind.

    Examples
    --------
    >>> from trundle.mechanics.loads import Load
    >>> list(kinds_of(Load))[:3]
    ['force', 'torque', 'drag']
    """
    named = vars(import_module(family.__module__.rpartition(".")[0])).values()
    parts = [part for part in named if isinstance(part, type) and issubclass(part, family)]
    return {part.kind: part for part in (*parts, *_below(family)) if vars(part).get("kind")}


def _below(family: type[PartType]) -> list[type[PartType]]:
    return [each for part in family.__subclasses__() for each in (part, *_below(part))]


def sentence_of(part: Maker) -> str:
    """Return the first sentence of what a part says about itself; of a builder, what it makes.

    Examples
    --------
    >>> from trundle.mechanics.motions import Fixed
    >>> sentence_of(Fixed)
    'A support at rest.'
    """
    sentence = " ".join((part.__doc__ or "").partition("\n\n")[0].split()).removeprefix("Make ")
    return sentence[:1].upper() + sentence[1:]
