"""Vectors, matrices and quaternions over any scalar of `scalars`: the vector algebra of the theory page.

A `Vector` holds three scalars, so the same expression is arithmetic on floats, on whole arrays of balls
(each component an array), and symbolic algebra. Literal zeros stay literal, and symbolic kinds drop them.
"""

from __future__ import annotations

import math
from typing import Any

from .records import frozen_record
from .scalars import Scalar, is_number, is_zero, namespace


@frozen_record()
class Vector:
    """A vector in space, by its three components in one frame.

    Examples
    --------
    >>> Vector(1.0, 0.0, 0.0).cross(Vector(0.0, 1.0, 0.0))
    Vector(x=0.0, y=0.0, z=1.0)
    """

    x: Scalar
    y: Scalar
    z: Scalar

    __array_ufunc__ = None  # so that array * Vector asks Vector

    def __iter__(self) -> Any:
        return iter((self.x, self.y, self.z))

    def __add__(self, other: Vector) -> Vector:
        return Vector(self.x + other.x, self.y + other.y, self.z + other.z)

    def __sub__(self, other: Vector) -> Vector:
        return Vector(self.x - other.x, self.y - other.y, self.z - other.z)

    def __neg__(self) -> Vector:
        return Vector(-self.x, -self.y, -self.z)

    def __mul__(self, factor: Scalar) -> Vector:
        return Vector(self.x * factor, self.y * factor, self.z * factor)

    __rmul__ = __mul__

    def __truediv__(self, divisor: Scalar) -> Vector:
        return Vector(self.x / divisor, self.y / divisor, self.z / divisor)

    def dot(self, other: Vector) -> Scalar:
        """Return the scalar product with another vector."""
        return self.x * other.x + self.y * other.y + self.z * other.z

    def cross(self, other: Vector) -> Vector:
        """Return the vector product, right-handed: x cross y points along z."""
        return Vector(
            self.y * other.z - self.z * other.y,
            self.z * other.x - self.x * other.z,
            self.x * other.y - self.y * other.x,
        )

    def norm(self) -> Scalar:
        """Return the length."""
        square = self.dot(self)
        if type(square) is float:  # asked for thousands of times where a contact is searched for
            return math.sqrt(square)
        return namespace(self.x, self.y, self.z).sqrt(square)

    @staticmethod
    def of(components: Any) -> Vector:
        """Take three components from a sequence, or from the last axis of an array."""
        if hasattr(components, "__array_namespace__"):
            return Vector(components[..., 0], components[..., 1], components[..., 2])
        x, y, z = components
        return Vector(x, y, z)

    def array(self) -> Any:
        """Return a NumPy array whose last axis holds the components; they broadcast against each other."""
        return _side_by_side(self.x, self.y, self.z)


ZERO = Vector(0.0, 0.0, 0.0)
E_X = Vector(1.0, 0.0, 0.0)
E_Y = Vector(0.0, 1.0, 0.0)
E_Z = Vector(0.0, 0.0, 1.0)


