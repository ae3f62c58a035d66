"""Texts with units become the SI float that is nearest to what they say, and nothing else gets through."""

from __future__ import annotations

import math
import re
import subprocess
import sys
from fractions import Fraction

import mpmath
import numpy as np
import pint
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from trundle.errors import InvalidValueError
from trundle.units import UNITS, _exact_factor, plus_minus, span, to_si, unit_registry

ULP = np.finfo(float).eps


@given(st.integers(-(10**6), 10**6), st.integers(0, 9))
def test_a_decimal_with_a_metric_unit_is_rounded_once(digits: int, places: int) -> None:
    written = Fraction(digits, 10**places)
    text = f"{'-' if digits < 0 else ''}{abs(digits) // 10**places}.{abs(digits) % 10**places:0{places}d}"
    assert to_si(f"{text} mm", "length", "x") == float(written / 1000)
    assert to_si(f"{text} g", "mass", "x") == float(written / 1000)
    assert to_si(f"{text} km/h", "velocity", "x") == float(written * 5 / 18)
    assert to_si(f"{text}min", "time", "x") == float(written * 60)


@given(st.decimals(-1000, 1000, places=4))
def test_angles_are_the_nearest_float(number: object) -> None:
    with mpmath.workdps(50):
        degrees = float(mpmath.mpf(str(number)) * mpmath.pi / 180)
        turns_per_minute = float(mpmath.mpf(str(number)) * mpmath.pi / 30)
    assert to_si(f"{number} deg", "angle", "x") == degrees
    assert to_si(f"{number} rpm", "angular velocity", "x") == turns_per_minute


COMMON = (
    "m,mm,cm,km,um,µm,μm,nm,dm,g,kg,mg,s,ms,us,min,h,rad,mrad,deg,°,turn,rpm,N,mN,kN,J,mJ,"
    "m/s,m/s^2,m/s**2,m/s²,m/s/s,cm/s,km/h,rad/s,deg/s,turn/s,turn/min,rad/min,1/s,s^-1,N*m,N·m,kg*m^2,kg·m²,"
    "g*cm^2,kg/s,g/s,N*s/m,kg*m/s^2,mN m,kg m^2,N m,kg m² s^-1,m / s"
)


@pytest.mark.parametrize("unit", COMMON.split(","))
def test_common_units_agree_with_pint(unit: str) -> None:
    exact = _exact_factor(unit)
    assert exact is not None
    registry = unit_registry()
    base = dict(zip(("meter", "kilogram", "second", "radian"), exact[1], strict=True))
    product = math.prod((registry.Unit(name) ** power for name, power in base.items()), start=registry.Unit(""))
    assert registry.Quantity(1.0, unit).to(product).magnitude == pytest.approx(float(exact[0]), rel=8 * ULP)


@pytest.mark.parametrize(
    ("text", "kind", "expected"),
    [
        ("1 inch", "length", 0.0254),
        ("2 ft", "length", 0.6096),
        ("1 lb", "mass", 0.45359237),
        ("1 (m)", "length", 1.0),
        ("1 kgf", "force", 9.80665),
        ("1 rps", "angular velocity", 2 * math.pi),
        ("90 arcmin", "angle", math.radians(1.5)),
        ("5 %", "number", 0.05),
        ("1 hour", "time", 3600.0),
    ],
)
def test_other_units_go_through_pint(text: str, kind: str, expected: float) -> None:
    assert to_si(text, kind, "x") == pytest.approx(expected, rel=8 * ULP)


@pytest.mark.parametrize(
    ("text", "number"),
    [
        ("0.5 m", 0.5),
        (".5 m", 0.5),
        ("1e-3 m", 0.001),
        ("1_000 m", 1000.0),
        ("+2m", 2.0),
        ("\u22122 m", -2.0),
        (" 3\u00a0m ", 3.0),
    ],
)
def test_ways_of_writing_a_number(text: str, number: float) -> None:
    assert to_si(text, "length", "x") == number


@pytest.mark.parametrize("wanted", UNITS)
@pytest.mark.parametrize("given_kind", UNITS)
def test_a_wrong_dimension_is_refused(wanted: str, given_kind: str) -> None:
    text = f"2 {UNITS[given_kind][0]}".strip()
    if wanted == given_kind:
        assert to_si(text, wanted, "x") == 2.0
    else:
        with pytest.raises(
            InvalidValueError,
            match=f"`x` must be an? {wanted}(?: with its unit)?; got '{text.replace('^', '.').replace('*', '.')}'",
        ):
            to_si(text, wanted, "x")


@pytest.mark.parametrize("kind", UNITS)
@pytest.mark.parametrize("digits", ["45", "0", "-2.5", "1e3", ".5", "1_000", " 7 ", "\u22123"])
def test_text_without_a_unit_is_refused_with_what_to_write(kind: str, digits: str) -> None:
    bare = digits.strip().replace("\u2212", "-")
    if kind == "number":  # no unit is missing
        assert to_si(digits, kind, "x") == float(bare)
        return
    with pytest.raises(InvalidValueError) as caught:
        to_si(digits, kind, "x")
    message = str(caught.value)
    assert f"`x` must be a{'n' * (kind[0] in 'aei')} {kind} with its unit; got {digits!r}." in message
    offered = re.findall(r"'([^']+)'", message.partition("Write ")[2])
    if float(bare) <= 0:  # with a unit it might be refused in turn
        assert message.endswith(f"Write its unit behind it, as in '{UNITS[kind][1]}'.")
        assert to_si(offered[0], kind, "x") > 0
        return
    assert len(offered) == len(dict.fromkeys([UNITS[kind][0], UNITS[kind][1].split(" ")[1]]))
    assert to_si(offered[0], kind, "x") == float(bare)  # what the bare number means
    assert f"the bare number {bare}, which is in {UNITS[kind][0]}." in message


