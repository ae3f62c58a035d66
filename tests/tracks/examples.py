"""A small file of each format, written by hand from its description, and the numbers that are in it.

The same four places everywhere: at 0, 0.04, 0.08 and 0.12 s; the third was missed.
"""

from __future__ import annotations

import io
import pickle
import zipfile
from dataclasses import dataclass, field
from typing import Any

import numpy as np

NAN = float("nan")
T = [0.0, 0.04, 0.08, 0.12]
X, Y = [0.1, 0.102, NAN, 0.105], [0.0, 0.005, NAN, 0.016]  # m
PLACES = {"t": T, "x": X, "y": Y}


@dataclass(frozen=True)
class Example:
    """A file, what has to be said of it, and what it then holds in SI."""

    id: str
    format: str  # the name of its class
    file: str
    content: bytes
    options: dict[str, Any] = field(default_factory=dict)
    truth: dict[str, list[float]] = field(default_factory=lambda: PLACES)
    says: str = ""


def _text(lines: str) -> bytes:
    return lines.strip("\n").encode() + b"\n"


# --- Tracker ------------------------------------------------------------------------------------------

EXPORT = """
\tmass A\t\t\t
t\tx\ty\tθ\t
0.000E0\t1.000E-1\t0.000E0\t0.0\t
4.000E-2\t1.020E-1\t5.000E-3\t90.0\t
8.000E-2\t\t\t\t
1.200E-1\t1.050E-1\t1.600E-2\t180.0\t
"""
MULTI = """
#multi:
,mass A,,mass B,,
t,x,y,x,y,
0.00,7,8,0.100,0.000,
0.04,7,8,0.102,0.005,
0.08,7,8,,,
0.12,,,0.105,0.016,
"""
COPIED = """
mass_A;;
t;x;y
0,00;10,0;0,0
0,04;10,2;0,5
0,12;10,5;1,6
"""
MOMENTUM = """
 mass_A     
t x y px frame
0.00 0.100 0.000 5.5 0
0.04 0.102 0.005 5.5 1
0.12 0.105 0.016 5.5 3
"""  # noqa: W291
GONE = {name: [values[i] for i in (0, 1, 3)] for name, values in PLACES.items()}


def trk(
    marks: dict[int, tuple[float, float]],
    frames: dict[int, dict[str, float]],
    *,
    more: str = "",
    unit: str | None = "m",
    step: float | None = 40.0,
    clip: str = "",
    ruler: bool = True,
) -> bytes:
    """Return a project with one point mass, in Tracker's XML, and `more` tracks."""

    def properties(values: dict[str, float]) -> str:
        return "".join(f'<property name="{name}" type="double">{value}</property>' for name, value in values.items())

    def array(kind: str, values: dict[int, dict[str, float]]) -> str:
        inner = (
            f'<property name="[{i}]" type="object"><object class="{kind}$FrameData">'
            f"{properties(data)}</object></property>"
            for i, data in values.items()
        )
        return f'<property name="framedata" type="array" class="[L{kind}$FrameData;">{"".join(inner)}</property>'

    tracker, media = "org.opensourcephysics.cabrillo.tracker", "org.opensourcephysics.media.core"
    points = array(f"{tracker}.PointMass", {i: {"x": x, "y": y} for i, (x, y) in marks.items()})
    axes = array(f"{media}.ImageCoordSystem", frames)
    tape = f'<property name="item" type="object"><object class="{tracker}.TapeMeasure"></object></property>'
    return f"""<?xml version="1.0" encoding="UTF-8"?>
<object class="{tracker}.TrackerPanel">
  <property name="semantic_version" type="string">6.1.2</property>
  <property name="videoclip" type="object"><object class="{media}.VideoClip">{clip}</object></property>
  <property name="clipcontrol" type="object"><object class="{media}.StepperClipControl">
    {properties({"delta_t": step} if step is not None else {})}</object></property>
  <property name="coords" type="object"><object class="{media}.ImageCoordSystem">{axes}</object></property>
  {"" if unit is None else f'<property name="length_unit" type="string">{unit}</property>'}
  <property name="tracks" type="collection" class="java.util.ArrayList">
    {tape if ruler else ""}
    <property name="item" type="object"><object class="{tracker}.PointMass">
      <property name="mass" type="double">0.065</property>
      <property name="name" type="string">mass A</property>{points}</object></property>{more}
  </property>
</object>
""".encode()


