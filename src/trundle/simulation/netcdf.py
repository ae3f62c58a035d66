"""NetCDF files, written whole or not at all and without a copy in memory."""

from __future__ import annotations

import io
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..files import written_whole

if TYPE_CHECKING:
    import xarray

_READ_BACK = 2**16  # bytes: HDF5 reads its own headers again, never the data


def write_dataset(data: xarray.Dataset, target: Path) -> None:
    """Write a dataset to a NetCDF4 file, whole or not at all, without a copy of it in memory.

    Examples
    --------
    See `Trajectory.save`.
    """
    with written_whole(target) as temporary, _Patient(temporary) as stream:
        data.to_netcdf(stream, engine="h5netcdf")


class _Patient(io.RawIOBase):
    """A file that raises what the disk says at the end only: HDF5 brings the process down where it cannot write.

    Until then it behaves as if all were well. What HDF5 reads back as it writes is short, and is kept.
    """

    def __init__(self, path: Path) -> None:
        self.error: OSError | None = None
        self._file = path.open("w+b", buffering=0)
        self._place = self._end = 0
        self._kept: list[tuple[int, bytes]] = []  # what was not written, and where it belongs

    def readable(self) -> bool:
        return True

    def writable(self) -> bool:
        return True

    def seekable(self) -> bool:
        return True

    def seek(self, offset: int, whence: int = os.SEEK_SET) -> int:
        self._place = offset + {os.SEEK_SET: 0, os.SEEK_CUR: self._place, os.SEEK_END: self._end}[whence]
        return self._place

    def tell(self) -> int:
        return self._place

    def write(self, data: Any) -> int:
        given = left = memoryview(data).cast("B")
        with self._noting():
            self._file.seek(self._place)
            while self.error is None and left:
                left = left[self._file.write(left) :]
        if left and len(given) <= _READ_BACK:
            self._kept.append((self._place, bytes(given)))
        self._place += len(given)
        self._end = max(self._end, self._place)
        return len(given)

    def readinto(self, buffer: Any) -> int:
        found, begin = memoryview(buffer).cast("B"), self._place
        found[:] = bytes(len(found))
        with self._noting():
            self._file.seek(begin)
            self._file.readinto(found)
        for place, data in self._kept:
            first, last = max(begin, place), min(begin + len(found), place + len(data))
            if first < last:
                found[first - begin : last - begin] = data[first - place : last - place]
        self._place += len(found)
        return len(found)

    def truncate(self, size: int | None = None) -> int:
        self._end = self._place if size is None else size
        with self._noting():
            self._file.truncate(self._end)
        return self._end

    def close(self) -> None:
        self._file.close()
        super().close()

    def __exit__(self, *_: object) -> None:
        self.close()
        if self.error is not None:
            raise self.error from None

    @contextmanager
    def _noting(self) -> Iterator[None]:
        """Note the first error of the disk."""
        try:
            yield
        except OSError as error:
            self.error = self.error or error
