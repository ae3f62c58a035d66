"""What goes elsewhere: scripts without trundle, cases and exact runs as plain files, and a report for a CI."""

from __future__ import annotations

import csv
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET  # what is written here is never parsed

from ..errors import UnknownNameError
from .case import Case, Motion
from .results import Score

_HERE = Path(__file__).parent
_COLUMNS = {
    "position": ("x", "y", "z"),
    "orientation": ("qw", "qx", "qy", "qz"),
    "velocity": ("vx", "vy", "vz"),
    "angular_velocity": ("wx", "wy", "wz"),
}
_LICENCE = (
    "Cases and exact runs: CC0 1.0, no rights reserved.\n"
    "NAME.json: what an engine is told, in SI units. NAME.csv: the exact run, a row for each sample and body.\n"
    "Orientations are unit quaternions (w, x, y, z), body axes to axes of the support at rest; angular velocities are\n"
    "in those, too. Write a CSV of the same columns from your engine, and compare:\n\n"
    "    python3 score.py incline mine.csv\n\n"
    "A bowl is told as triangles. What an exact ball does on them is in NAME-exact-but-for-it.csv: compare with that,\n"
    "too, and you know which part of an error is that of the mesh.\n"
)


def scripts() -> list[tuple[str, str]]:
    """Return engine and case of each script that shows one finding without trundle.

    Examples
    --------
    >>> ("mujoco", "diagonal-box") in scripts()
    True
    """
    pairs = (path.stem.split("_", 1) for path in sorted((_HERE / "repro").glob("*.txt")))
    return [(engine, case.replace("_", "-")) for engine, case in pairs]


def script(engine: str, case: str) -> str:
    """Return a script that shows one finding without trundle.

    Examples
    --------
    >>> script("mujoco", "incline").splitlines()[3]
    'step, and with the noslip solver, it falls as the step does.'
    """
    if (engine, case) not in scripts():
        raise UnknownNameError("script", f"{engine} {case}", [" ".join(pair) for pair in scripts()])
    return (_HERE / "repro" / f"{engine}_{case.replace('-', '_')}.txt").read_text(encoding="utf-8")


def case_files(cases: Sequence[Case]) -> dict[str, str]:
    """Return the files of cases by name: tasks, exact runs, a scorer, and a word about them.

    Examples
    --------
    >>> import trundle as tr
    >>> sorted(case_files(tr.conformance.cases()[:1]))
    ['README.txt', 'billiard-draw.csv', 'billiard-draw.json', 'score.py']
    """
    files = {"README.txt": _LICENCE, "score.py": (_HERE / "one_file_scorer.py").read_text(encoding="utf-8")}
    for case in cases:
        task: dict[str, Any] = {key: value for key, value in case.task(0.0).items() if key not in ("dt", "setting")}
        files[f"{case.name}.json"] = json.dumps(task, indent=1) + "\n"
        files[f"{case.name}.csv"] = table(case.exact())
        on_mesh = case.on_mesh()
        if on_mesh is not None:
            files[f"{case.name}-exact-but-for-it.csv"] = table(on_mesh)
    return files


def table(motion: Motion) -> str:
    r"""Return a motion as CSV: a row for each sample and body.

    Examples
    --------
    >>> import trundle as tr
    >>> table(tr.conformance.cases()[0].exact()).partition("\n")[0]
    'time,body,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz'
    """
    import io

    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(["time", "body", *(name for part in _COLUMNS for name in _COLUMNS[part])])
    for i, time in enumerate(motion.time):
        for body in range(motion.position.shape[1]):
            values = (float(x) for part in _COLUMNS for x in getattr(motion, part)[i, body])
            writer.writerow([float(time), body, *values])
    return stream.getvalue()


def junit(score: Score, at_most: float | None, least_order: float | None) -> str:
    """Return the profiles as JUnit XML: a test for each engine, setting and case.

    Examples
    --------
    >>> junit(Score(()), 1e-3, None).splitlines()[-1]
    '<testsuite name="trundle score" tests="0" failures="0" skipped="0" />'
    """
    suite = ET.Element("testsuite", name="trundle score")
    failed = dict.fromkeys(("tests", "failures", "skipped"), 0)
    for cell in score.profiles:
        test = ET.SubElement(suite, "testcase", classname=f"{cell.engine}, {cell.label}", name=cell.case)
        failed["tests"] += 1
        lines = Score(cell.rows).failures(at_most, least_order)
        if lines:
            failed["failures"] += 1
            ET.SubElement(test, "failure", message=lines[0])
        elif cell.name == "cannot":
            failed["skipped"] += 1
            ET.SubElement(test, "skipped", message=cell.rows[0].message)
    for name, count in failed.items():
        suite.set(name, str(count))
    ET.indent(suite)
    return f"<?xml version='1.0' encoding='utf-8'?>\n{ET.tostring(suite, encoding='unicode')}\n"