AXES = {"xorigin": 320.0, "yorigin": 240.0, "angle": 0.0, "xscale": 1000.0, "yscale": 1000.0}
# x = (x_px − 320)/1000, y = −(y_px − 240)/1000.
MARKS = {0: (420.0, 240.0), 1: (422.0, 235.0), 3: (425.0, 224.0)}
PROJECT = trk(MARKS, {0: AXES})


def zipped(**members: bytes) -> bytes:
    """Return an archive of members by their names."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return stream.getvalue()


# --- laboratories -------------------------------------------------------------------------------------

LOGGER_PRO = """
"Video Analysis: Time (s)","Video Analysis: X (cm)","Video Analysis: Y (cm)","Video Analysis: X Velocity (cm/s)"
0,10.0,0.0,5.0
0.04,10.2,0.5,6.0
0.08,,,
0.12,10.5,1.6,7.0
"""
TWO_OBJECTS = """
Video Analysis: Time (s),Video Analysis: X (m),Video Analysis: Y (m),Video Analysis: X 2 (m),Video Analysis: Y 2 (m)
0,7,7,0.100,0.000
0.04,7,7,0.102,0.005
0.08,7,7,,
0.12,7,7,0.105,0.016
"""
VERNIER = """
Time (s),X (m),Y (m),X Velocity (m/s),Y Velocity (m/s)
0,0.100,0.000,0.05,0.1
0.04,0.102,0.005,0.05,0.2
0.08,,,,
0.12,0.105,0.016,0.05,0.3
"""
CAPSTONE = """
Time (s) Run #1,x (cm) Run #1,y (cm) Run #1,Time (s) Run #2,x (cm) Run #2,y (cm) Run #2
0.0,1,1,0.00,10.0,0.0
0.1,1,1,0.04,10.2,0.5
,,,0.08,,
,,,0.12,10.5,1.6
"""
CAPSTONE_TWO = """
Run #1,,,Run #2,,
Time (s),"Position, x (cm)","Position, y (cm)",Time (s),"Position, x (cm)","Position, y (cm)"
0.0,1,1,0.00,10.0,0.0
0.1,1,1,0.04,10.2,0.5
,,,0.08,,
,,,0.12,10.5,1.6
"""
PHYPHOX = """
"Time (s)","Gyroscope x (rad/s)","Gyroscope y (rad/s)","Gyroscope z (rad/s)","Absolute (rad/s)"
0.00,1.0E0,0.0,-2.0,2.236
0.04,1.1E0,0.1,-2.0,2.285
0.08,1.2E0,0.2,-2.0,2.341
0.12,1.3E0,0.3,-2.0,2.404
"""
GYROSCOPE = {"t": T, "wx": [1.0, 1.1, 1.2, 1.3], "wy": [0.0, 0.1, 0.2, 0.3], "wz": [-2.0] * 4}


def workbook(**sheets: list[list[Any]]) -> bytes:
    """Return a spreadsheet."""
    from openpyxl import Workbook

    book = Workbook()
    book.remove(book.active)
    for name, rows in sheets.items():
        sheet = book.create_sheet(name.replace("_", " "))
        for row in rows:
            sheet.append(row)
    stream = io.BytesIO()
    book.save(stream)
    return stream.getvalue()


def cells(lines: str) -> list[list[Any]]:
    """Return the cells of a text as a spreadsheet has them: numbers, words and nothing."""
    rows = [row.split(",") for row in lines.strip().splitlines()]
    return [[_cell(cell.strip('"')) for cell in row] for row in rows]


def _cell(cell: str) -> Any:
    try:
        return float(cell)
    except ValueError:
        return cell or None


# --- networks -----------------------------------------------------------------------------------------

DEEPLABCUT = """
scorer,net,net,net,net,net,net
bodyparts,ball,ball,ball,mark,mark,mark
coords,x,y,likelihood,x,y,likelihood
0,100.0,-0.0,0.99,7,7,1
1,102.0,-5.0,0.98,7,7,1
2,333.0,333.0,0.10,7,7,1
3,105.0,-16.0,0.97,7,7,1
"""
PIXELS: dict[str, Any] = {"rate": 25, "pixel": "1 mm"}


def deeplabcut_hdf5() -> bytes:
    """Return the table that pandas writes through PyTables: the names of columns are a pickle of protocol 0."""
    import h5py

    labels = [("net", part, coord) for part in ("ball", "mark") for coord in ("x", "y", "likelihood")]
    rows = [[float(cell) for cell in line.split(",")] for line in DEEPLABCUT.strip().splitlines()[3:]]
    table = np.zeros(4, dtype=[("index", "<i8"), ("values_block_0", "<f8", (6,))])
    table["index"], table["values_block_0"] = range(4), [row[1:] for row in rows]
    stream = io.BytesIO()
    with h5py.File(stream, "w") as file:
        dataset = file.create_group("df_with_missing").create_dataset("table", data=table)
        dataset.attrs["values_block_0_kind"] = np.bytes_(pickle.dumps(labels, 0))
    return stream.getvalue()


def sleap() -> bytes:
    """Return an analysis file of two tracks with two nodes each."""
    import h5py

    places = np.full((2, 2, 2, 4), 7.0)
    places[1, :, 0] = [[100.0, 102.0, NAN, 105.0], [0.0, -5.0, NAN, -16.0]]
    stream = io.BytesIO()
    with h5py.File(stream, "w") as file:
        file["tracks"] = places
        file["node_names"], file["track_names"] = [b"centre", b"spot"], [b"first", b"second"]
        file["track_occupancy"] = np.ones((4, 2))
    return stream.getvalue()


# --- tables -------------------------------------------------------------------------------------------

CSV = """
t,x (cm),y (cm)
0,10.0,0.0
0.04,10.2,0.5
0.08,,
0.12,10.5,1.6
"""
UNITS = """
time;x;y
ms;mm;mm
0;100;0
40;102;5
80;;
120;105;16
"""


def netcdf() -> bytes:
    """Return a dataset of xarray's, in centimetres."""
    import xarray

    data = xarray.Dataset(
        {"x": ("time", np.array(X) * 100, {"units": "cm"}), "y": ("time", np.array(Y) * 100, {"units": "cm"})},
        coords={"time": ("time", T, {"units": "s"})},
        attrs={"frame": "corotating"},
    )
    stream = io.BytesIO()
    data.to_netcdf(stream, engine="h5netcdf")
    return stream.getvalue()


