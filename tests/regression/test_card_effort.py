"""What a card may cost: changed copies of a run, and a finer run beside it, take no more than the run itself."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

import trundle as tr
from trundle.solve.dense import Dense
from trundle.verify import compared
from trundle.verify.card import CardFigure

STIFF = """
title = "a torus that strikes a bowl and slips on, of which a rounding grows tens of thousandfold"
body = { kind = "torus", radius = 0.106152, rim_radius = 0.0132182, density = 4516.25 }
start = { position = [0.00510402, 0.121349], velocity = [-0.0491993, 0.0, 1.92317], spin = 6.72678 }
run = { duration = 2.0, every = 0.0801024 }
[support]
kind = "bowl"
radius = 0.128749
friction = 0.0815483
tangential_restitution = 0.0494545
motion = { kind = "wobble", rate = -0.210741, angle = -0.0136754 }
"""
BALL = tr.Body.solid_sphere(radius=0.02, mass=0.1)


@pytest.fixture
def copied(monkeypatch: pytest.MonkeyPatch) -> Callable[[], tuple[float, float]]:
    """Return what tells the work of all changed copies, and of the run beside which they were followed."""
    windows: list[tuple[Dense, float, float]] = []
    like_it = Dense.like_it

    def followed(self: Dense, start: tr.State, times: np.ndarray) -> object:
        windows.append((self, start.time, float(times[-1])))
        return like_it(self, start, times)

    monkeypatch.setattr(Dense, "like_it", followed)

    def work() -> tuple[float, float]:
        taken = [np.diff(kept.work_until(np.array([begin, end])))[0] for kept, begin, end in windows]
        return sum(taken), max((kept.work for kept, *_ in windows), default=0.0)

    return work


@pytest.mark.parametrize("most", [1e6, 1e8, 1e12])
def test_all_changed_copies_take_no_more_than_the_run_or_what_is_allowed(
    most: float, copied: Callable[[], tuple[float, float]], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(compared, "_WORK_FOLLOWED", most)
    monkeypatch.setattr(compared, "bound_of", lambda *_: 1e-13)  # so that a difference is found, and followed
    card = tr.Scenario.loads(STIFF).run().card()
    of_copies, of_the_run = copied()
    assert card.passed, card.failures
    assert of_copies <= 1.01 * max(most, of_the_run)
    assert (of_copies > 2 * of_the_run) == (most > 1e11), (of_copies, of_the_run)  # all of it, only where allowed


def test_changed_copies_of_an_exact_run_are_bounded_too(
    copied: Callable[[], tuple[float, float]], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(compared, "EXACT", 0.0)
    monkeypatch.setattr(compared, "_WORK_FOLLOWED", 1e5)
    monkeypatch.setattr(compared, "bound_of", lambda *_: 1e-18)  # so that a difference is found, and followed
    system = tr.RollingSystem(BALL, tr.Support(tr.Plane(), tilt=0.01, motion=tr.Spin(3.0)))
    run = tr.simulate(system, system.place((0.1, 0.0)), 50.0, 0.5)
    assert run.method == "exact"
    run.card()
    of_copies, of_the_run = copied()
    assert 0 < of_copies <= 1.01 * max(1e5, of_the_run)


def test_a_finer_run_is_followed_as_far_as_it_is_affordable_and_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    def figures() -> dict[str, CardFigure]:
        run = tr.Scenario.load("rocking-hemisphere").run("runge-kutta")
        return {figure.name: figure for figure in run.card().figures}

    whole = figures()["accuracy reached"]
    monkeypatch.setattr(compared, "_WORK_FINER", 1e8)
    some = figures()["accuracy reached"]
    assert " up to " in some.note
    assert " up to " not in whole.note
    assert some.passed
    assert whole.passed
    monkeypatch.setattr(compared, "_WORK_FINER", 0.0)
    assert "accuracy reached" not in figures()  # one instant says nothing
