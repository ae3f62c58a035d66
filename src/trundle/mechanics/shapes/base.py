"""What every shape is: support map and inverse curvature, all that contact needs to know of a convex body."""

from __future__ import annotations

from ..algebra import Matrix, Vector


class Shape:
    """A convex body's surface, known by the point where its outward normal is ν (theory page, section 2)."""

    axis: Vector | None = None  # of a body that touches along a line, in the body frame: it rolls across it, straight

    def support_map(self, nu: Vector) -> Vector:
        """Return X(ν), the body-frame point with outward unit normal ν, in m from the centre of mass."""
        raise NotImplementedError

    def support_gradient(self, nu: Vector) -> Matrix:
        """Return ∂X/∂ν on the tangent plane of ν, in m: symmetric, its eigenvalues the radii of curvature."""
        raise NotImplementedError

    def contact(self, Q: Matrix, n: Vector) -> tuple[Vector, Matrix]:
        """Return ρ = Q X(−Qᵀn) and C = Q (∂X/∂ν) Qᵀ for a support with unit normal n into the body.

        Parameters
        ----------
        Q : Matrix
            Body frame to support frame.
        n : Vector
            Unit normal of the support at the contact, from the support into the body.

        Returns
        -------
        rho : Vector
            From the centre of mass to the contact point, support frame, m.
        C : Matrix
            Inverse curvature at the contact, support frame, m.
        """
        nu = -(Q.transpose @ n)
        return Q @ self.support_map(nu), Q @ self.support_gradient(nu) @ Q.transpose