def parquet() -> bytes:
    """Return a table of pandas', where Parquet can be written."""
    import pandas as pd

    stream = io.BytesIO()
    pd.DataFrame({"t": T, "x [cm]": np.array(X) * 100, "y [cm]": np.array(Y) * 100}).to_parquet(stream)
    return stream.getvalue()


def _wide(text: str) -> bytes:
    return text.strip("\n").replace("\n", "\r\n").encode("utf-16")


METRES = {"units": "m"}
EXAMPLES: list[Example] = [
    Example("export", "TrackerExport", "track.txt", _text(EXPORT), METRES, says="x, y in m, 4 rows, 1 gap (1 frame)"),
    Example("export-angle", "TrackerExport", "track.txt", _text(EXPORT), {"units": {"length": "m", "angle": "deg"}},
            {"angle": [0.0, np.pi / 2, NAN, np.pi]}),
    Example("export-semicolon-comma", "TrackerExport", "track.txt",
            _text(EXPORT.replace("\t", ";").replace(".", ",")), METRES, says="decimal comma"),
    Example("export-wide", "TrackerExport", "track.txt", _wide(EXPORT.replace(".", ",")), METRES, says="decimal comma"),
    Example("export-units", "TrackerExport", "track.txt",
            _text(EXPORT.replace("t\tx\ty", "t (s)\tx (m)\ty (m)")), {}),
    Example("multi", "TrackerExport", "track.csv", _text(MULTI), METRES | {"track": "mass B"}),
    Example("copied", "TrackerExport", "track.txt", _text(COPIED), {"units": "cm"}, GONE, "1 gap (1 frame), 25 frames"),
    Example("export-space", "TrackerExport", "track.txt", _text(MOMENTUM), METRES, GONE),
    Example("project", "TrackerProject", "film.trk", PROJECT, {}, GONE, "x, y in m, 3 rows, 1 gap (1 frame)"),
    Example("zip", "TrackerProject", "film.trz",
            zipped(**{"film.trk": PROJECT, "videos/film.mp4": b"no film"}), {}, GONE),
    Example("logger-pro", "LoggerPro", "lab.csv", _text(LOGGER_PRO), {}, PLACES | {"vx": [0.05, 0.06, NAN, 0.07]}),
    Example("logger-pro-two", "LoggerPro", "lab.csv", _text(TWO_OBJECTS), {"track": "Video Analysis 2"}),
    Example("vernier", "VernierVideoAnalysis", "film.csv", _text(VERNIER), {}, PLACES | {"vy": [0.1, 0.2, NAN, 0.3]}),
    Example("capstone", "Capstone", "lab.csv", _text(CAPSTONE), {"track": "Run #2"}),
    Example("capstone-two-lines", "Capstone", "lab.txt", _text(CAPSTONE_TWO), {"track": "Run #2"}),
    Example("phyphox", "Phyphox", "Raw Data.csv", _text(PHYPHOX), {}, GYROSCOPE,
            "in rad/s, 4 rows, no gaps, 25 samples a second"),
    Example("phyphox-tab", "Phyphox", "a.csv", _text(PHYPHOX.replace(",", "\t").replace(".", ",")), {}, GYROSCOPE),
    Example("phyphox-zip", "Phyphox", "Gyroscope.zip",
            zipped(**{"Raw Data.csv": _text(PHYPHOX), "meta/time.csv": b'"event","system time"\n"START",1.6E9\n'}),
            {}, GYROSCOPE),
    Example("phyphox-excel", "Phyphox", "Gyroscope.xlsx",
            workbook(Raw_Data=cells(PHYPHOX), Metadata_Device=[["property", "value"], ["version", "1.1"]]),
            {}, GYROSCOPE),
    Example("deeplabcut", "DeepLabCut", "ballDLC.csv", _text(DEEPLABCUT), PIXELS | {"track": "ball"},
            says="y turned up"),
    Example("deeplabcut-hdf5", "DeepLabCutHDF5", "ballDLC.h5", deeplabcut_hdf5(), PIXELS | {"track": "ball"}),
    Example("sleap", "Sleap", "ball.analysis.h5", sleap(), PIXELS | {"track": "second/centre"}),
    Example("csv", "PlainTable", "track.csv", _text(CSV), {}, says="x, y in cm"),
    Example("strokes", "PlainTable", "track.csv", _text(CSV.replace("t,x (cm),y (cm)", "Zeit/s,x/cm,y / cm")), {},
            says="t from column `Zeit/s`, x, y in cm"),
    Example("tsv", "PlainTable", "track.tsv", _text(CSV.replace(",", "\t")), {}),
    Example("csv-bom", "PlainTable", "track.csv", b"\xef\xbb\xbf" + _text(CSV).replace(b"\n", b"\r\n"), {}),
    Example("units-row", "PlainTable", "track.csv", _text(UNITS), {}, says="t from column `time` in ms, x, y in mm"),
    Example("excel", "PlainTable", "track.xlsx", workbook(Sheet=cells(CSV)), {}),
    Example("netcdf", "NetCDF", "track.nc", netcdf(), {}, says="seen from the turning support"),
]  # fmt: skip


def written(example: Example, folder: Any) -> Any:
    """Write an example to a folder, and return its path."""
    path = folder / example.file
    path.write_bytes(example.content)
    return path
