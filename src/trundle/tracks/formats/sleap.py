"""SLEAP's analysis file: nodes of tracks by frames, in pixels."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...errors import InvalidValueError
from ..file import File, opened
from ..options import Options
from ..table import Column, Table
from .base import Format


class Sleap(Format):
    """A dataset `tracks` of shape (tracks, 2, nodes, frames), beside the names of nodes and tracks."""

    name = "SLEAP's analysis HDF5"
    origin = "SLEAP: File > Export Analysis HDF5"
    endings = (".h5", ".hdf5", ".hdf")

    def recognises(self, file: File) -> bool:
        """Tell by the names of the datasets."""
        with opened(file) as root:
            return {"tracks", "node_names"} <= set(root)

    def read(self, file: File, options: Options) -> Sequence[Table]:  # noqa: ARG002
        """Return a track for each node of each track."""
        with opened(file) as root:
            places = np.asarray(root["tracks"], dtype=float)
            nodes = _words(root["node_names"])
            names = _words(root["track_names"]) if "track_names" in root else []
        if places.ndim != 4 or places.shape[1] != 2 or places.shape[2] != len(nodes):
            rule = "must hold `tracks` of the shape (tracks, 2, nodes, frames)"
            raise InvalidValueError("file", rule, f"{places.shape}, with {len(nodes)} nodes", "Export it again.")
        several = places.shape[0] > 1
        frames = np.arange(places.shape[3], dtype=float)
        return [
            Table(
                [Column("frame", frames, "frame", "frame"),
                 Column("x", places[i, 0, j], "px", "x"), Column("y", places[i, 1, j], "px", "y")],
                f"{names[i] if i < len(names) else f'track_{i}'}/{node}" if several else node,
                np.arange(frames.size), "frame", y_down=True,
            )
            for i in range(places.shape[0]) for j, node in enumerate(nodes)
        ]  # fmt: skip


def _words(dataset: Any) -> list[str]:
    return [word.decode(errors="replace") if isinstance(word, bytes) else str(word) for word in np.ravel(dataset[()])]
