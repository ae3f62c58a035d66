"""One scenario in a process of its own, as a user runs it, for so much of a processor's time and no more."""

from __future__ import annotations

import faulthandler
import json
import os
import re
import signal
import sys
import tempfile
import time
import traceback
import warnings
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass, field
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import Any

LIMIT = 6.0  # CPU seconds for a scenario and its card
_HEARD_OUT = 6.0  # times as long before it is killed: what comes late may be wrong, too
_PATIENT = 10.0  # times as long by the clock, where the machine is shared
_CANDIDATES = 60  # scenarios that may be refused before one runs
_MEMORY = 8 << 30  # bytes
PASSED, FAILED, GAVE_UP, REFUSED = "passed", "card failed", "gave up in words", "refused"
HANG, TRACEBACK, CRASH = "hang", "traceback", "crash"
_OWN_WORDS = "trundle: "  # with which a command says that a check or a fit fails, or that data cannot decide
OUTCOMES = (PASSED, FAILED, GAVE_UP, HANG, TRACEBACK, CRASH, REFUSED)
BAD = (FAILED, HANG, TRACEBACK, CRASH)


@dataclass
class Outcome:
    """What came of a seed of a class.

    Parameters
    ----------
    name : str
        The class.
    seed : int
        Of its generator.
    outcome : str
        One of `OUTCOMES`.
    cause : str
        Where or in which figures, in short: outcomes of one cause have the same.
    detail : str
        What was said.
    warned : str
        What came on stderr besides.
    refusals : dict
        How often which error refused a candidate before one ran.
    seconds : float
        Of a processor.
    text : str
        The scenario, TOML.
    """

    name: str
    seed: int
    outcome: str
    cause: str = ""
    detail: str = ""
    warned: str = ""
    refusals: dict[str, int] = field(default_factory=dict)
    seconds: float = 0.0
    text: str = ""


def try_out(
    name: str, seed: int, say: Callable[..., None], limit: float = LIMIT, commands: tuple[str, ...] = ()
) -> None:
    """Draw scenarios of a class until one runs, and say what comes of it.

    Parameters
    ----------
    name, seed : str, int
        Of the class, and of its generator.
    say : callable
        Takes what is known so far as keywords: whoever kills this process knows it then.
    limit : float
        CPU seconds for a scenario and its card: what takes longer has hung, for whoever waits.
    commands : tuple of str
        The other commands, of which one is tried on it, too.
    """
    import tomli_w

    from trundle.errors import TrundleError

    from .classes import candidate, mended
    from .drawing import seeded

    random, refusals = seeded(name, seed), dict[str, int]()
    command = seeded("command", seed).choice(commands) if commands else ""
    tables = candidate(name, random)
    for _ in range(_CANDIDATES):
        text = tomli_w.dumps({"title": f"{name} {seed}", **{key: tables[key] for key in tables if key != "title"}})
        say(text=text, begins=True)
        try:
            run_as_a_user_does(text, say, limit, command)
        except TrundleError as error:
            kind = type(error).__name__
            refusals[kind] = refusals.get(kind, 0) + 1
            say(refusals=refusals, outcome=REFUSED, cause=kind, detail=str(error))
            tables = mended(name, tables, getattr(error, "key", ""), random)
            continue
        return


def run_as_a_user_does(text: str, say: Callable[..., None], limit: float = LIMIT, command: str = "") -> None:
    """Run a scenario and make its card, and try a command on it; an error by which it is refused is the caller's."""
    import trundle as tr

    begun = time.process_time()
    scenario = tr.Scenario.loads(text)
    try:
        run = scenario.run()
        ran = time.process_time()
        card = run.card()
    except tr.InvalidValueError:  # of the start, which only the run looks at
        raise
    except tr.TrundleError as error:
        outcome, late = (GAVE_UP, "") if time.process_time() - begun <= limit else (HANG, "late: ")
        say(outcome=outcome, cause=f"{late}{type(error).__name__}: {_general(str(error))}", detail=str(error))
        return
    phases = "".join(dict.fromkeys("rsfp"[phase] for phase in run.data.phase.values))
    happened = f"phases {phases}; {', '.join(f'{one.kind} {one.time:.4g}' for one in run.events[:6]) or 'no events'}"
    if not card.passed:
        failures = [" ".join(str(figure).split()) for figure in card.failures]
        cause = f"{run.method}: {', '.join(_general(figure.name) for figure in card.failures)}"
        say(outcome=FAILED, cause=cause, detail=f"{'; '.join(failures)} ({happened})")
        return
    took = [ran - begun, time.process_time() - ran]
    if sum(took) <= limit:
        say(outcome=PASSED)
        if command:
            _try_command(command, text, run, say)
        return
    said = f"run {took[0]:.1f} s, card {took[1]:.1f} s, {len(run.events)} events ({happened})"
    say(outcome=HANG, cause=f"{run.method}: passed, but late", detail=said)