@frozen_record()
class Matrix:
    """A 3×3 matrix by its three rows.

    Examples
    --------
    >>> Matrix.identity() @ Vector(1.0, 2.0, 3.0)
    Vector(x=1.0, y=2.0, z=3.0)
    """

    a: Vector
    b: Vector
    c: Vector

    __array_ufunc__ = None

    @staticmethod
    def identity() -> Matrix:
        """Return the unit matrix."""
        return Matrix(E_X, E_Y, E_Z)

    @staticmethod
    def zero() -> Matrix:
        """Return the matrix of zeros."""
        return Matrix(ZERO, ZERO, ZERO)

    @staticmethod
    def diagonal(x: Scalar, y: Scalar, z: Scalar) -> Matrix:
        """Return a diagonal matrix."""
        return Matrix(Vector(x, 0.0, 0.0), Vector(0.0, y, 0.0), Vector(0.0, 0.0, z))

    @staticmethod
    def outer(u: Vector, v: Vector) -> Matrix:
        """Return u vᵀ."""
        return Matrix(v * u.x, v * u.y, v * u.z)

    @property
    def transpose(self) -> Matrix:
        """The transposed matrix."""
        a, b, c = self.a, self.b, self.c
        return Matrix(Vector(a.x, b.x, c.x), Vector(a.y, b.y, c.y), Vector(a.z, b.z, c.z))

    def __add__(self, other: Matrix) -> Matrix:
        return Matrix(self.a + other.a, self.b + other.b, self.c + other.c)

    def __sub__(self, other: Matrix) -> Matrix:
        return Matrix(self.a - other.a, self.b - other.b, self.c - other.c)

    def __mul__(self, factor: Scalar) -> Matrix:
        return Matrix(self.a * factor, self.b * factor, self.c * factor)

    __rmul__ = __mul__

    def __matmul__(self, other: Any) -> Any:
        if isinstance(other, Matrix):
            columns = other.transpose
            return Matrix(columns @ self.a, columns @ self.b, columns @ self.c)  # row by row, dot products commute
        return Vector(self.a.dot(other), self.b.dot(other), self.c.dot(other))

    def __rmatmul__(self, v: Vector) -> Vector:
        """Return vᵀ M, which is Mᵀ v."""
        a, b, c = self.a, self.b, self.c
        return Vector(
            a.x * v.x + b.x * v.y + c.x * v.z,
            a.y * v.x + b.y * v.y + c.y * v.z,
            a.z * v.x + b.z * v.y + c.z * v.z,
        )

    @property
    def rows(self) -> tuple[Vector, Vector, Vector]:
        """The three rows."""
        return self.a, self.b, self.c

    @property
    def is_zero(self) -> bool:
        """Whether all elements are known to be 0."""
        return all(map(is_zero, (*self.a, *self.b, *self.c)))

    @property
    def determinant(self) -> Scalar:
        """The determinant."""
        return self.a.dot(self.b.cross(self.c))

    @property
    def trace(self) -> Scalar:
        """The trace."""
        return self.a.x + self.b.y + self.c.z

    @property
    def tangent_determinant(self) -> Scalar:
        """The determinant on the tangent plane of n, of a matrix that is 0 along n: the sum of the principal minors."""
        (a, b, c), (d, e, f), (g, h, i) = self.rows
        return (a * e - b * d) + (a * i - c * g) + (e * i - f * h)

    @property
    def dense(self) -> Matrix:
        """Itself, as `RotatedTensor.dense`."""
        return self

    def on_tangent(self, v: Vector) -> Vector:
        """Return M v for a v across n, of a matrix that is 0 along n."""
        return self @ v

    def trace_with(self, other: Any) -> Scalar:
        """Return tr(M N) of two symmetric matrices."""
        a, b, c = other.dense.rows
        return self.a.dot(a) + self.b.dot(b) + self.c.dot(c)

    def solve(self, v: Vector) -> Vector:
        """Return x with (this matrix) x = v, by the cofactors: no pivoting, so that symbols can pass."""
        a, b, c = self.a, self.b, self.c
        bc, ca, ab = b.cross(c), c.cross(a), a.cross(b)
        x, y, z = v.x, v.y, v.z
        return Vector(
            x * bc.x + y * ca.x + z * ab.x, x * bc.y + y * ca.y + z * ab.y, x * bc.z + y * ca.z + z * ab.z
        ) / (a.x * bc.x + b.x * ca.x + c.x * ab.x)


@frozen_record()
class IsotropicTensor(Matrix):
    """c·1, the same in all directions, as a ball's inertia is.

    Examples
    --------
    >>> IsotropicTensor.of(2.0).solve(Vector(1.0, 0.0, 4.0))
    Vector(x=0.5, y=0.0, z=2.0)
    """

    size: Scalar

    @staticmethod
    def of(size: Scalar) -> IsotropicTensor:
        """Return c·1."""
        return IsotropicTensor(Vector(size, 0.0, 0.0), Vector(0.0, size, 0.0), Vector(0.0, 0.0, size), size)

    def __matmul__(self, other: Any) -> Any:
        return other * self.size

    def __rmatmul__(self, v: Vector) -> Vector:
        """Return vᵀ M, which is M v."""
        return v * self.size

    def solve(self, v: Vector) -> Vector:
        """Return v/c."""
        return v / self.size


