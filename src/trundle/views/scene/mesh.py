"""Triangles: what body and support have in common as meshes."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

PAINTS = {"body": "body_pattern", "support": "support_marks"}  # the column of a mesh's paint, by whose mesh it is
_ALIKE = 1e-5  # share of its size by which a mesh may differ from one of the same name: a hundredth of a pixel


@dataclass(frozen=True, eq=False)
class Mesh:
    """A surface of triangles."""

    # `vertices`, `normals`: (v, 3): m, and unit vectors away from the material
    vertices: Array
    normals: Array
    triangles: NDArray[np.uint32]  # (t, 3): anticlockwise seen from where the normals point to
    paint: Array  # (v, 2) or (v, 3): coordinates that the markings are painted by
    coarse: NDArray[np.uint32] | None = None  # (c, 3): fewer triangles of the same vertices, for pictures of few pixels

    def columns(self, name: str) -> dict[str, NDArray[Any]]:
        """Return it as columns, their names beginning with whose mesh it is."""
        parts = (self.vertices, self.normals, self.paint, self.triangles, self.coarse)
        kinds = (np.float32,) * 3 + (np.uint32,) * 2
        columns = zip(columns_of_mesh(name), parts, kinds, strict=True)
        return {column: part.astype(kind) for column, part, kind in columns if part is not None}

    @cached_property
    def size(self) -> float:
        """How far it reaches from its origin along an axis, m."""
        return float(np.max(np.abs(self.vertices), initial=0.0))

    @cached_property
    def name(self) -> str:
        """A short text that all meshes share that differ in nothing but their size."""
        digest = hashlib.blake2b(digest_size=12)
        for part in (self.vertices / (self.size or 1.0), self.normals, self.paint):
            digest.update(np.rint(part / _ALIKE).astype("<i4").tobytes())
        for triangles in (self.triangles, self.coarse):
            digest.update(b"" if triangles is None else triangles.astype("<u4").tobytes())
        return digest.hexdigest()


def columns_of_mesh(name: str) -> tuple[str, str, str, str, str]:
    """Return the names of a mesh's columns: vertices, normals, paint, triangles, and fewer of these."""
    return f"{name}_vertices", f"{name}_normals", PAINTS[name], f"{name}_triangles", f"{name}_coarse"


def joined(meshes: list[Mesh]) -> Mesh:
    """Return several meshes as one."""
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes[:-1])])
    return Mesh(
        np.concatenate([mesh.vertices for mesh in meshes]),
        np.concatenate([mesh.normals for mesh in meshes]),
        np.concatenate([mesh.triangles + start for mesh, start in zip(meshes, starts, strict=True)]).astype(np.uint32),
        np.concatenate([mesh.paint for mesh in meshes]),
    )


def grid_triangles(rows: int, columns: int) -> NDArray[np.uint32]:
    """Return the two triangles of each cell of a grid whose vertices are counted row by row."""
    corner = np.arange((rows - 1) * columns).reshape(rows - 1, columns)[:, :-1].ravel()
    a, b, c, d = corner, corner + 1, corner + columns, corner + columns + 1
    return np.concatenate([np.stack([a, b, c], axis=1), np.stack([b, d, c], axis=1)]).astype(np.uint32)


def oriented(vertices: Array, normals: Array, triangles: NDArray[np.uint32]) -> NDArray[np.uint32]:
    """Return the triangles that are more than a line, each anticlockwise seen from where its normals point to."""
    p, q, r = (vertices[triangles[:, i]] for i in range(3))
    area = np.cross(q - p, r - p)
    size = np.linalg.norm(area, axis=1)
    extent = float(np.max(np.ptp(vertices, axis=0)))
    facing = np.sum(area * normals[triangles].mean(axis=1), axis=1)
    kept = triangles.copy()
    kept[facing < 0] = kept[facing < 0][:, ::-1]
    return kept[size > 1e-12 * extent * extent]