def _try_command(command: str, text: str, run: Any, say: Callable[..., None]) -> None:
    """Try a command on what has passed; it may refuse it."""
    import trundle as tr

    from .commands import is_wrong, status_of

    say(begins=True, text=f"# trundle {command}\n{text}")
    try:
        status = status_of(command, text, run)
    except tr.TrundleError:
        return
    if is_wrong(command, status, run):
        say(outcome=FAILED, cause=f"trundle {command}", detail=f"status {status}")


def _general(text: str) -> str:
    """Return a message without its numbers."""
    return re.sub(r"[-+]?\d[\d.,]*(e[-+]?\d+)?", "#", text.partition("\n")[0])[:110]


# --- in a process of its own ------------------------------------------------------------------------------


class Child:
    """A copy of this process that does some work and says what comes of it in a file.

    Parameters
    ----------
    work : callable
        Takes `say`.
    folder : Path
        For its files.
    limit : float
        CPU seconds from each `begins=True` on.
    """

    def __init__(self, work: Callable[[Callable[..., None]], None], folder: Path, limit: float) -> None:
        self.folder, self.limit, self.began = folder, limit, time.monotonic()
        folder.mkdir(parents=True, exist_ok=True)
        for old in folder.iterdir():
            old.unlink()
        sys.stdout.flush()
        sys.stderr.flush()
        self.process = os.fork()
        if not self.process:
            self._work(work)

    def _work(self, work: Callable[[Callable[..., None]], None]) -> None:
        """Do it, in the copy, which ends here."""
        try:
            self._bound()
            work(self._say)
        except BaseException as error:  # noqa: BLE001  this is what is looked for
            self._say(outcome=TRACEBACK, cause=_place(error), detail=traceback.format_exc(limit=-12))
        finally:
            sys.stderr.flush()
            os._exit(0)

    def _bound(self) -> None:
        """Send what is printed to files, and die of too much time or memory."""
        import resource

        errors = os.open(self.folder / "stderr", os.O_WRONLY | os.O_CREAT, 0o600)
        os.dup2(errors, 2)
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        tempfile.tempdir = str(self.folder.parent)  # so that nothing is left behind by what is killed
        stack = (self.folder / "stack").open("w")
        signal.signal(signal.SIGPROF, signal.SIG_DFL)
        faulthandler.register(signal.SIGPROF, file=stack, all_threads=False, chain=True)
        resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, _MEMORY))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        warnings.simplefilter("default")
        warnings.filterwarnings("ignore", category=DeprecationWarning)
        signal.setitimer(signal.ITIMER_PROF, self.limit)
        self._known: dict[str, Any] = {}

    def _say(self, *, begins: bool = False, **known: Any) -> None:
        """Keep what is known, so that it outlives this process."""
        if begins:
            signal.setitimer(signal.ITIMER_PROF, self.limit)
        self._known |= known
        whole = self.folder / "known.new"
        whole.write_text(json.dumps(self._known), encoding="utf-8")
        whole.replace(self.folder / "known")

    def ended(self, status: int, seconds: float) -> dict[str, Any]:
        """Return what is known of a copy that has ended."""
        path = self.folder / "known"
        known = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
        lines = (self.folder / "stderr").read_text(encoding="utf-8", errors="replace").splitlines()
        printed = "\n".join(line for line in lines if line.strip() and not line.startswith(_OWN_WORDS))
        known |= {"seconds": seconds, "warned": _general(next(iter(printed.splitlines()), ""))}
        if os.WIFSIGNALED(status):
            number = os.WTERMSIG(status)
            stack = (self.folder / "stack").read_text(encoding="utf-8", errors="replace")
            kind = HANG if number in (signal.SIGPROF, signal.SIGALRM) else CRASH
            where = f"{_stage(stack)}{_innermost(stack)}" if stack else signal.Signals(number).name
            known |= {"outcome": kind, "cause": where, "detail": stack or printed}
        return known

    def check(self) -> None:
        """End a copy that sleeps."""
        if time.monotonic() - self.began > self.limit * _PATIENT:
            os.kill(self.process, signal.SIGALRM)