@frozen_record()
class TangentialTensor(Matrix):
    """c P H P with P = 1 − n nᵀ: what is left of a symmetric H across a unit vector n.

    Its elements are at hand, as a matrix's; what does not need them comes from H and n, which is less work.

    Examples
    --------
    >>> tangential = TangentialTensor.of(Matrix.diagonal(1.0, 2.0, 3.0), Vector(0.0, 0.0, 1.0))
    >>> tangential.c.z, tangential.trace, tangential.tangent_determinant
    (0.0, 3.0, 2.0)
    """

    bend: Matrix
    normal: Vector
    scale: Scalar = 1.0

    @staticmethod
    def of(bend: Matrix, n: Vector) -> TangentialTensor:
        """Return P H P."""
        along = bend @ n
        made = bend - Matrix.outer(n, along) - Matrix.outer(along, n) + Matrix.outer(n, n) * n.dot(along)
        return TangentialTensor(made.a, made.b, made.c, bend, n)

    def __mul__(self, factor: Scalar) -> TangentialTensor:
        a, b, c = (row * factor for row in self.rows)
        return TangentialTensor(a, b, c, self.bend, self.normal, self.scale * factor)

    __rmul__ = __mul__

    @property
    def trace(self) -> Scalar:
        """The trace, c(tr H − n·Hn)."""
        return (self.bend.trace - self.normal.dot(self.bend @ self.normal)) * self.scale

    @property
    def tangent_determinant(self) -> Scalar:
        """The determinant across n, c² n·(cof H) n."""
        a, b, c = self.bend.rows
        n = self.normal
        return n.dot(Matrix(b.cross(c), c.cross(a), a.cross(b)) @ n) * (self.scale * self.scale)

    def on_tangent(self, v: Vector) -> Vector:
        """Return c P H v."""
        along = self.bend @ v
        return (along - self.normal * self.normal.dot(along)) * self.scale


@frozen_record()
class RoundTensor(Matrix):
    """c(1 − n nᵀ): the same in all directions across a unit vector n, as the curvature of a sphere is.

    Examples
    --------
    >>> RoundTensor.of(2.0, Vector(0.0, 0.0, 1.0)).on_tangent(Vector(1.0, 0.0, 0.0)).x
    2.0
    """

    size: Scalar

    @staticmethod
    def of(size: Scalar, n: Vector) -> RoundTensor:
        """Return c(1 − n nᵀ)."""
        x, y, z = n
        return RoundTensor(
            Vector((1.0 - x * x) * size, (0.0 - y * x) * size, (0.0 - z * x) * size),
            Vector((0.0 - x * y) * size, (1.0 - y * y) * size, (0.0 - z * y) * size),
            Vector((0.0 - x * z) * size, (0.0 - y * z) * size, (1.0 - z * z) * size),
            size,
        )

    def __mul__(self, factor: Scalar) -> RoundTensor:
        return RoundTensor(self.a * factor, self.b * factor, self.c * factor, self.size * factor)

    __rmul__ = __mul__

    @property
    def trace(self) -> Scalar:
        """The trace, 2 c."""
        return 2.0 * self.size

    @property
    def tangent_determinant(self) -> Scalar:
        """The determinant across n, c²."""
        return self.size * self.size

    def on_tangent(self, v: Vector) -> Vector:
        """Return c v."""
        return v * self.size

    def trace_with(self, other: Any) -> Scalar:
        """Return c tr N, of a matrix N that is 0 along the same n."""
        return self.size * other.trace


@frozen_record()
class ReducedTensor(Matrix):
    """c(A − x xᵀ), as the inverse curvature of an ellipsoid is.

    Its elements are at hand, as a matrix's; to apply it takes fewer products than to work them out.

    Examples
    --------
    >>> ReducedTensor.of(Matrix.identity(), Vector(0.0, 0.0, 1.0), 2.0).on_tangent(Vector(1.0, 0.0, 0.0)).x
    2.0
    """

    whole: Matrix
    taken: Vector
    scale: Scalar

    @staticmethod
    def of(A: Matrix, x: Vector, scale: Scalar) -> ReducedTensor:
        """Return c(A − x xᵀ)."""
        made = (A - Matrix.outer(x, x)) * scale
        return ReducedTensor(made.a, made.b, made.c, A, x, scale)

    def on_tangent(self, v: Vector) -> Vector:
        """Return c(A v − x(x·v))."""
        return (self.whole @ v - self.taken * self.taken.dot(v)) * self.scale


@frozen_record()
class DefiniteMatrix(Matrix):
    """A symmetric, positive definite matrix, solved by elimination without pivots: 16 products, of 27 with cofactors.

    Examples
    --------
    >>> DefiniteMatrix(Vector(4.0, 2.0, 0.0), Vector(2.0, 3.0, 0.0), Vector(0.0, 0.0, 2.0)).solve(Vector(2.0, 3.0, 1.0))
    Vector(x=0.0, y=1.0, z=0.5)
    """

    def solve(self, v: Vector, lever: Vector = ZERO) -> Vector:
        """Return x with (this matrix) x = v + l; they are apart as `RoundInertia` takes them."""
        v = v + lever
        (p, q, r), (_, s, t), (_, _, u) = self.rows
        if getattr(namespace(p), "exact", False):  # fractions within fractions would be left for SymPy to clear
            return Matrix.solve(self, v)
        by_p, to_p = q / p, r / p
        s, t, u = s - by_p * q, t - by_p * r, u - to_p * r
        by_s = t / s
        y, z = v.y - by_p * v.x, v.z - to_p * v.x
        z = (z - by_s * y) / (u - by_s * t)
        y = y / s - by_s * z
        return Vector(v.x / p - by_p * y - to_p * z, y, z)


