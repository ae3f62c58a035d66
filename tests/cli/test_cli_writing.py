"""Files are whole or absent, whatever happens while they are written."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from trundle import files
from trundle.cli.writing import CannotWriteError, check_folder, write_together
from trundle.errors import InvalidValueError
from trundle.files import written_whole

BIG = b"x" * 1_000_000


def everything_below(folder: Path) -> set[str]:
    return {str(path.relative_to(folder)) for path in folder.rglob("*")}


def test_files_appear_together_in_a_new_folder(tmp_path: Path) -> None:
    out = tmp_path / "new" / "folder"
    written = write_together(out, {"a": lambda path: path.write_text("A"), "b": lambda path: path.write_text("B")})
    assert written == [out / "a", out / "b"]
    assert [path.read_text() for path in written] == ["A", "B"]
    assert everything_below(tmp_path) == {"new", "new/folder", "new/folder/a", "new/folder/b"}


def test_files_are_replaced_and_others_left(tmp_path: Path) -> None:
    (tmp_path / "a").write_text("old")
    (tmp_path / "other").write_text("stays")
    write_together(tmp_path, {"a": lambda path: path.write_text("new")})
    assert (tmp_path / "a").read_text() == "new"
    assert everything_below(tmp_path) == {"a", "other"}


def test_a_written_file_may_be_read_by_those_who_may_read_others(tmp_path: Path) -> None:
    (tmp_path / "plain").write_text("")
    (written,) = write_together(tmp_path, {"a": lambda path: path.write_text("new")})
    assert written.stat().st_mode == (tmp_path / "plain").stat().st_mode


@pytest.mark.parametrize("failure", [OSError(28, "No space left on device"), KeyboardInterrupt(), ZeroDivisionError()])
def test_a_failure_leaves_everything_as_it_was(tmp_path: Path, failure: BaseException) -> None:
    (tmp_path / "a").write_text("old")

    def fail(path: Path) -> None:
        path.write_bytes(BIG)
        raise failure

    expected = CannotWriteError if isinstance(failure, OSError) else type(failure)
    for folder in (tmp_path, tmp_path / "new"):
        with pytest.raises(expected) as caught:
            write_together(folder, {"a": lambda path: path.write_text("new"), "b": fail})
        assert everything_below(tmp_path) == {"a"}
        assert (tmp_path / "a").read_text() == "old"
    if isinstance(failure, OSError):
        assert "the disk is full. Nothing was written." in str(caught.value)


def test_a_target_that_cannot_be_replaced_leaves_no_new_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: Path) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "replace", refuse)
    with pytest.raises(CannotWriteError, match="permission denied"):
        write_together(tmp_path / "new" / "folder", {"a": lambda path: path.write_text("new")})
    assert everything_below(tmp_path) == set()


def test_a_folder_that_is_a_file_is_refused_before_the_work(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    (tmp_path / "run.nc").mkdir()
    for folder in ("file", "file/below", "file/below/that"):
        with pytest.raises(InvalidValueError, match=r"`--output` must be a folder; got .*file' is a file"):
            check_folder(tmp_path / folder, ("run.nc",))
    with pytest.raises(InvalidValueError, match=r"'run\.nc' is a folder there"):
        check_folder(tmp_path, ("run.nc",))
    with pytest.raises(InvalidValueError, match="`--output` must be a folder"):
        check_folder(tmp_path / ("x" * 5000), ("run.nc",))
    check_folder(tmp_path / "not" / "there", ("run.nc",))


@pytest.mark.skipif(not hasattr(os, "geteuid"), reason="permissions of another kind")
def test_a_folder_that_may_not_be_written_to(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "access", lambda *_: False)  # the tests may run as root, who may do anything
    with pytest.raises(CannotWriteError, match="may not be written to: name another folder"):
        check_folder(tmp_path, ("run.nc",))


SLOW_WRITER = """
import sys, time
from pathlib import Path
from trundle.cli.writing import write_together

def slowly(path):
    with path.open("wb") as stream:
        for piece in range(1000):
            stream.write(b"y" * 1000)
            stream.flush()
            if piece == 500:
                print("half", flush=True)
                time.sleep(float(sys.argv[2]))

