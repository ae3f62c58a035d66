"""The systems that ship, by name: to list them SymPy need not be loaded."""

from __future__ import annotations

NAMES = {
    "cylinder": "Cylinder on a plane",
    "cylinder-in-cylinder": "Cylinder in a larger cylinder",
    "sphere": "Sphere on a plane, free to pivot",
    "sphere-no-pivot": "Sphere on a plane that may not pivot",
    "sphere-on-turntable": "Sphere on a turning plane",
    "coin": "Coin rolling upright",
    "disc": "Disc rolling and leaning",
    "skate": "Skate or knife edge",
    "car": "Car with steered front wheels",
    "trailers": "Tractor with two trailers",
    "cart": "Two wheels on one axle",
    "disguised": "A surface in disguise",
}
