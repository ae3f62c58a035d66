"""The place of the support that is nearest to a body, against a search of all of the surface."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import minimize

import trundle as tr
from trundle.errors import SolverError
from trundle.mechanics.algebra import Quaternion, Vector
from trundle.mechanics.nearest import closest_contact, closest_contacts

SURFACES = {
    "waves": (
        tr.HeightField("0.05*cos(6*x)*cos(5*y) + 0.1*x*y"),
        lambda x, y: 0.05 * np.cos(6 * x) * np.cos(5 * y) + 0.1 * x * y,
    ),
    "dish": (tr.Paraboloid(0.3), lambda x, y: (x**2 + y**2) / 0.6),
    "saddle": (tr.HeightField("0.5*x**2 - 0.8*y**2"), lambda x, y: 0.5 * x**2 - 0.8 * y**2),
}
BODIES = {
    "ball": (tr.Body.solid_sphere(0.05, 1.0), (0.05, 0.05, 0.05)),
    "ellipsoid": (tr.Body.ellipsoid((0.06, 0.04, 0.05), density=1000.0), (0.06, 0.04, 0.05)),
}


def over(height, count):
    """Return centres over a surface, low ones and some that are higher than it bends, and orientations."""
    random = np.random.default_rng(5)
    x, y = random.uniform(-0.15, 0.15, (2, count))
    q = random.normal(size=(count, 4))
    return np.column_stack([x, y, height(x, y) + random.uniform(0.15, 0.6, count)]), q / np.linalg.norm(q, axis=1)[
        :, None
    ]


def least_distance(height, axes, centre, turn):
    """Return how far apart the nearest two points of a surface and an ellipsoid are, searched for from many places."""

    def apart(at):
        x, y, u, v = at
        rim = np.asarray(axes) * [np.sin(v) * np.cos(u), np.sin(v) * np.sin(u), np.cos(v)]
        return np.linalg.norm(centre + turn @ rim - [x, y, height(x, y)])

    starts = [
        (centre[0] + r * np.cos(a), centre[1] + r * np.sin(a), a, 2.0)
        for r in (0.02, 0.3)
        for a in np.linspace(0, 2 * np.pi, 5)[:4]
    ]
    return min(minimize(apart, start, method="BFGS", options={"gtol": 1e-9}).fun for start in starts)


@pytest.mark.parametrize("body", sorted(BODIES))
@pytest.mark.parametrize("surface", sorted(SURFACES))
def test_no_other_place_is_nearer(surface, body):
    (ground, height), (rolled, axes) = SURFACES[surface], BODIES[body]
    system = tr.RollingSystem(rolled, tr.Support(ground))
    centre, q = over(height, 10)
    contact = closest_contacts(system, np.zeros(10), centre, q)
    gap = (Vector.of(centre) + contact.offset - contact.point).norm()
    assert np.allclose(contact.point.z, height(contact.point.x, contact.point.y), atol=1e-12)
    for i, (c, turn) in enumerate(zip(centre, q, strict=True)):
        assert gap[i] == pytest.approx(
            least_distance(height, axes, c, np.array([tuple(row) for row in Quaternion(*turn).matrix().rows])), abs=1e-7
        )
        alone = closest_contact(system, 0.0, Vector(*c.tolist()), Quaternion(*turn.tolist()))
        assert (alone.point - Vector.of(contact.point.array()[i])).norm() < 1e-12


WAVES = {
    "0.0544055*sin(3.68431*y)*cos(9.07652*y)": lambda _, y: 0.0544055 * np.sin(3.68431 * y) * np.cos(9.07652 * y),
    "0.03*sin(7*x)*cos(11*y)": lambda x, y: 0.03 * np.sin(7 * x) * np.cos(11 * y),
    "0.06*sin(5*x + 3*y)": lambda x, y: 0.06 * np.sin(5 * x + 3 * y),
    "0.02*(cos(9*x) + sin(12*y)) + 0.2*x*x": lambda x, y: 0.02 * (np.cos(9 * x) + np.sin(12 * y)) + 0.2 * x * x,
}


def distance_on_grids(height, centre):
    """Return how far a point is from a surface, by ever finer grids."""
    middle, reach = centre[:2], centre[2] + 0.2
    for _ in range(5):
        x, y = (np.linspace(at - reach, at + reach, 700) for at in middle)
        x, y = np.meshgrid(x, y)
        far = np.hypot(np.hypot(x - centre[0], y - centre[1]), height(x, y) - centre[2])
        i = np.argmin(far)
        middle, reach = (x.flat[i], y.flat[i]), reach / 40
    return far.flat[i]


@pytest.mark.parametrize("formula", WAVES)
def test_from_high_over_waves_one_of_the_nearest_is_found(formula):
    # A crest right under the body is a nearest point of its own, and one beside it nearer.
    random = np.random.default_rng(7)
    system = tr.RollingSystem(tr.Body.solid_sphere(0.01, 1.0), tr.Support(tr.HeightField(formula)))
    centre = np.column_stack([random.uniform(-0.5, 0.5, (20, 2)), 10 ** random.uniform(-0.7, 0.7, 20)])
    still = np.tile([1.0, 0.0, 0.0, 0.0], (20, 1))
    contacts = closest_contacts(system, np.zeros(20), centre, still).point.array()
    least = np.array([distance_on_grids(WAVES[formula], one) for one in centre])
    found = np.linalg.norm(centre - contacts, axis=1)
    assert found.min() > 0.1
    assert (found <= 1.01 * least).all()
    assert (found <= (1 + 1e-9) * least).sum() >= 19
    alone = closest_contact(system, 0.0, Vector(*centre[0]), Quaternion(1.0, 0.0, 0.0, 0.0)).point
    np.testing.assert_allclose(tuple(alone), contacts[0], rtol=0, atol=1e-9)


def test_one_of_many_that_is_nowhere_nearest_is_named():
    side = np.linspace(-0.2, 0.2, 7)
    ended = tr.HeightField.through(side, side, np.add.outer(side**2, side**2))
    system, centre = tr.RollingSystem(BODIES["ball"][0], tr.Support(ended)), np.array([[0, 0, 0.1], [0.5, 0, 0.9]])
    with pytest.raises(SolverError, match=r"At t = 0\.25 s no point of the surface .* \(0\.5, 0, 0\.9\) m"):
        closest_contacts(system, np.array([0.0, 0.25]), centre, np.tile([1.0, 0.0, 0.0, 0.0], (2, 1)))