@pytest.mark.parametrize(
    ("value", "kind", "said"),
    [
        ("3 Hz", "angular velocity", "turn/s"),
        ("3 Bq", "angular velocity", "turn/s"),
        ("5 %", "angle", "3 deg"),
        ("5 deg", "number", "bare number"),
        ("0,5 m", "length", "decimal point"),
        ("5 mmm", "length", "unknown unit"),
        ("20 degC", "length", "25 mm"),
        ("nan", "length", "finite"),
        ("-inf m", "length", "finite"),
        ("1e309 m", "length", "finite"),
        ("1e308 km", "length", "finite"),
        (math.nan, "length", "finite"),
        (math.inf, "length", "finite"),
        (10**400, "length", "1e308"),
        (True, "length", "must be a length"),
        (None, "angle", "must be an angle"),
        ("", "mass", "65 g"),
        ("heavy", "mass", "65 g"),
        ("1_ m", "length", "25 mm"),
        ("1__0 m", "length", "25 mm"),
        ("٣ m", "length", "25 mm"),
        ("3 m^99999999", "length", "25 mm"),
        ("3 m^9^9^9^9", "length", "25 mm"),
        ("9" * 10_000, "length", "25 mm"),
        ("1 " + "m" * 10_000, "length", "25 mm"),
        ("2/3", "number", "bare number"),
    ],
)
def test_what_is_refused(value: object, kind: str, said: str) -> None:
    with pytest.raises(InvalidValueError) as caught:
        to_si(value, kind, "body.thing")
    assert "`body.thing`" in str(caught.value)
    assert said in str(caught.value)
    assert len(str(caught.value)) < 400


def test_quantities_of_any_pint_registry() -> None:
    other = pint.UnitRegistry()
    assert to_si(25 * other.mm, "length", "x") == pytest.approx(0.025, rel=4 * ULP)
    assert to_si(3 * unit_registry().deg, "angle", "x") == pytest.approx(math.radians(3), rel=4 * ULP)
    assert to_si(other.Quantity(0.1, ""), "angle", "x") == 0.1
    np.testing.assert_allclose(to_si(np.array([1.0, 2.0]) * other.cm, "length", "x"), [0.01, 0.02], rtol=4 * ULP)
    with pytest.raises(InvalidValueError, match="must be a length"):
        to_si(25 * other.gram, "length", "x")
    with pytest.raises(InvalidValueError, match="finite"):
        to_si(math.nan * other.m, "length", "x")


def test_arrays_pass_through() -> None:
    array = np.array([1.0, 2.0])
    assert to_si(array, "length", "x") is array


SCRAPS = st.sampled_from(
    [
        *"0123456789.eE+-_ */^()²³µ°%",
        "nan",
        "inf",
        "m",
        "mm",
        "rpm",
        "deg",
        "Hz",
        "**",
        "kg",
        "s",
        "degC",
        "dB",
    ]
)


@settings(deadline=None, max_examples=300)
@given(st.one_of(st.text(max_size=30), st.lists(SCRAPS, max_size=8).map("".join)), st.sampled_from(list(UNITS)))
def test_any_text_is_a_finite_float_or_refused(text: str, kind: str) -> None:
    try:
        number = to_si(text, kind, "x")
    except InvalidValueError:
        return
    assert type(number) is float
    assert math.isfinite(number)


@pytest.mark.parametrize("sign", ["±", "+-", "+/-", " ± "])
@pytest.mark.parametrize(
    ("middle", "half", "both"),
    [
        ("33.3", "0.3 rpm", ("33.3 rpm", "0.3 rpm")),
        ("33.3 rpm", "0.3", ("33.3 rpm", "0.3 rpm")),
        ("33.3 rpm", "0.01 rad/s", ("33.3 rpm", "0.01 rad/s")),
        ("-4e-1", "1E-2", ("-4e-1", "1E-2")),
        ("1e-3", "5% ", ("1e-3 %", "5%")),
        ("what", "ever", ("what", "ever")),
    ],
)
def test_a_unit_that_stands_once_stands_for_both(middle: str, half: str, both: tuple[str, str], sign: str) -> None:
    assert plus_minus(f"{middle}{sign}{half}") == both
    assert span(f"{middle}..{half}") == both


@pytest.mark.parametrize("text", ["", "3 rpm", "±", "± 3", "3 ±", "3 ± 4 ± 5"])
def test_what_has_no_two_parts_is_no_value_with_its_error(text: str) -> None:
    assert plus_minus(text) is None
    assert span(text.replace("±", "..")) is None


def test_common_units_leave_pint_alone() -> None:
    code = "import sys; from trundle.units import plus_minus, to_si; to_si('3 rpm', 'angular velocity', 'x')"
    code += "; print('pint' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)  # noqa: S603
    assert done.stdout == "False\n"