@frozen_record()
class RotatedTensor:
    """A symmetric matrix known along other axes: Q M Qᵀ, applied without working out its elements.

    To apply it takes 27 products; to work out the elements, 45.

    Examples
    --------
    >>> quarter = Matrix(-E_Y, E_X, E_Z)  # about the third axis
    >>> RotatedTensor(quarter, Matrix.diagonal(1.0, 2.0, 3.0)) @ E_X
    Vector(x=2.0, y=0.0, z=0.0)
    """

    turn: Matrix  # Q, from those axes to the axes of the vectors that it is applied to
    own: Matrix  # M, symmetric, along those axes

    def __matmul__(self, v: Vector) -> Vector:
        return self.turn @ (self.own @ (v @ self.turn))

    def on_tangent(self, v: Vector) -> Vector:
        """Return Q M Qᵀ v, as `Matrix.on_tangent`."""
        return self.turn @ self.own.on_tangent(v @ self.turn)

    def trace_with(self, other: Any) -> Scalar:
        """Return tr(Q M Qᵀ N), as `Matrix.trace_with`."""
        return self.own.trace_with(other) if isinstance(self.own, RoundTensor) else self.dense.trace_with(other)

    @property
    def is_zero(self) -> bool:
        """Whether all elements are known to be 0."""
        return self.own.is_zero

    @property
    def trace(self) -> Scalar:
        """The trace, which no rotation changes."""
        return self.own.trace

    @property
    def tangent_determinant(self) -> Scalar:
        """The determinant across n, which no rotation changes."""
        return self.own.tangent_determinant

    @property
    def dense(self) -> Matrix:
        """The matrix with its elements, of which six are worked out; a zero stays one."""
        if self.own.is_zero:
            return self.own
        a, b, c = self.turn.rows
        p, q, r = (self.own @ row for row in self.turn.rows)
        ab, ac, bc = a.dot(q), a.dot(r), b.dot(r)
        return Matrix(Vector(a.dot(p), ab, ac), Vector(ab, b.dot(q), bc), Vector(ac, bc, c.dot(r)))

    @property
    def rows(self) -> tuple[Vector, Vector, Vector]:
        """The three rows."""
        return self.dense.rows


def point_inertia(mass: Scalar, offset: Vector) -> Matrix:
    """Return m(ρ² 1 − ρ ρᵀ), the inertia of a point mass about a point at distance ρ.

    Written without ρ² − ρ_i², so that nothing is lost for an offset along an axis.

    Examples
    --------
    >>> point_inertia(2.0, Vector(0.0, 0.0, 3.0)).c.z
    0.0
    """
    x, y, z = offset
    return mass * Matrix(
        Vector(y * y + z * z, -(x * y), -(x * z)),
        Vector(-(y * x), z * z + x * x, -(y * z)),
        Vector(-(z * x), -(z * y), x * x + y * y),
    )


@frozen_record()
class RoundInertia:
    """J 1 + m(ρ² 1 − ρ ρᵀ): of a body with the same moment J about every axis, about a point at −ρ from its centre.

    Examples
    --------
    >>> RoundInertia(2.0, 1.0, Vector(0.0, 0.0, 1.0)).solve(Vector(3.0, 0.0, 2.0))
    Vector(x=1.0, y=0.0, z=1.0)
    """

    moment: Scalar
    mass: Scalar
    offset: Vector

    def solve(self, v: Vector, lever: Vector = ZERO) -> Vector:
        """Return x with (this matrix) x = v + l, l across ρ: (v + ρ m(ρ·v)/J + l)/(J + mρ²)."""
        rho = self.offset
        whole = v + rho * (rho.dot(v) * (self.mass / self.moment)) + lever
        return whole / (self.moment + self.mass * rho.dot(rho))


def inertia_about(J: Matrix, mass: Scalar, offset: Vector) -> DefiniteMatrix | RoundInertia:
    """Return J + m(ρ² 1 − ρ ρᵀ), ready to be solved.

    Examples
    --------
    >>> inertia_about(Matrix.diagonal(1.0, 2.0, 2.0), 1.0, Vector(0.0, 0.0, 1.0)).a.x
    2.0
    """
    if J.a.x is J.b.y is J.c.z and all(map(is_zero, (J.a.y, J.a.z, J.b.x, J.b.z, J.c.x, J.c.y))):
        return RoundInertia(J.a.x, mass, offset)
    return DefiniteMatrix(*(J + point_inertia(mass, offset)).rows)


