"""A file from outside: its bytes, its text, the tables and members in it, each looked at once and with care."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path, PurePosixPath
from typing import Any

from ..errors import InvalidValueError
from ..extras import need
from ..files import check_heaps
from .grid import Grid, decoded, grid_of, grid_of_cells

_MOST = 2**29  # bytes of one member of an archive
_SMALL, _TIMES = 2**23, 200  # bytes, above which nothing may be so many times larger than its archive says
_MEMBERS = 4096
_TABLES = (".csv", ".tsv", ".txt")
_BOOKS = (".xlsx", ".xlsm")


@dataclass(frozen=True)
class File:
    r"""A file that was read into memory.

    Parameters
    ----------
    path : Path
        Its name; of a member of an archive, that of the archive and its own.
    content : bytes
        What is in it.
    decimal : str, optional
        "point" or "comma", where somebody said so.

    Examples
    --------
    >>> File(Path("a.csv"), b"t,x\n0,1\n").grids[""].names
    ['t', 'x']
    """

    path: Path
    content: bytes
    decimal: str | None = None

    @property
    def ending(self) -> str:
        """The ending of its name, in small letters."""
        return self.path.suffix.lower()

    @property
    def is_archive(self) -> bool:
        """Whether it is a zip, by its first bytes."""
        return self.content[:4] == b"PK\x03\x04"

    @cached_property
    def grids(self) -> dict[str, Grid]:
        """Its tables by name: of a text the one, of a spreadsheet one a sheet, of an archive one a member."""
        if self.ending in _BOOKS:
            return {name: grid for name, grid in self._sheets() if grid.rows or grid.head}
        if self.is_archive:
            members = (File(Path(name), content, self.decimal) for name, content in self.members(*_TABLES, *_BOOKS))
            found = {(f"{member.path.stem}/{name}" if name else member.path.stem): grid
                     for member in members for name, grid in member.grids.items()}  # fmt: skip
            if not found:
                raise InvalidValueError("file", "must hold a table", self.path.name, "There is none in this archive.")
            return found
        return {"": grid_of(decoded(self.content, self.path.name), self.decimal)}

    def members(self, *endings: str) -> Iterator[tuple[str, bytes]]:
        """Yield the members of an archive with one of these endings; nothing is ever written to the disk."""
        with zipfile.ZipFile(io.BytesIO(self.content)) as archive:
            for member in self._trusted(archive):
                place = PurePosixPath(member.filename)
                hidden = any(part.startswith((".", "__")) for part in place.parts) or place.parent.name == "meta"
                if place.suffix.lower() in endings and not hidden:
                    self._check_size(member)
                    yield place.name, archive.read(member)

    def _trusted(self, archive: zipfile.ZipFile) -> list[zipfile.ZipInfo]:
        """Return what is in an archive, if it is one of data and no trap."""
        found = [member for member in archive.infolist() if not member.is_dir()]
        if len(found) > _MEMBERS:
            raise InvalidValueError("file", f"must hold at most {_MEMBERS} files", f"{len(found)} in {self.path.name}")
        for member in found:
            parts = PurePosixPath(member.filename.replace("\\", "/")).parts
            if ".." in parts or "/" in parts[:1] or ":" in member.filename.partition("/")[0]:
                rule = "must name its files within itself"
                raise InvalidValueError("file", rule, member.filename, "This archive was made to do harm.")
        return found

    def _check_size(self, member: zipfile.ZipInfo) -> None:
        """Refuse a member that would fill the memory; zipfile reads no more of one than its size says."""
        size, packed = member.file_size, max(member.compress_size, 1)
        if size > _MOST or (size > _SMALL and size > _TIMES * packed):
            rule = f"must hold files of at most {_MOST >> 20} MB that are packed at most {_TIMES} to 1"
            received = f"{member.filename} of {size / 2**20:.0f} MB, packed {size / packed:.0f} to 1"
            raise InvalidValueError("file", rule, received, "Unpack it and look what it is.")

    def _sheets(self) -> Iterator[tuple[str, Grid]]:
        need("fit", self.path.name, "CSV needs nothing more.")
        from openpyxl import load_workbook

        with zipfile.ZipFile(io.BytesIO(self.content)) as archive:
            for member in self._trusted(archive):
                self._check_size(member)
        book = load_workbook(io.BytesIO(self.content), read_only=True, data_only=True, keep_links=False)
        try:
            for sheet in book.worksheets:
                sheet.reset_dimensions()  # what the file says of its own size may be wrong
                yield sheet.title, grid_of_cells(list(sheet.iter_rows(values_only=True)), self.decimal)
        finally:
            book.close()


@contextmanager
def opened(file: File) -> Iterator[Any]:
    """Give what is in a file of HDF5, by name; nothing where it is of another kind."""
    import h5py

    if not file.content.startswith(b"\x89HDF"):
        yield {}
        return
    check_heaps(file.content)
    with h5py.File(io.BytesIO(file.content)) as root:
        yield root
