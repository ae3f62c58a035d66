"""The tracks that come with trundle, made from what their files say: `python -m tests.tracks.making` writes them."""

from __future__ import annotations

import tomllib
from fractions import Fraction

import numpy as np

import trundle as tr
from trundle.tracks import example, example_names
from trundle.units import to_si


def made(name: str) -> str:
    """Return the text of an example: the run with the true numbers, seen with noise, some frames missing."""
    one = example(name)
    seen = tomllib.loads(one.path.with_suffix(".toml").read_text())["seen"]
    tables = {key: dict(value) if isinstance(value, dict) else value for key, value in one.scenario.items()}
    for key, value in one.truth.items():
        part, _, rest = key.partition(".")
        (tables[part] if "[" not in part else tables["loads"][0])[rest] = value
    step = float(Fraction(seen["every"].removesuffix(" s")))
    tables["run"] |= {"every": step, "method": "auto"}
    data = tr.Scenario.read(tables).run().data
    times = np.asarray(data.time)
    places = np.column_stack([data.position.sel(axis=axis) for axis in seen["columns"]])
    draw = np.random.default_rng(seen["seed"])
    places += draw.normal(scale=to_si(one.noise, "length", "noise"), size=places.shape)
    lines = [f"# {one.title}", ",".join(["t (s)", *(f"{axis} (mm)" for axis in seen["columns"])])]
    for i, (time, row) in enumerate(zip(times, places, strict=True)):
        if i not in seen["missing"]:
            lines.append(",".join([f"{time:.5f}", *(f"{1e3 * value:.2f}" for value in row)]))
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    for known in example_names():
        example(known).path.write_text(made(known))
