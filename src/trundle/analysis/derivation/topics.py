"""What can be derived by name, without a scenario: titles only, so that listing them is quick."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Topic:
    """A derivation by name.

    Examples
    --------
    >>> TOPICS["turntable"].form
    'sphere_on_plane'
    """

    title: str  # its heading
    introduction: str  # what is derived
    form: str  # name of the closed form's module, in `trundle.solve.exact` and here alike
    setting: dict[str, Any]  # what the module's `Setting` is made from


_ALL = (True, True, True)

TOPICS = {
    "ball-on-plane": Topic(
        "Ball on a level plane under a force and a torque",
        "A ball rolls on a fixed level plane under a force and a torque of any direction. Which force does the plane "
        "exert, and how does the ball move?",
        "sphere_on_plane",
        {"force": _ALL, "torque": _ALL},
    ),
    "ball-on-incline": Topic(
        "Ball on an inclined plane",
        "A ball rolls on a fixed plane that leans. How much slower is it than a block without friction, and what "
        "makes it turn?",
        "sphere_on_plane",
        {"tilted": True},
    ),
    "turntable": Topic(
        "Ball on a level turntable",
        "A ball rolls on a level plane that turns steadily. Its path is a circle: any circle, and not about the axis.",
        "sphere_on_plane",
        {"turning": True},
    ),
    "tilted-turntable": Topic(
        "Ball on a tilted turntable",
        "The turning plane leans. The ball does not roll downhill: the centre of its circle drifts sideways.",
        "sphere_on_plane",
        {"turning": True, "tilted": True},
    ),
    "ball-with-drag": Topic(
        "Ball on a tilted turntable in air",
        "Air at rest brakes the ball in proportion to its speed. The circles shrink, and the drift turns downhill.",
        "sphere_on_plane",
        {"turning": True, "tilted": True, "drag": True},
    ),
    "cylinder-on-incline": Topic(
        "Cylinder on an inclined plane",
        "A cylinder rolls straight down a slope. Its constraint can be integrated: the place gives the turn.",
        "sphere_on_plane",
        {"tilted": True, "straight": True, "inertia_ratio": 0.5},
    ),
    "cylinder-in-cylinder": Topic(
        "Cylinder inside a larger cylinder",
        "A cylinder rolls inside a larger one that lies level, at any amplitude: a pendulum, in Jacobi's functions.",
        "cylinder_on_cylinder",
        {},
    ),
    "rolling-law": Topic(
        "Any body on any support",
        "The rolling law T1 to T3 for every convex body, every support and motion of it, and every load.",
        "general",
        {},
    ),
    "sphere-on-plane": Topic(
        "Sphere on a plane, everything at once",
        "The whole of the closed form T5: the plane leans and turns, a force, a torque and drag act.",
        "sphere_on_plane",
        {"turning": True, "tilted": True, "force": _ALL, "torque": _ALL, "drag": True},
    ),
}
