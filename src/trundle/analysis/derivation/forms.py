"""Which derivation belongs to which closed form.

The closed form of `solve/exact/<name>.py` has its derivation, if any, in `derivation/<name>.py`: a class `Setting` with
`of(system)`, which says what is there; `derive_system(setting)`, which yields the steps up to the proof of the form;
and `numbers_of(motion, system)`, which yields its constants in numbers.
"""

from __future__ import annotations

from importlib import import_module
from importlib.util import find_spec
from types import ModuleType
from typing import TYPE_CHECKING, Any

from ...solve.exact import CLOSED_FORMS

if TYPE_CHECKING:
    from ...mechanics.system import RollingSystem, State


def module_named(name: str) -> ModuleType:
    """Return the module that derives a closed form.

    Examples
    --------
    >>> module_named("sphere_on_plane").Setting().turning
    False
    """
    return import_module(f".{name}", __package__)


def module_of(form: type) -> ModuleType:
    """Return the module that derives a closed form.

    Examples
    --------
    >>> module_of(CLOSED_FORMS[0]).__name__.rpartition(".")[2]
    'sphere_on_plane'
    """
    return module_named(form.__module__.rpartition(".")[2])


def form_of(system: RollingSystem, start: State | None) -> tuple[Any, Any]:
    """Return the closed form that covers a system, and the module that derives it.

    Examples
    --------
    >>> import trundle as tr
    >>> form_of(tr.RollingSystem(tr.Body.solid_sphere(1.0, 1.0), tr.Support(tr.Plane())), None)[0].equation
    'T5'
    """
    for form in CLOSED_FORMS:
        if find_spec(f".{form.__module__.rpartition('.')[2]}", __package__) and not form.violations(system, start):
            return form, module_of(form)
    return None, None
