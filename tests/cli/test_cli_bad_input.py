"""Bad input: one message that names key, value and remedy; exit status 2; nothing written, no folder made."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from trundle.cli import run
from trundle.cli.app import command
from trundle.scenario import files
from trundle.simulation import memory

from .conftest import Command

TEXT = files.read("level-turntable-nudged")
NUDGE, TURNING = 'velocity = ["0 m/s", "0.1 m/s"]', "`start.angular_velocity`"
ROWS = [  # (what stands in the file, what comes instead, the key, the value that came, the remedy)
    ('radius = "25 mm"', 'radios = "25 mm"', "`body.radios`", "'25 mm'", "Did you mean 'radius'?"),
    ('radius = "25 mm"', "", "`body.radius`", "nothing", 'radius = "25 mm"'),
    ('radius = "25 mm"', 'radius = "25 kg"', "`body.radius`", "'25 kg'", "Write for instance '25 mm'"),
    ('radius = "25 mm"', 'radius = "small"', "`body.radius`", "'small'", "Write for instance '25 mm'"),
    ('radius = "25 mm"', "radius = 25 mm", "`line", "'radius = 25 mm'", 'radius = "25 mm"'),
    ('radius = "25 mm"', "radius = nan", "`body.radius`", "nan", "NaN and infinities are refused"),
    ('"33.3 rpm"', "inf", "`support.motion.rate`", "inf", "NaN and infinities are refused"),
    ('radius = "25 mm"', "radius = 0", "`body.radius`", "0", "Write for instance"),
    ('mass = "510 g"', 'mass = "-510 g"', "`body.mass`", "'-510 g'", "Write for instance"),
    ('duration = "20 s"', "duration = 0", "`run.duration`", "0", "Write for instance"),
    ('duration = "20 s"', "duration = -3", "`run.duration`", "-3", "Write for instance"),
    ('every = "10 ms"', "every = 0", "`run.every`", "0", "Write for instance"),
    ('every = "10 ms"', 'every = "30 s"', "`run.every`", "'30 s'", "shorter step"),
    ('"20 cm"', '"60 cm"', "`start.position`", "'60 cm'", "inside the rim at 0.5 m"),
    ('kind = "plane"', 'kind = "plane"\ntilt = "90 deg"', "`support.tilt`", "'90 deg'", "wall"),
    ('kind = "plane"', 'kind = "plane"\ntilt = 5', "`support.tilt`", "5", 'Did you mean "5 deg"?'),
    (NUDGE, "spin = 1\nangular_velocity = [0, 0, 1]", TURNING, "[0.0, 0.0, 1.0]", "Give `spin`"),
    (NUDGE, "angular_velocity = [0, 0, 1]", TURNING, "slip", "give `spin` instead"),
    ('duration = "20 s"', "duration = 1e10", "`run.every`", "'10 ms'", "1,000,000,000,001"),
    (TEXT, "", "`scenario`", "''", "trundle show"),
]  # fmt: skip


@pytest.mark.parametrize(("there", "instead", "key", "value", "remedy"), ROWS)
def test_a_bad_file(here: Command, folder: Path, there: str, instead: str, key: str, value: str, remedy: str) -> None:
    assert TEXT.count(there) == 1
    (folder / "bad.toml").write_text(TEXT.replace(there, instead), encoding="utf-8")
    done = here("run", "bad.toml")
    assert (done.status, done.out, done.files) == (2, "", {"bad.toml"})
    (message,) = done.err.splitlines()
    assert message.startswith(f"trundle: bad.toml: {key}")
    assert value in message.partition("; got ")[2]
    assert remedy in message


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["no-such-one"], "`scenario` must be a file or the name of a shipped scenario; got 'no-such-one'"),
        (["titled-turntable"], "Did you mean 'tilted-turntable'?"),
        (["."], "This is a folder"),
        (["tilted-turntable", "--duration", "0 s"], "`--duration` must be positive; got '0 s'"),
        (["tilted-turntable", "--duration", "20"], "`--duration` must be a time with its unit; got '20'. Write '20 s'"),
        (["tilted-turntable", "--duration", "20 m"], "`--duration` must be a time; got '20 m'"),
        (["tilted-turntable", "--every", "0"], "got '0'. Write its unit behind it, as in '60 s'."),
        (["tilted-turntable", "--every", "nan"], "`--every` must be a finite number; got 'nan'"),
        (["tilted-turntable", "--every", "1 h"], "`--every` must not be longer than the run"),
        (["tilted-turntable", "--every", "1e-12 s"], "`--every` must leave at most 10,000,000 samples"),
        (["tilted-turntable", "--method", "tailor"], "`--method` must be one of those that exist; got 't"),
        (["tilted-turntable", "--method", "tailor"], "Did you mean 'taylor'?"),
        (["rattleback", "--tolerance", "0.1"], "`--tolerance` must be a number from 1e-15 to 1e-06; got 0.1."),
        (["tilted-turntable", "-o", "file"], "`--output` must be a folder; got 'file'"),
        (["tilted-turntable", "-o", "file/below"], "`--output` must be a folder; got 'file/below'"),
    ],
)  # fmt: skip
def test_bad_words(here: Command, folder: Path, words: list[str], said: str) -> None:
    (folder / "file").write_text("in the way")
    done = here("run", *words)
    assert (done.status, done.out, done.files) == (2, "", {"file"})
    assert said in done.err
    assert len(done.err.splitlines()) == 1


def test_more_samples_than_find_room_in_memory(here: Command, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory, "free", lambda: 5e8)
    done = here("run", "tilted-turntable", "--every", "10 us")
    assert (done.status, done.out, done.files) == (2, "", set())
    assert "`every` must leave no more samples than find room in memory" in done.err
    assert "2,000,001 of them take 555 MB, and 500 MB are free: ask for 1.2e-05 s or more" in done.err


@pytest.mark.parametrize("option", ["--quiet", "--json"])
def test_errors_are_told_even_when_quiet(here: Command, option: str) -> None:
    done = here("run", "no-such-scenario", option)
    assert (done.status, done.out) == (2, "")
    assert done.err.startswith("trundle: `scenario` must be a file")


def test_the_same_in_a_process_of_its_own(trundle: Command, folder: Path) -> None:
    (folder / "bad.toml").write_bytes(b"\xff\xfe\x00")
    done = trundle("run", "bad.toml")
    assert (done.status, done.out, done.files) == (2, "", {"bad.toml"})
    assert done.err == (
        "trundle: bad.toml: `scenario` must be text in UTF-8; got 'byte 0xff in line 1'. "
        "It looks like UTF-16: save it as UTF-8.\n"
    )


def test_what_is_no_bad_input_is_called_a_bug(here: Command, monkeypatch: pytest.MonkeyPatch) -> None:
    def break_down(*_: object) -> list[str]:
        raise ZeroDivisionError("at the worst moment")

    monkeypatch.setattr(files, "names", break_down)
    done = here("list")
    assert done.status == 1
    assert done.err == (
        "trundle: this is a bug in trundle, ZeroDivisionError: at the worst moment\n"
        "Please report it with the traceback, which TRUNDLE_DEBUG=1 in the environment prints.\n"
    )
    monkeypatch.setenv("TRUNDLE_DEBUG", "1")
    assert "Traceback" in here("list").err


SUPPORT, PLANE_MOTION = 'kind = "plane"', 'kind = "spin"\nrate = "33.3 rpm"'
COMBINED = [  # of the other bodies, surfaces, motions and starts: (what stands there, what comes instead, key, remedy)
    ([(SUPPORT, 'kind = "bowl"\nradius = "2 cm"'), ('rim = "0.5 m"', "")], "`start.position`", "on the surface"),
    (
        [(SUPPORT, 'kind = "bowl"\nradius = "22 mm"'), ('rim = "0.5 m"', ""), ('"20 cm"', "0")],
        "`start.position`",
        "must be where the body fits the surface",
    ),
    (
        [(SUPPORT, 'kind = "height-field"\nformula = "0.2*abs(x)"'), ('"20 cm"', "0")],
        "`start.position`",
        "where it is smooth",
    ),
    ([(PLANE_MOTION, 'kind = "spin-by"\nrate = "1/(t - 3)"')], "`support.motion.rate`", "It is not at t = 3 s."),
    ([(SUPPORT, f"{SUPPORT}\nfriction = 0.2\nkinetic_friction = 0.3")], "`support.kinetic_friction`", "at most"),
    ([(SUPPORT, f"{SUPPORT}\nrestitution = 1.5")], "`support.restitution`", "[0, 1]"),
    ([(NUDGE, "attitude = [0, 1, 0]\norientation = [1, 0, 0, 0]")], "`start.attitude`", "one of the two"),
    ([(NUDGE, 'height = "-1 cm"')], "`start.height`", "must"),
    ([('kind = "solid-sphere"', 'kind = "disc"'), (NUDGE, "")], "`start.orientation`", "one point"),
]


@pytest.mark.parametrize(("changes", "key", "said"), COMBINED)
def test_a_bad_file_of_any_kind(
    here: Command, folder: Path, changes: list[tuple[str, str]], key: str, said: str
) -> None:
    text = TEXT
    for there, instead in changes:
        assert text.count(there) == 1, there
        text = text.replace(there, instead)
    (folder / "bad.toml").write_text(text, encoding="utf-8")
    done = here("run", "bad.toml", "-o", "out")
    assert (done.status, done.out, done.files) == (2, "", {"bad.toml"})
    (message,) = done.err.splitlines()
    assert message.startswith(f"trundle: bad.toml: {key}")
    assert said in message


def test_a_load_without_a_value_where_the_ball_starts(here: Command, folder: Path) -> None:
    load = '\n[[loads]]\nkind = "potential"\nformula = "0.01/sqrt(x**2 + y**2)"\n'
    (folder / "bad.toml").write_text(TEXT.replace('"20 cm"', "0") + load, encoding="utf-8")
    done = here("run", "bad.toml")
    assert (done.status, done.out, done.files) == (2, "", {"bad.toml"})
    assert "`loads[0]` must be finite at the start" in done.err


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["check", "theirs.csv", "-s", "free-turntable-ellipse"], "`support.motion` must say where the support is"),
        (["sensitivity", "free-turntable-ellipse"], "`support"),
        (["equilibria", "free-turntable-ellipse"], "`support.motion` must be at rest"),
        (["steady", "free-turntable-ellipse"], "`support.motion` must be steady"),
    ],
)
def test_rooms_that_do_not_cover_a_free_table_say_so(here: Command, folder: Path, words: list[str], said: str) -> None:
    rows = "\n".join(f"{0.01 * i},{0.1 + 0.001 * i},{0.002 * i},0.025" for i in range(40))
    (folder / "theirs.csv").write_text("t,x,y,z\n" + rows, encoding="utf-8")
    done = here(*words)
    assert (done.status, done.files) == (2, {"theirs.csv"})
    assert said in done.err


def _single() -> list[tuple[str, str, int]]:
    """Each option of each command that is given once, and how many words it takes."""
    return [
        (name, max(option.opts, key=len), option.nargs)
        for name, one in command().commands.items()
        for option in one.params
        if option.param_type_name == "option" and not (option.multiple or option.is_flag)
    ]


@pytest.mark.parametrize("name", sorted({name for name, *_ in _single()}))
def test_an_option_of_one_value_is_not_given_two(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    """The first would be lost without a word."""
    for option, size in [(option, size) for command_name, option, size in _single() if command_name == name]:
        assert run([name, *2 * [option, *size * ["1"]]]) == 2
        assert capsys.readouterr().err == f"trundle: `{option}` must be given once; got '2 values'. Keep one.\n"


def test_a_switch_may_be_thrown_twice_and_a_list_be_long(trundle: Command) -> None:
    words = ("--plan", "--plan", "-f", "support.tilt", "-f", "body.mass")
    assert trundle("fit", "-s", "cylinder-on-incline", *words).status == 0


@pytest.mark.parametrize(
    ("command", "scenario", "kind"),
    [
        ("steady", "ball-on-a-pushed-box", "move"),
        ("steady", "coin-upright-on-incline", "torque"),
        ("steady", "cylinder-on-incline", "cylinder"),
        ("equilibria", "ball-in-a-turning-bowl", "spin"),
        ("equilibria", "coin-upright-on-incline", "torque"),
        ("sensitivity", "ball-in-a-trough", "ball on cylinder"),
        ("twin", "ball-in-a-trough", "cylinder"),
    ],
)
def test_a_part_is_called_what_the_file_calls_it(trundle: Command, command: str, scenario: str, kind: str) -> None:
    said = trundle(command, scenario).err
    assert re.search(rf"\b{kind}\b", said)
    assert not re.search(r"[A-Z]\w*\(|tree=", said), said
