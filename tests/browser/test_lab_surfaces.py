"""By hand on a curved support: the pointer meets the surface, and the start says the place in its coordinates."""

from __future__ import annotations

import tomllib

import numpy as np
import pytest
from playwright.sync_api import expect

import trundle as tr
from trundle.scenario import files

from .bench import Bench, eventually, linked
from .visiting import Visitor


@pytest.fixture
def bench(visitor: Visitor) -> Bench:
    """A turning bowl, seen from above: right on the screen is the first axis, up is the second."""
    shown = Bench(visitor.open("#/bench?name=ball-in-a-turning-bowl"))
    shown.page.get_by_role("button", name="Path", exact=True).click()  # it has the ball's colour
    shown.stage.canvas.focus()
    shown.page.keyboard.press("Home")
    shown.page.keyboard.press("t")
    shown.page.wait_for_timeout(200)
    return shown


def test_a_ball_in_a_bowl_is_dragged_up_its_side_and_nudged_while_it_runs(bench: Bench) -> None:
    bench.tool("Move it")
    x, y = bench.stage.ball()
    bench.stage.drag((-60.0, -50.0))

    def moved() -> None:
        start = tr.Scenario.read(bench.scenario()).start_state()
        assert start.position[0] < 0.12, "left on the screen is down the first axis"
        assert start.position[1] > 0.02, "up on the screen is along the second axis"
        assert bench.stage.drawn().place == pytest.approx(start.position, abs=1e-4), "it lies on the bowl"
        assert bench.stage.ball() == pytest.approx((x - 60, y - 50), abs=6), "it lies where it was let go"

    eventually(bench.page, moved)
    # A hand that moves is followed with fewer samples; at rest all of them are asked for.
    bench.page.wait_for_timeout(1000)
    bench.settle()
    before = bench.run()
    then = before.data.sel(time=bench.play_past(0.4).time, method="nearest")
    bench.tool("Nudge it")
    bench.stage.drag((100.0, 0.0))  # long: where the ball is grasped is a few pixels off its middle

    def nudged() -> None:
        start = tr.Scenario.read(bench.scenario()).start_state()
        assert start.position == pytest.approx(then.position.values, abs=1e-6), "it goes on from where it was"
        normal = (then.position.values - then.contact.values) / 0.01
        spins = [float(np.dot(turning, normal)) for turning in (start.angular_velocity, then.angular_velocity.values)]
        # The page takes the normal from two places in single precision, a ball's radius apart.
        rounding = 4 * 2.0**-24 * np.linalg.norm(then.position) / 0.01 * np.linalg.norm(then.angular_velocity)
        assert spins[0] == pytest.approx(spins[1], abs=float(rounding)), "with the spin that it had"
        added = np.array(start.velocity) - then.velocity.values
        assert added[0] > 0.01, "right on the screen is along the first axis"
        assert abs(added[1]) < 0.1 * added[0]
        assert added @ normal == pytest.approx(0.0, abs=1e-4), "along the bowl"

    eventually(bench.page, nudged)


@pytest.mark.parametrize("path", ["body.kind", "support.kind", "support.motion.kind"])
def test_every_kind_on_offer_can_be_chosen_and_is_computed(path: str, visitor: Visitor) -> None:
    tables = tomllib.loads(files.read("level-turntable-nudged"))
    if path != "support.motion.kind":
        del tables["support"]["motion"]  # on which a cylinder cannot roll
    bench = Bench(visitor.open(linked(tables), drawn=False))
    choice = bench.control(path).get_by_role("combobox")
    choice.wait_for()
    kinds = choice.locator("option").evaluate_all("options => options.map(({ value }) => value)")
    assert len(kinds) > 9
    way, stale = path.split("."), bench.page.get_by_text("The last path that could be computed")
    for kind in [*kinds[1:], kinds[0]]:
        choice.select_option(kind)

        def is_there(kind: str = kind) -> None:
            found = bench.scenario()
            for key in way[:-1]:
                found = found.get(key, {"kind": "fixed"})
            assert found["kind"] == kind, "the address did not follow"

        eventually(bench.page, is_there)
        bench.settle()
        expect(stale).to_be_hidden()
        tr.Scenario.read(bench.scenario())
