"""What the writers of models have in common: elements of XML, and rows of numbers."""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterable
from typing import Any
from xml.etree import ElementTree as ET

from ..case import Task

REACH = 50.0  # m: half the width of a plane where the format has none without end
THICK = 1.0  # m: of such a plane
_THIN = 1e-5  # m: half the thickness of a disc, which has none here


def add(parent: ET.Element | None, tag: str, text: Any = None, **attributes: Any) -> ET.Element:
    """Add an element below another, or begin with one; numbers and rows of numbers are written in full.

    Examples
    --------
    >>> add(None, "geom", size=(0.1, 2.0)).attrib
    {'size': '0.1 2'}
    """
    words = {key: _word(value) for key, value in attributes.items()}
    made = ET.Element(tag, words) if parent is None else ET.SubElement(parent, tag, words)
    if text is not None:
        made.text = _word(text)
    return made


def written(root: ET.Element, said: str) -> str:
    """Return the file, with what is said of it on top.

    Examples
    --------
    >>> print(written(add(None, "robot"), "A ball -- of steel"), end="")
    <!-- A ball - of steel -->
    <robot />
    """
    ET.indent(root)
    comment = re.sub("-{2,}", "-", said)  # XML has no other way
    return f"<!-- {comment} -->\n{ET.tostring(root, encoding='unicode')}\n"


def row(numbers: Iterable[Any]) -> str:
    """Write numbers so that they read back as the same.

    Examples
    --------
    >>> row([0.1, -0.0, 1e-5])
    '0.1 0 1e-05'
    """
    return " ".join(repr(float(number) + 0.0).removesuffix(".0") for number in numbers)


def disc(shape: Task) -> tuple[float, float]:
    """Return radius and half the thickness of a disc that is a cylinder to an engine."""
    return shape["radius"], _THIN


def angles(orientation: list[float]) -> list[float]:
    """Return roll, pitch and yaw about fixed axes, rad.

    Examples
    --------
    >>> [round(angle, 6) for angle in angles([0.5, 0.5, 0.5, 0.5])]
    [1.570796, 0.0, 1.570796]
    """
    from scipy.spatial.transform import Rotation

    with warnings.catch_warnings():  # looking straight up or down, the yaw may be anything: it is 0
        warnings.simplefilter("ignore", UserWarning)
        return [float(angle) for angle in Rotation.from_quat(orientation, scalar_first=True).as_euler("xyz")]


def lone_body(situation: Task) -> Task:
    """Return the body."""
    (body,) = situation["bodies"]
    return body


def six(inertia: list[list[float]]) -> dict[str, float]:
    """Return the six numbers of a tensor of inertia.

    Examples
    --------
    >>> six([[1, 2, 3], [2, 4, 5], [3, 5, 6]])
    {'ixx': 1, 'iyy': 4, 'izz': 6, 'ixy': 2, 'ixz': 3, 'iyz': 5}
    """
    return {f"i{'xyz'[i]}{'xyz'[j]}": inertia[i][j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))}


def _word(value: Any) -> str:
    if isinstance(value, str):
        return value
    return row(value if hasattr(value, "__iter__") else (value,))
