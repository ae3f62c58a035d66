"""The cache of compiled integrators saves the compiling, never decides a result, and never gets in the way."""

from __future__ import annotations

import os
import pickle
import stat
import subprocess
import sys
import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.additions import Ball, Tumble
from tests.tolerances import SOLVER

import trundle as tr
from trundle.mechanics.algebra import Vector
from trundle.mechanics.loads import BodyMotion, Load
from trundle.mechanics.parameters import numbers
from trundle.mechanics.shapes import Ellipsoid
from trundle.solve import integrator_cache, integrators, taylor
from trundle.solve.laws import RollingLaw
from trundle.solve.lowering import lower

pytest.importorskip("heyoka")

BALL = tr.Body.solid_sphere(radius=0.025, mass=0.065)
SYSTEM = tr.RollingSystem(BALL, tr.Support(tr.Plane(), motion=tr.Spin(3.5), tilt=0.05))
TIMES = np.linspace(0.0, 1.0, 5)


class Machine:
    """A machine with a cache of its own; `compiled` counts, and `restart` is a new process in this one."""

    def __init__(self, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        self.folder, self.compiled, self.patch = folder, 0, monkeypatch
        compile_ = integrators._compile

        def counted(*arguments: Any) -> Any:
            self.compiled += 1
            return compile_(*arguments)

        monkeypatch.setattr(integrators, "_compile", counted)
        monkeypatch.setattr(integrator_cache, "cache_folder", lambda: folder)
        self.restart()

    def restart(self) -> None:
        memory = integrators._Memory()
        self.patch.setattr(integrators, "_memory", lambda: memory)

    def run(self, system: tr.RollingSystem = SYSTEM) -> Any:
        return taylor.solve(system, system.place((0.1, 0.0), (0.0, 0.2)), TIMES)

    @property
    def file(self) -> Path:
        (path,) = self.folder.glob("taylor-*.pickle")
        return path


@pytest.fixture
def machine(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Machine:
    return Machine(tmp_path / "cache" / "trundle", monkeypatch)


def test_a_second_run_does_not_compile(machine: Machine) -> None:
    first, second = machine.run(), machine.run()
    assert machine.compiled == 1
    assert np.array_equal(first.position, second.position)


def test_a_second_process_does_not_compile(machine: Machine) -> None:
    first = machine.run()
    machine.restart()
    second = machine.run()
    assert machine.compiled == 1
    assert np.array_equal(first.position, second.position)
    assert np.array_equal(first.orientation, second.orientation)


@pytest.mark.parametrize(
    ("patched", "levels"),
    [
        ({"_WORTH_CARE": (1e5, 0.0)}, [integrators.IN_HASTE]),
        ({"_WORTH_CARE": (100.0, 0.0)}, [integrators.IN_HASTE, integrators.WITH_CARE]),
        ({"_WORTH_CARE": (1e5, 0.0), "_FIRST_LOOK": 20}, [integrators.IN_HASTE]),
        ({"_WORTH_UNROLLING": (0.0, 0.0)}, [integrators.IN_HASTE, integrators.UNROLLED]),
        ({"_WORTH_UNROLLING": (0.0, 0.0), "_SHORT_LAW": 100}, [integrators.WITH_CARE, integrators.UNROLLED]),
    ],
)
def test_a_run_has_the_digits_of_what_it_is_worth_compiling_whatever_is_known(
    machine: Machine, patched: dict[str, Any], levels: list[int]
) -> None:
    start, times = SYSTEM.place((0.1, 0.0), (0.0, 0.2)), np.linspace(0.0, 60.0, 121)
    for name, value in ({"_SHORT_LAW": 0} | patched).items():
        machine.patch.setattr(taylor, name, value)

    def path() -> Any:
        return taylor.solve(SYSTEM, start, times).position

    first = path()
    kept = {file.stem.rpartition("-")[2]: file for file in machine.folder.glob("taylor-*.pickle")}
    assert sorted(kept) == sorted(str(level) for level in levels)
    machine.restart()
    assert np.array_equal(path(), first)
    assert np.array_equal(path(), first)
    assert machine.compiled == len(levels)
    for file in kept.values():  # some of what it needs is known, and some is not
        file.unlink()
        machine.restart()
        assert np.array_equal(path(), first)
    wanted = tr.simulate(SYSTEM, start, 60.0, 0.5, method="exact").samples.position
    assert np.abs(first - wanted).max() <= SOLVER(1000, taylor.TOLERANCE, np.abs(wanted).max())


def test_unrolled_code_lies_beside_other_code_of_its_law_and_is_other_code(machine: Machine) -> None:
    start, times = SYSTEM.place((0.1, 0.0), (0.0, 0.2)), np.linspace(0.0, 10.0, 21)
    rolled = taylor.solve(SYSTEM, start, times)
    machine.patch.setattr(taylor, "_WORTH_UNROLLING", (0.0, 0.0))
    unrolled = taylor.solve(SYSTEM, start, times)
    assert not np.array_equal(rolled.orientation, unrolled.orientation)  # or the levels would be one and the same
    assert np.abs(rolled.orientation - unrolled.orientation).max() < 1e-11
    assert len(list(machine.folder.glob("taylor-*.pickle"))) == 2


def test_slip_and_grip_by_turns_count_the_steps_of_both() -> None:
    """Many short stretches of one law are worth what one long stretch is."""
    effort = taylor._Effort(cost=400)
    while effort.level == integrators.IN_HASTE and effort.steps < 20_000:
        effort.after(70, 1e-3)
        effort.look(0.01)  # a few hundred steps to come
    assert 6_875 <= effort.steps < 6_875 + 140  # as many as are worth care at once


def test_no_law_is_unrolled_for_steps_that_patience_would_not_see() -> None:
    """Unrolling takes as long as the square of a law's cost and more: minutes for 1200, as of a disc in a cone."""
    seen, unseen = 0.04, 1e-3  # s: a million steps to come, or fifty million
    for cost, gone, level in (
        (400, seen, integrators.UNROLLED),
        (400, unseen, integrators.WITH_CARE),
        (700, seen, integrators.WITH_CARE),
        (5000, seen, integrators.WITH_CARE),
    ):
        effort = taylor._Effort(cost=cost)
        effort.after(50_000, gone)
        effort.look(1.0)
        assert effort.level == level


def test_a_short_law_is_compiled_with_care_at_once(machine: Machine) -> None:
    machine.run()
    assert machine.file.name.endswith(f"-{integrators.WITH_CARE}.pickle")
    assert machine.compiled == 1


def test_all_numbers_are_parameters(machine: Machine) -> None:
    others = [
        replace(SYSTEM, body=tr.Body.hollow_sphere(0.1, 2.0)),
        replace(SYSTEM, gravity=1.62),
        replace(SYSTEM, support=replace(SYSTEM.support, motion=tr.Spin(-1e-3), tilt=-1e-6, friction=None)),
    ]
    for system in (SYSTEM, *others):
        found, wanted = (
            machine.run(system),
            tr.simulate(system, system.place((0.1, 0.0), (0.0, 0.2)), 1.0, 0.25).samples,
        )
        assert np.abs(found.position - wanted.position).max() <= SOLVER(1000, taylor.TOLERANCE)
    assert machine.compiled == 1


def test_what_is_nothing_is_left_out(machine: Machine) -> None:
    level = replace(SYSTEM, support=replace(SYSTEM.support, tilt=0.0))
    zero = next(i for i, value in enumerate(numbers(level)) if value != numbers(SYSTEM)[i])
    with_it, without_it = (lower(level, RollingLaw(), zeros=zeros) for zeros in ((), (zero,)))
    assert without_it.cost < with_it.cost
    assert np.array_equal(machine.run(level).position, machine.run(level).position)
    machine.run()
    assert machine.compiled == 2


def test_a_push_that_only_adds_to_gravity_is_no_other_structure(machine: Machine) -> None:
    machine.run()
    machine.run(replace(SYSTEM, loads=(tr.Force((0.1, 0.0, 0.0)),)))
    assert machine.compiled == 1


def test_another_structure_is_another_integrator(machine: Machine) -> None:
    machine.run()
    for system in (
        replace(SYSTEM, loads=(tr.Drag(0.01),)),
        replace(SYSTEM, loads=(tr.Force((0.1, 0.05, 0.0)),)),
        replace(SYSTEM, support=tr.Support(tr.Plane(rim=5.0))),
    ):
        found, wanted = (
            machine.run(system),
            tr.simulate(system, system.place((0.1, 0.0), (0.0, 0.2)), 1.0, 0.25).samples,
        )
        assert np.abs(found.position - wanted.position).max() <= SOLVER(1000, taylor.TOLERANCE)
    assert machine.compiled == 4


@dataclass(frozen=True)
class Twist(Load):
    """A torque that differs from a constant one deep inside a long expression only."""

    value: Vector
    place: bool

    def torque(self, motion: BodyMotion) -> Vector:
        return Vector(self.value.x, self.value.y, self.value.z * motion.position.x if self.place else self.value.z)


def test_long_equations_that_differ_at_their_end_are_not_taken_for_one_another() -> None:
    body = tr.Body(0.75, tr.Principal(0.003, 0.004, 0.005), Ellipsoid(0.15, 0.125, 0.1))
    motion = Tumble(1.5, 0.25, -0.75, Vector(0.5, -0.25, 0.125), 2.0)
    support = tr.Support(Ball(0.5, 1.0), motion=motion, tilt=0.2)

    def key(place: bool) -> str:
        system = tr.RollingSystem(body, support, (Twist(Vector(0.1, 0.2, 0.3), place),))
        return integrators._key(*lower(system, RollingLaw()).heyoka(), 1e-15, len(numbers(system)))

    assert key(True) == key(True)
    assert key(True) != key(False)


def test_the_key_depends_on_tolerance_heyoka_and_processor(monkeypatch: pytest.MonkeyPatch) -> None:
    import heyoka

    traced = lower(SYSTEM, RollingLaw()).heyoka()
    keys = {integrators._key(*traced, 1e-15, 7), integrators._key(*traced, 1e-9, 7)}
    monkeypatch.setattr(integrators, "_processor", lambda: "another")
    keys.add(integrators._key(*traced, 1e-15, 7))
    monkeypatch.setattr(heyoka, "__version__", "0.0.0")
    keys.add(integrators._key(*traced, 1e-15, 7))
    assert len(keys) == 4


def test_the_key_is_the_same_in_every_process() -> None:
    code = """
import trundle as tr
from trundle.mechanics.parameters import numbers
from trundle.solve import integrators, taylor
from trundle.solve.laws import RollingLaw
from trundle.solve.lowering import lower
ball = tr.Body.solid_sphere(radius=0.025, mass=0.065)
system = tr.RollingSystem(ball, tr.Support(tr.Plane(), motion=tr.Spin(3.5), tilt=0.05))
print(integrators._key(*lower(system, RollingLaw()).heyoka(), 1e-15, len(numbers(system))))
"""
    found = set()
    for seed in ("1", "2"):
        env = dict(os.environ, PYTHONHASHSEED=seed)
        found.add(subprocess.run([sys.executable, "-c", code], env=env, capture_output=True, check=True).stdout)  # noqa: S603
    assert len(found) == 1
    assert found.pop().decode().strip() == integrators._key(
        *lower(SYSTEM, RollingLaw()).heyoka(), 1e-15, len(numbers(SYSTEM))
    )


@pytest.mark.parametrize("spoil", ["empty", "cut", "bit", "garbage", "other pickle", "folder in its place"])
def test_a_spoilt_file_is_compiled_again(machine: Machine, spoil: str) -> None:
    right = machine.run()
    path = machine.file
    whole = path.read_bytes()
    path.unlink()
    if spoil == "folder in its place":
        path.mkdir()
    else:
        flipped = bytes([whole[-1] ^ 1])
        path.write_bytes(
            {
                "empty": b"",
                "cut": whole[: len(whole) // 2],
                "bit": whole[:-1] + flipped,
                "garbage": b"\x80\x04nonsense",
                "other pickle": pickle.dumps({"not": "an integrator"}),
            }[spoil]
        )
        path.chmod(0o600)
    machine.restart()
    again = machine.run()
    assert machine.compiled == 2
    assert np.array_equal(again.position, right.position)
    if spoil != "folder in its place":
        machine.restart()
        machine.run()
        assert machine.compiled == 2  # and it was mended


class Trap:
    """A pickle that does something when it is read."""

    def __reduce__(self) -> Any:
        return pytest.fail, ("a file that others may write was read",)


@pytest.mark.skipif(os.name != "posix", reason="permissions")
@pytest.mark.parametrize(("of", "mode"), [("file", 0o620), ("file", 0o602), ("folder", 0o770), ("folder", 0o707)])
def test_what_others_may_write_is_not_trusted(machine: Machine, of: str, mode: int) -> None:
    import hashlib

    machine.run()
    body = pickle.dumps(Trap())
    machine.file.write_bytes(hashlib.sha256(body).hexdigest().encode() + b"\n" + body)
    (machine.file if of == "file" else machine.folder).chmod(mode)
    machine.restart()
    machine.run()
    assert machine.compiled == 2


@pytest.mark.skipif(os.name != "posix", reason="owners")
def test_what_belongs_to_another_user_is_not_trusted(machine: Machine, monkeypatch: pytest.MonkeyPatch) -> None:
    machine.run()
    monkeypatch.setattr(os, "getuid", lambda: 12345)
    machine.restart()
    machine.run()
    assert machine.compiled == 2


@pytest.mark.skipif(os.name != "posix", reason="permissions")
@pytest.mark.parametrize("umask", [0o022, 0o002, 0o000])
def test_it_works_whatever_the_umask(machine: Machine, umask: int) -> None:
    before = os.umask(umask)
    try:
        machine.run()
        machine.restart()
        machine.run()
    finally:
        os.umask(before)
    assert machine.compiled == 1
    assert stat.S_IMODE(machine.file.stat().st_mode) == 0o600
    assert stat.S_IMODE(machine.folder.stat().st_mode) == 0o700


def test_without_a_folder_it_works(machine: Machine, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way")
    machine.folder = tmp_path / "file" / "trundle"  # cannot be made, not even by root
    machine.patch.setattr(integrator_cache, "cache_folder", lambda: machine.folder)
    assert machine.run().position.shape == (5, 3)
    assert machine.compiled == 1


def test_a_full_disk_does_not_get_in_the_way(machine: Machine) -> None:
    def full(path: Path, data: bytes) -> int:  # noqa: ARG001
        path.touch()
        raise OSError(28, "No space left on device")

    machine.patch.setattr(Path, "write_bytes", full)
    assert machine.run().position.shape == (5, 3)
    assert list(machine.folder.iterdir()) == []


def test_runs_do_not_see_each_other(machine: Machine) -> None:
    # Between its chunks a run tells its progress, and here another run of the same structure begins and ends there.
    other = replace(SYSTEM, support=replace(SYSTEM.support, tilt=-0.2))
    times, start = np.linspace(0.0, 2.0, 400), SYSTEM.place((0.1, 0.0), (0.0, 0.2))
    quiet = taylor.solve(SYSTEM, start, times)
    disturbed = taylor.solve(SYSTEM, start, times, progress=lambda _: machine.run(other))
    assert machine.compiled == 1
    assert np.array_equal(quiet.position, disturbed.position)


def test_an_end_at_the_rim_leaves_nothing_behind(machine: Machine) -> None:
    short = tr.RollingSystem(BALL, tr.Support(tr.Plane(rim=0.12), motion=tr.Spin(3.5)))
    wide = replace(short, support=replace(short.support, surface=tr.Plane(rim=5.0)))
    first, between, again = (machine.run(system) for system in (short, wide, short))
    assert machine.compiled == 1
    assert first.events == again.events != () == between.events
    assert np.array_equal(first.position, again.position)


def test_the_cache_is_the_users(tmp_path: Path) -> None:
    code = """
import trundle as tr
from trundle.solve import integrators, taylor
compile_, count = integrators._compile, []
integrators._compile = lambda *arguments: (count.append(1), compile_(*arguments))[1]
table = tr.RollingSystem(tr.Body.solid_sphere(0.025, 0.065), tr.Support(tr.Plane()))
tr.simulate(table, table.place(), duration=1.0, every=0.5, method="taylor")
print(len(count))
"""
    env = dict(os.environ, XDG_CACHE_HOME=str(tmp_path), HOME=str(tmp_path))
    counts = [
        subprocess.run([sys.executable, "-c", code], env=env, capture_output=True, text=True, check=True).stdout  # noqa: S603
        for _ in range(2)
    ]
    assert counts == ["1\n", "0\n"]


@dataclass(frozen=True)
class Moody(Load):
    """A load that holds what cannot be hashed."""

    values: Any

    def force(self, motion: BodyMotion) -> Vector:  # noqa: ARG002
        return Vector(self.values[0], 0.0, 0.0)


def test_a_part_that_may_change_is_looked_at_each_time(machine: Machine) -> None:
    push = [0.0]
    system = replace(SYSTEM, loads=(Moody(push),))
    still = machine.run(system)
    push[0] = 0.5
    assert np.abs(machine.run(system).position - still.position).max() > 1e-3
    assert np.array_equal(still.position, machine.run(replace(SYSTEM, loads=(Moody((0.0,)),))).position)


# --- it does not grow without end -------------------------------------------------------------------------------


def kept(folder: Path) -> set[str]:
    return {path.stem.removeprefix("taylor-") for path in folder.glob("taylor-*.pickle")}


def filled(folder: Path, sizes: dict[str, int], ages: dict[str, float] | None = None) -> None:
    """Put files into a cache, the first used longest ago, each of so many bytes; ages in days."""
    folder.mkdir(mode=0o700, parents=True)
    now = time.time()
    for i, (name, size) in enumerate(sizes.items()):
        path = folder / f"taylor-{name}.pickle"
        path.write_bytes(b"x" * size)
        used = now - (ages or {}).get(name, 0.0) * 86_400 - 10 * (len(sizes) - i)
        os.utime(path, (used, used))


def test_the_least_recently_used_go_where_there_is_too_much(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(integrator_cache, "MOST_BYTES", 1000)
    folder = tmp_path / "cache"
    filled(folder, {"a": 300, "b": 300, "c": 300, "d": 100})
    (folder / "notes.txt").write_text("mine")
    integrator_cache.prune(folder)
    assert kept(folder) == {"a", "b", "c", "d"}  # 1000 is allowed
    (folder / "taylor-e.pickle").write_bytes(b"x")
    integrator_cache.prune(folder)
    assert kept(folder) == {"b", "c", "d", "e"}  # 701, and no more than 800
    assert (folder / "notes.txt").exists()


def test_what_was_not_used_for_long_goes(tmp_path: Path) -> None:
    folder = tmp_path / "cache"
    filled(folder, {"old": 10, "older": 10, "new": 10}, {"old": 91.0, "older": 200.0, "new": 89.0})
    integrator_cache.prune(folder)
    assert kept(folder) == {"new"}


def test_one_that_is_larger_than_the_whole_cache_stays_until_another_comes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(integrator_cache, "MOST_BYTES", 5)
    filled(tmp_path / "cache", {"a": 100, "b": 100})
    integrator_cache.prune(tmp_path / "cache")
    assert kept(tmp_path / "cache") == {"b"}


def test_what_is_used_stays(machine: Machine) -> None:
    machine.run()
    first = machine.file
    machine.patch.setattr(integrator_cache, "MOST_BYTES", int(2.9 * first.stat().st_size))
    others = [replace(SYSTEM, loads=(tr.Drag(0.01),)), replace(SYSTEM, loads=(tr.Force((0.1, 0.05, 0.0)),))]
    for other in others:
        for path in machine.folder.iterdir():  # as if an hour had passed
            os.utime(path, (path.stat().st_mtime - 3600,) * 2)
        machine.restart()
        machine.run()  # of the first, from the cache: it is the one used last before the other is added
        machine.restart()
        machine.run(other)
        assert first.exists()
    assert machine.compiled == 3
    assert sum(path.stat().st_size for path in machine.folder.iterdir()) <= 2.9 * first.stat().st_size


def test_many_processes_may_tidy_at_once(tmp_path: Path) -> None:
    folder = tmp_path / "cache"
    filled(folder, {f"k{i}": 1000 for i in range(400)})
    code = (
        "import sys; from pathlib import Path; from trundle.solve import integrator_cache as c\n"
        "c.MOST_BYTES = 100_000\nc.prune(Path(sys.argv[1]))"
    )
    running = [subprocess.Popen([sys.executable, "-c", code, str(folder)]) for _ in range(4)]  # noqa: S603
    assert [process.wait(timeout=120) for process in running] == [0] * 4
    assert len(kept(folder)) <= 100
    assert "k399" in kept(folder)


def test_a_cache_that_cannot_be_tidied_is_no_reason_to_fail(machine: Machine) -> None:
    def refuse(*_: Any, **__: Any) -> None:
        raise PermissionError(13, "Permission denied")

    machine.patch.setattr(integrator_cache, "MOST_BYTES", 1)
    machine.run()
    machine.patch.setattr(Path, "unlink", refuse)
    machine.patch.setattr(os, "utime", refuse)
    machine.restart()
    assert machine.run(replace(SYSTEM, loads=(tr.Drag(0.01),))).position.shape == (5, 3)


def test_heyoka_does_not_keep_the_same_once_more(machine: Machine, tmp_path: Path) -> None:
    heyoka = pytest.importorskip("heyoka")
    state = heyoka.llvm_state
    if not hasattr(state, "set_diskcache_path"):
        pytest.skip("this heyoka keeps nothing on disk")
    before, theirs = (state.get_diskcache_path(), state.get_diskcache_enabled()), tmp_path / "heyoka"
    state.set_diskcache_path(theirs)
    state.set_diskcache_enabled(True)
    state.clear_memcache()
    try:
        machine.run()
        machine.restart()
        machine.run()
        assert machine.compiled
        assert not [path for path in theirs.rglob("*") if path.is_file()]
        assert state.get_diskcache_enabled()  # for others
        x = heyoka.make_vars("x")
        heyoka.taylor_adaptive([(x, 0.123 - heyoka.sin(x))], [0.0])
        assert [path for path in theirs.rglob("*") if path.is_file()]
    finally:
        state.set_diskcache_path(before[0])
        state.set_diskcache_enabled(before[1])