@frozen_record()
class Quaternion:
    """A unit quaternion w + x i + y j + z k that takes body components to components in the support frame.

    Examples
    --------
    >>> quarter = 0.5**0.5
    >>> turn_about_z = Quaternion(quarter, 0.0, 0.0, quarter)
    >>> round((turn_about_z.matrix() @ Vector(1.0, 0.0, 0.0)).y, 12)
    1.0
    """

    w: Scalar
    x: Scalar
    y: Scalar
    z: Scalar

    def __iter__(self) -> Any:
        return iter((self.w, self.x, self.y, self.z))

    @staticmethod
    def of(components: Any) -> Quaternion:
        """Take four components (w, x, y, z) from a sequence, or from the last axis of an array."""
        if hasattr(components, "__array_namespace__"):
            return Quaternion(*(components[..., i] for i in range(4)))
        w, x, y, z = components
        return Quaternion(w, x, y, z)

    @staticmethod
    def of_matrix(Q: Matrix) -> Quaternion:
        """Return the unit quaternion of a rotation matrix of numbers, w not negative.

        Parameters
        ----------
        Q : Matrix
            Orthogonal, determinant 1.

        Returns
        -------
        Quaternion
            By way of its largest component, so that no digits are lost near half a turn (Shepperd 1978).

        Examples
        --------
        >>> Quaternion.of_matrix(Matrix(E_Y, E_Z, E_X))
        Quaternion(w=0.5, x=-0.5, y=-0.5, z=-0.5)
        """
        (a, b, c), (d, e, f), (g, h, i) = (tuple(row) for row in Q.rows)
        # Row j of 4 q qᵀ is 4 q_j q.
        rows = (
            (1.0 + a + e + i, h - f, c - g, d - b),
            (h - f, 1.0 + a - e - i, b + d, c + g),
            (c - g, b + d, 1.0 - a + e - i, f + h),
            (d - b, c + g, f + h, 1.0 - a - e + i),
        )
        j = max(range(4), key=lambda j: rows[j][j])
        length = namespace(*rows[j]).sqrt(sum(part * part for part in rows[j]))
        sign = -1.0 if rows[j][0] < 0 else 1.0
        return Quaternion(*(sign * part / length + 0.0 for part in rows[j]))

    def __mul__(self, other: Quaternion) -> Quaternion:
        a, b, c, d = self
        w, x, y, z = other
        return Quaternion(
            a * w - b * x - c * y - d * z,
            a * x + b * w + c * z - d * y,
            a * y - b * z + c * w + d * x,
            a * z + b * y - c * x + d * w,
        )

    @property
    def unit(self) -> Quaternion:
        """The same turned to length 1."""
        known = all(map(is_number, self))
        length = math.hypot(*self) if known else namespace(*self).sqrt(sum(part * part for part in self))
        return Quaternion(self.w / length, self.x / length, self.y / length, self.z / length)

    @property
    def conjugate(self) -> Quaternion:
        """The inverse rotation."""
        return Quaternion(self.w, -self.x, -self.y, -self.z)

    def rate(self, angular_velocity: Vector) -> Quaternion:
        """Return q̇ = ½ Ω q for an angular velocity Ω in the support frame."""
        turned = Quaternion(0.0, *angular_velocity) * self
        return Quaternion(0.5 * turned.w, 0.5 * turned.x, 0.5 * turned.y, 0.5 * turned.z)

    def matrix(self) -> Matrix:
        """Return the rotation matrix Q (body to support frame); for a unit quaternion it is orthogonal."""
        w, x, y, z = self
        return Matrix(
            Vector(1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)),
            Vector(2.0 * (x * y + w * z), 1.0 - 2.0 * (z * z + x * x), 2.0 * (y * z - w * x)),
            Vector(2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)),
        )

    def array(self) -> Any:
        """Return a NumPy array whose last axis holds (w, x, y, z)."""
        return _side_by_side(self.w, self.x, self.y, self.z)


def _side_by_side(*components: Scalar) -> Any:
    """Return one array of floats with the components along its last axis: `np.stack`, at a fifth of its price."""
    import numpy as np

    joined = np.empty((*np.broadcast(*components).shape, len(components)))
    for i, component in enumerate(components):
        joined[..., i] = component
    return joined
