"""Ctrl-C is heard, even where Python loses its exception, and a signal that is ignored stays ignored."""

from __future__ import annotations

import signal

import pytest

from trundle.cli.screen import ProgressBar
from trundle.cli.signals import Ending, check, ending


def test_an_interrupt_that_was_lost_is_raised_at_the_next_step() -> None:
    with ending() as handler:
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
        assert handler.number == signal.SIGINT
        with pytest.raises(KeyboardInterrupt), ProgressBar(wanted=False) as bar:
            bar(0.5)


def test_handlers_are_put_back() -> None:
    before = signal.getsignal(signal.SIGINT)
    with ending():
        assert isinstance(signal.getsignal(signal.SIGINT), Ending)
    assert signal.getsignal(signal.SIGINT) is before
    check()


@pytest.mark.skipif(not hasattr(signal, "SIGHUP"), reason="no SIGHUP here")
def test_what_is_ignored_stays_ignored() -> None:
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)  # as nohup does
    try:
        with ending():
            signal.raise_signal(signal.SIGHUP)
    finally:
        signal.signal(signal.SIGHUP, before)
