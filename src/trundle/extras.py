"""The extras of pyproject.toml: what only some users need, and a word about it where it is not installed."""

from __future__ import annotations

from importlib.util import find_spec

from .errors import MissingExtraError

MODULES = {  # what each brings, as it is imported
    "fit": ("lmfit", "emcee", "defusedxml", "openpyxl"),
    "lab": ("fastapi", "uvicorn", "pebble", "pygltflib"),
    "jax": ("jax",),
    "notebook": ("anywidget",),
    "numba": ("llvmlite", "numba"),
    "parquet": ("pyarrow",),
    "score": ("pytest",),
    "sweep": ("dask", "distributed", "zarr"),
    "video": ("cv2",),
}


def need(extra: str, asked: str, instead: str = "") -> None:
    """Refuse what an extra is needed for, unless it is installed; imports nothing of it.

    Examples
    --------
    >>> need("lab", "scene.glb")
    """
    if not all(map(find_spec, MODULES[extra])):
        raise MissingExtraError(asked, extra, instead)
