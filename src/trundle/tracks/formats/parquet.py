"""Parquet, by way of pandas."""

from __future__ import annotations

import io
from collections.abc import Sequence

from ...extras import need
from ..arrays import mapping_table
from ..file import File
from ..options import Options
from ..table import Table
from .base import Format


class Parquet(Format):
    """Columns under their headings."""

    name = "Parquet"
    origin = "pandas, Polars, R"
    endings = (".parquet", ".pq")

    def recognises(self, file: File) -> bool:  # noqa: ARG002
        """Anything with such an ending should be one."""
        return True

    def read(self, file: File, options: Options) -> Sequence[Table]:
        """Return the one track."""
        need("parquet", str(file.path), "CSV and NetCDF need nothing more.")
        import pandas as pd

        frame = pd.read_parquet(io.BytesIO(file.content))
        return [mapping_table({str(name): frame[name].to_numpy() for name in frame.columns}, options)]
