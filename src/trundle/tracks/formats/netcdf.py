"""NetCDF, trundle's own runs among them."""

from __future__ import annotations

from collections.abc import Sequence

from ...files import read_netcdf
from ..arrays import dataset_table
from ..file import File
from ..options import Options
from ..table import Table
from .base import Format


class NetCDF(Format):
    """Variables along a time, with their units as attributes."""

    name = "NetCDF"
    origin = "`Trajectory.save`, xarray"
    endings = (".nc", ".nc4", ".h5", ".cdf")

    def recognises(self, file: File) -> bool:  # noqa: ARG002
        """Anything with such an ending should be one."""
        return True

    def read(self, file: File, options: Options) -> Sequence[Table]:
        """Return the one track."""
        import xarray

        classic = file.content[:3] == b"CDF"  # NetCDF3, which is no HDF5
        data = xarray.load_dataset(file.path, decode_times=False) if classic else read_netcdf(file.path)
        return [dataset_table(data, options)]