write_together(Path(sys.argv[1]), {"a": lambda path: path.write_bytes(b"y" * 1_000_000), "b": slowly})
"""


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="no SIGKILL here")
def test_killed_while_writing(tmp_path: Path) -> None:
    for name in ("a", "b"):
        (tmp_path / name).write_bytes(BIG)
    words = [sys.executable, "-c", SLOW_WRITER, str(tmp_path), "60"]
    process = subprocess.Popen(words, stdout=subprocess.PIPE)  # noqa: S603
    assert process.stdout is not None
    assert process.stdout.readline() == b"half\n"
    process.kill()
    process.communicate()
    assert [(tmp_path / name).read_bytes() for name in ("a", "b")] == [BIG, BIG]


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="no SIGKILL here")
def test_killed_at_any_moment(tmp_path: Path) -> None:
    """Each file is the whole old one or the whole new one, never a mixture."""
    whole = {BIG, b"y" * 1_000_000}
    for delay in (0.0, 0.0005, 0.001, 0.002, 0.004, 0.008):
        for name in ("a", "b"):
            (tmp_path / name).write_bytes(BIG)
        words = [sys.executable, "-c", SLOW_WRITER, str(tmp_path), "0"]
        process = subprocess.Popen(words, stdout=subprocess.PIPE)  # noqa: S603
        assert process.stdout is not None
        process.stdout.readline()
        time.sleep(delay)
        process.kill()
        process.communicate()
        assert {(tmp_path / name).read_bytes() for name in ("a", "b")} <= whole


LIMITED = """
import resource, sys
resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, 100_000))
from pathlib import Path
from trundle.cli.writing import CannotWriteError, write_together
try:
    write_together(Path(sys.argv[1]) / "new", {"a": lambda path: path.write_bytes(b"y" * 1_000_000)})
except CannotWriteError as error:
    print(error)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="no such limits here")
def test_no_room_for_the_file(tmp_path: Path) -> None:
    done = subprocess.run(  # noqa: S603
        [sys.executable, "-c", LIMITED, str(tmp_path)], capture_output=True, text=True, check=True
    )
    assert done.stdout.startswith("could not write to ")
    assert done.stdout.endswith("a file would be larger than is allowed. Nothing was written.\n")
    assert everything_below(tmp_path) == set()


# --- what a killed process leaves -------------------------------------------------------------------------------


def killed_half_way(folder: Path) -> None:
    words = [sys.executable, "-c", SLOW_WRITER, str(folder), "60"]
    process = subprocess.Popen(words, stdout=subprocess.PIPE)  # noqa: S603
    assert process.stdout is not None
    assert process.stdout.readline() == b"half\n"
    process.kill()
    process.communicate()


def staged(folder: Path) -> list[str]:
    return [path.name for path in folder.iterdir() if path.name.startswith(".trundle")]


@pytest.mark.skipif(sys.platform == "win32", reason="folders cannot be locked here: they go after a day")
def test_the_next_to_write_clears_what_a_killed_one_left(tmp_path: Path) -> None:
    for out in (tmp_path, tmp_path / "new"):
        killed_half_way(out)
        assert len(staged(tmp_path)) == 1
        write_together(out, {"a": lambda path: path.write_text("A")})
        assert staged(tmp_path) == []
    killed_half_way(tmp_path / "newer")  # beside the folder that it would have made
    with written_whole(tmp_path / "one.txt") as temporary:
        temporary.write_text("1")
    assert everything_below(tmp_path) == {"a", "new", "new/a", "one.txt"}


@pytest.mark.skipif(sys.platform == "win32", reason="folders cannot be locked here")
def test_one_that_is_still_writing_is_left_alone(tmp_path: Path) -> None:
    words = [sys.executable, "-c", SLOW_WRITER, str(tmp_path), "2"]
    process = subprocess.Popen(words, stdout=subprocess.PIPE)  # noqa: S603
    assert process.stdout is not None
    assert process.stdout.readline() == b"half\n"
    write_together(tmp_path, {"c": lambda path: path.write_text("C")})
    assert len(staged(tmp_path)) == 1
    process.communicate(timeout=60)
    assert process.returncode == 0
    assert everything_below(tmp_path) == {"a", "b", "c"}


def test_where_no_lock_can_tell_only_what_is_old_is_cleared(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(files, "hold", lambda _: None)
    for name, age in ((".trundle-young", 3600.0), (".trundle-old", 90_000.0), (".trundle+old", 90_000.0)):
        (tmp_path / name).mkdir()
        (tmp_path / name / "run.nc").write_bytes(b"x")
        os.utime(tmp_path / name, (time.time() - age,) * 2)
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / ".trundle-link").symlink_to(tmp_path / "elsewhere")
    (tmp_path / ".trundle-file").write_text("mine")
    write_together(tmp_path, {"a": lambda path: path.write_text("A")})
    assert sorted(staged(tmp_path)) == [".trundle-file", ".trundle-link", ".trundle-young"]
    assert (tmp_path / "elsewhere").is_dir()


def test_many_may_write_to_one_folder_at_once(tmp_path: Path) -> None:
    code = (
        "import sys; from pathlib import Path; from trundle.cli.writing import write_together\n"
        "for i in range(100):\n"
        "    write_together(Path(sys.argv[1]), {sys.argv[2]: lambda path: path.write_bytes(b'z' * 1000)})"
    )
    running = [subprocess.Popen([sys.executable, "-c", code, str(tmp_path), f"f{i}"]) for i in range(4)]  # noqa: S603
    assert [process.wait(timeout=120) for process in running] == [0] * 4
    assert everything_below(tmp_path) == {f"f{i}" for i in range(4)}
