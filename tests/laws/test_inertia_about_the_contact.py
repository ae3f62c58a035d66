"""J + m(ρ² 1 − ρ ρᵀ) is solved as mpmath solves it, with both parts of what stands on the right."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from tests.tolerances import EXACT

from trundle.mechanics.algebra import ZERO, IsotropicTensor, Matrix, RoundInertia, Vector, inertia_about


@pytest.mark.parametrize("moments", [(1.0, 1.0, 1.0), (0.5, 1.3, 1.9), (1e-3, 1.0, 1.0)], ids=str)
@pytest.mark.parametrize("reach", [0.0, 0.3, 3.0])
def test_it_is_solved_as_mpmath_does(moments: tuple[float, float, float], reach: float) -> None:
    J = IsotropicTensor.of(moments[0]) if len(set(moments)) == 1 else Matrix.diagonal(*moments)
    assert isinstance(inertia_about(J, 2.0, ZERO), RoundInertia) == (len(set(moments)) == 1)
    for rho, v, w in np.random.default_rng(3).normal(size=(40, 3, 3)):
        offset, torque = Vector(*(reach * rho).tolist()), Vector(*v.tolist())
        lever = offset.cross(Vector(*w.tolist()))
        found = inertia_about(J, 2.0, offset).solve(torque, lever)
        with mpmath.workdps(40):
            r = mpmath.matrix(list(offset))
            whole = mpmath.diag(list(moments)) + 2 * ((r.T * r)[0] * mpmath.eye(3) - r * r.T)
            wanted = mpmath.lu_solve(whole, mpmath.matrix([a + b for a, b in zip(torque, lever, strict=True)]))
            condition = mpmath.mnorm(whole, 1) * mpmath.mnorm(whole**-1, 1)
            off = mpmath.norm(mpmath.matrix(list(found)) - wanted) / mpmath.norm(wanted)
        assert off <= EXACT(16, float(condition))