def _place(error: BaseException) -> str:
    """Return which error came from where: the innermost function of trundle's."""
    frames = [frame for frame in traceback.extract_tb(error.__traceback__) if frame.filename.startswith(_PACKAGE)]
    where = f"{_short(frames[-1].filename)}:{frames[-1].name}" if frames else "outside"
    return f"{type(error).__name__} in {where}: {_general(str(error))}"


# Not any folder of that name: a clone may be called so.
_PACKAGE = f"{Path(find_spec('trundle').origin).parent}{os.sep}"  # type: ignore[union-attr, arg-type]
_FRAME = re.compile(rf'File "({re.escape(_PACKAGE)}[^"]*)", line \d+ in (\S+)')


def _innermost(stack: str) -> str:
    """Return the two innermost functions of trundle's in a stack that decide how much is to be done."""
    found = [f"{_short(file)}:{name}" for file, name in _FRAME.findall(stack)]
    deciding = [one for one in found if not one.startswith("mechanics/")]  # which is asked again and again
    return " < ".join(dict.fromkeys((deciding or found)[:2]))


def _stage(stack: str) -> str:
    """Return what a user would say that trundle was doing."""
    names = [name for _, name in _FRAME.findall(stack)]
    return "card, " if "card" in names or "_checked" in names else "reading, " if "loads" in names else "run, "


def _short(file: str) -> str:
    return file.removeprefix(_PACKAGE)


# --- many of them -----------------------------------------------------------------------------------------


def _warm_up() -> None:
    """Import what runs and cards need, once for all copies: but compile nothing, for LLVM keeps threads."""
    import trundle as tr
    import trundle.solve.taylor

    trundle.solve.taylor.available()
    tr.Scenario.load("tilted-turntable").run(duration=0.1, every=0.02)
    tr.Scenario.load("rocking-hemisphere").run("runge-kutta", duration=0.1, every=0.02).card()
    compiling = os.fork()  # the loop that numba keeps: a user waits for it once, and no scenario is killed for it
    if not compiling:
        try:
            from trundle.solve.compiled_loop import advance

            advance()
        finally:
            os._exit(0)
    os.waitpid(compiling, 0)


def outcomes(
    cases: Iterator[tuple[str, int]], folder: Path, workers: int, limit: float = LIMIT, commands: tuple[str, ...] = ()
) -> Iterator[Outcome]:
    """Try out seeds of classes, some at a time, and by itself again what was late beside others.

    Processes that share a processor's caches take more of its time: only alone is it the program's.

    Parameters
    ----------
    cases : iterator of (str, int)
        Classes and seeds.
    folder : Path
        For what the processes leave behind.
    workers : int
        How many at a time.
    limit : float
        CPU seconds for a scenario.
    commands : tuple of str
        The other commands, of which one is tried on each, too.

    Yields
    ------
    Outcome
        In the order in which they end, those that were late last.
    """
    _warm_up()
    late: list[tuple[str, int]] = []
    for one in _side_by_side(cases, folder, workers, limit, commands):
        if one.outcome == HANG and workers > 1:
            late.append((one.name, one.seed))
        else:
            yield one
    yield from _side_by_side(iter(late), folder, 1, limit, commands)


def _side_by_side(
    cases: Iterator[tuple[str, int]], folder: Path, workers: int, limit: float, commands: tuple[str, ...]
) -> Iterator[Outcome]:
    """Try out seeds of classes, so many at a time."""
    running: dict[int, tuple[str, int, Child, int]] = {}
    free = list(range(workers))
    waiting = iter(cases)
    while True:
        while free:
            case = next(waiting, None)
            if case is None:
                break
            slot = free.pop()
            work = partial(try_out, *case, limit=limit, commands=commands)
            child = Child(work, folder / f"worker-{slot}", _HEARD_OUT * limit)
            running[child.process] = (*case, child, slot)
        if not running:
            return
        for process in list(running):
            ended, status, usage = os.wait4(process, os.WNOHANG)
            if ended:
                name, seed, child, slot = running.pop(process)
                free.append(slot)
                known = child.ended(status, usage.ru_utime + usage.ru_stime)
                yield Outcome(**{**asdict(Outcome(name, seed, CRASH)), **known})
            else:
                running[process][2].check()
        time.sleep(0.02)
