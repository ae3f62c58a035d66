"""Ctrl-C is heard, even where Python loses its exception, and a signal that is ignored stays ignored."""

from __future__ import annotations

import contextlib
import signal
import subprocess
import sys
import time
import tomllib
from pathlib import Path

import pytest

from trundle.cli.screen import ProgressBar
from trundle.cli.signals import Ending, check, ending, heard
from trundle.cli.writing import write_together


def test_an_interrupt_that_was_lost_is_raised_at_the_next_step() -> None:
    def lose_it() -> None:
        with ending() as handler:
            with contextlib.suppress(KeyboardInterrupt):
                signal.raise_signal(signal.SIGINT)
            assert handler.number == signal.SIGINT
            with ProgressBar(wanted=False) as bar:
                bar(0.5)
            raise AssertionError

    with pytest.raises(KeyboardInterrupt):
        lose_it()


@pytest.mark.parametrize(("number", "raised"), [(signal.SIGINT, KeyboardInterrupt), (signal.SIGTERM, SystemExit)])
def test_an_interrupt_that_became_another_exception_is_still_one(number: int, raised: type[BaseException]) -> None:
    def compiled() -> None:
        """Lose the exception as compiled code does that asks Python for an attribute and finds none."""
        with contextlib.suppress(KeyboardInterrupt, SystemExit):
            signal.raise_signal(number)
        raise TypeError("missing 1 required positional argument")

    with pytest.raises(raised), ending():
        compiled()


@pytest.mark.parametrize(("number", "raised"), [(signal.SIGINT, KeyboardInterrupt), (signal.SIGTERM, SystemExit)])
def test_an_interrupt_that_is_lost_in_a_callback_comes_again_without_a_word(
    number: int, raised: type[BaseException], capsys: pytest.CaptureFixture[str]
) -> None:
    class Dying:
        def __del__(self) -> None:
            signal.raise_signal(number)

    def lose_it() -> None:
        [Dying()].clear()  # Python loses what is raised there
        until = time.monotonic() + 20
        while time.monotonic() < until:
            time.sleep(0.01)

    with pytest.raises(raised), ending():
        lose_it()
    assert "ignored" not in capsys.readouterr().err


def test_what_else_is_lost_in_a_callback_is_told_as_before(monkeypatch: pytest.MonkeyPatch) -> None:
    class Dying:
        def __del__(self) -> None:
            raise ValueError("a mistake")

    told = []
    monkeypatch.setattr("sys.unraisablehook", told.append)
    with ending():
        [Dying()].clear()
    assert [one.exc_type for one in told] == [ValueError]


def test_an_exception_without_a_signal_stays_what_it_is() -> None:
    with pytest.raises(TypeError), ending():
        raise TypeError


def test_handlers_are_put_back() -> None:
    before = signal.getsignal(signal.SIGINT)
    with ending():
        assert isinstance(signal.getsignal(signal.SIGINT), Ending)
    assert signal.getsignal(signal.SIGINT) is before
    check()


def test_whether_files_are_there_is_known_at_the_end(tmp_path: Path) -> None:
    with pytest.raises(KeyboardInterrupt), ending() as handler:
        write_together(tmp_path, {"a.txt": lambda _: signal.raise_signal(signal.SIGINT)})
    assert not handler.written
    with ending() as handler:
        write_together(tmp_path, {"a.txt": lambda path: path.write_text("whole")})
    assert handler.written
    assert [path.name for path in tmp_path.iterdir()] == ["a.txt"]


def test_an_interrupt_that_is_swallowed_comes_again() -> None:
    """A library may clear the exception, once or many times, and go on."""
    swallowed = 0

    def swallow() -> None:
        nonlocal swallowed
        until = time.monotonic() + 20
        with ending():
            while time.monotonic() < until and swallowed < 3:
                with contextlib.suppress(KeyboardInterrupt):
                    if not swallowed:
                        signal.raise_signal(signal.SIGINT)
                    while time.monotonic() < until:
                        time.sleep(0.01)
                swallowed += 1

    with pytest.raises(KeyboardInterrupt):
        swallow()
    assert swallowed == 3


def test_an_interrupt_that_is_swallowed_at_the_end_is_not_forgotten() -> None:
    with pytest.raises(KeyboardInterrupt), ending(), contextlib.suppress(KeyboardInterrupt):
        signal.raise_signal(signal.SIGINT)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_what_is_cleared_up_on_the_way_out_is_left_alone(number: int) -> None:
    cleared = []

    def clear() -> None:
        time.sleep(0.7)
        cleared.append("all")

    def leave() -> None:
        with ending(), contextlib.ExitStack() as stack:
            stack.callback(clear)
            try:
                signal.raise_signal(number)
            finally:
                clear()

    with pytest.raises((KeyboardInterrupt, SystemExit)):
        leave()
    assert cleared == ["all", "all"]


def test_a_signal_that_was_heard_comes_no_more() -> None:
    with ending() as handler:
        with contextlib.suppress(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
        heard()
        time.sleep(0.7)
    assert handler.number == signal.SIGINT


@pytest.mark.skipif(not hasattr(signal, "SIGHUP"), reason="no SIGHUP here")
def test_what_is_ignored_stays_ignored() -> None:
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)  # as nohup does
    try:
        with ending():
            signal.raise_signal(signal.SIGHUP)
    finally:
        signal.signal(signal.SIGHUP, before)


def test_an_interrupt_while_the_package_is_imported_is_said_in_a_word() -> None:
    """As the console script calls it, with a Ctrl-C at the first import of the package's own."""
    script = """
import signal, sys
class Interrupting:
    def find_spec(self, name, *more):
        if name == "trundle":
            signal.raise_signal(signal.SIGINT)
sys.meta_path.insert(0, Interrupting())
sys.exit(importlib.import_module("trundle_command").main())
"""
    entry = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text("utf-8"))["project"]["scripts"]
    assert entry == {"trundle": "trundle_command:main"}
    found = subprocess.run(  # noqa: S603
        [sys.executable, "-c", f"import importlib{script}"], capture_output=True, text=True, timeout=60, check=False
    )
    assert (found.returncode, found.stderr) == (130, "trundle: interrupted\n")


def test_an_interrupt_on_the_way_out_is_heard_by_nobody() -> None:
    """Python waits for threads first: a Ctrl-C there is "Exception ignored", unless none is heard any more."""
    script = """
import signal, sys, threading
threading._register_atexit(lambda: signal.raise_signal(signal.SIGINT))
sys.argv = ["trundle", "list"]
import trundle_command
trundle_command.main()
"""
    found = subprocess.run(  # noqa: S603
        [sys.executable, "-c", script], capture_output=True, text=True, timeout=60, check=False
    )
    assert (found.returncode, found.stderr) == (0, "")
