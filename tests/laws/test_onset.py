"""The directions in which slip can begin, against the roots of a polynomial: also where friction jams some of them."""

from __future__ import annotations

import numpy as np
import pytest

from trundle.mechanics.algebra import Vector
from trundle.mechanics.creep import SlipRates
from trundle.mechanics.onset import onset

AXES = Vector(1.0, 0.0, 0.0), Vector(0.0, 1.0, 0.0), Vector(0.0, 0.0, 1.0)


def drawn(seed: int, friction: float) -> SlipRates:
    """A body that is pressed on, and answers to forces at its contact by a positive definite matrix."""
    random = np.random.default_rng(seed)
    half = random.normal(size=(3, 3))
    answers = half @ half.T
    free = random.normal(size=3)
    opening = -abs(free[2])
    rubbed, rubbed_across, pressed = (Vector(*column) for column in answers.T)
    return SlipRates(AXES, friction, Vector(*free[:2], opening), opening, pressed, (rubbed, rubbed_across))


def quartic(rates: SlipRates) -> list[tuple[float, float, float]]:
    """The rate along, cos β and sin β where ṡ is along ŝ: what is across, times a₁·n, is of second order in e^iβ."""
    angles = 2 * np.pi * np.arange(5) / 5
    c, s = np.cos(angles), np.sin(angles)
    answer = [one.array() for one in (rates.pressed, *rates.rubbed)]
    a = answer[0][:, None] - rates.friction * (answer[1][:, None] * c + answer[2][:, None] * s)
    driven = np.array([rates.free.x, rates.free.y])[:, None] * a[2] - a[:2] * rates.opening
    values = c * driven[1] - s * driven[0]
    terms = np.fft.fft(values) / 5  # of e^0, e^iβ, e^2iβ, e^−2iβ, e^−iβ
    roots = np.roots([terms[2], terms[1], terms[0], terms[4], terms[3]])
    found = []
    for root in roots[np.abs(np.abs(roots) - 1) < 1e-7]:
        c, s = float(root.real / abs(root)), float(root.imag / abs(root))
        a = answer[0] - rates.friction * (answer[1] * c + answer[2] * s)
        N = -rates.opening / a[2]
        found.append((float(c * (rates.free.x + a[0] * N) + s * (rates.free.y + a[1] * N)), c, s))
    return sorted((one for one in found if one[0] > 0), reverse=True)


@pytest.mark.parametrize("friction", [0.0, 0.3, 1.0, 3.0, 10.0])
def test_slip_begins_where_a_polynomial_has_its_roots(friction: float) -> None:
    jammed = False
    for seed in range(60):
        rates = drawn(seed, friction)
        found = [(rate, c, s) for rate, (c, s) in onset(rates.along_and_pressing)]
        expected = quartic(rates)
        assert len(found) == len(expected), seed
        assert np.allclose(found, expected, rtol=1e-7, atol=1e-9), seed
        jammed |= any(rates.answer(np.cos(angle), np.sin(angle)).z < 0 for angle in np.linspace(0, 2 * np.pi, 60))
    assert jammed == (friction > 0)
