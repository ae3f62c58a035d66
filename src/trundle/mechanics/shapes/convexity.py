"""Is a support function that of a smooth convex body? Looked at in many directions, and closer where it looks worst."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ...errors import InvalidValueError
from ..algebra import Vector
from ..jets import Jet

Array = Any  # NumPy's

KEY = "support_function"
_LARGEST = 1e30  # in SI, as everywhere; squares of it are still finite
_ROUNDING = 1e-9  # share of the size that a radius of curvature may seem negative by
_FLATTEST = 1e6  # times the size: a larger radius of curvature is that of a flat face
_JUMP = 1e-6  # share of the size that X(ν) must not jump by
_LATITUDES, _LONGITUDES = 40, 80
_CIRCLES, _STEPS = 24, 256
_CLOSER, _HALVINGS = 20, 30


def check_convex(h: Callable[[Vector], Jet], text: str) -> None:
    """Refuse a support function that is not finite, or not that of a smooth convex body, naming a direction.

    Examples
    --------
    >>> from trundle.mechanics.shapes import SupportFunction
    >>> SupportFunction("0.1 + 0.2*nu_x**2*nu_y**2")
    Traceback (most recent call last):
    ...
    trundle.errors.InvalidValueError: `support_function` must be that of a convex body: ... at nu = ...
    """
    look = _Look(h, text)
    nu = _directions()
    size = look.size(nu)
    least, most = look.radii(nu)
    if size <= 1e-12 * look.furthest(nu):
        raise InvalidValueError(KEY, "must be that of a body", text, "This one is a point: it has no size.")
    at, worst = _closer(nu, least, lambda nu: look.radii(nu)[0])
    if worst < -_ROUNDING * size:
        remedy = f"Here it is {worst:.3g} m at nu = {_shown(at)}. Add a constant, which rounds the body off."
        rule = "must be that of a convex body: no radius of curvature, an eigenvalue of its second derivatives, below 0"
        raise InvalidValueError(KEY, rule, text, remedy)
    at, worst = _closer(nu, -most, lambda nu: -look.radii(nu)[1])
    if -worst > _FLATTEST * size:
        raise _flat(text, at)
    look.check_jumps(size)


class _Look:
    """A support function, looked at in whole arrays of directions."""

    def __init__(self, h: Callable[[Vector], Jet], text: str) -> None:
        self.h, self.text = h, text

    def derivatives(self, nu: Array) -> tuple[Array, Array]:
        """Return ∇h, (n, 3), and ∇∇h, (n, 6); refuse what is not finite."""
        import numpy as np

        try:
            with np.errstate(all="ignore"):
                found = self.h(Vector(*nu.T))
                parts = np.broadcast_arrays(nu[:, 0], found.value, *found.gradient, *found.hessian)
        except (ArithmeticError, ValueError):
            raise InvalidValueError(KEY, "must be finite", str(self.text), "It divides by zero.") from None
        all_parts = np.stack(parts[1:], axis=-1)
        bad = ~(np.abs(all_parts) < _LARGEST).all(axis=-1)  # a NaN is none of them
        if bad.any():
            where = _shown(nu[np.argmax(bad)])
            rule = "must be finite and smooth in every direction, with its first and second derivatives"
            raise InvalidValueError(KEY, rule, str(self.text), f"It is not at nu = {where}.")
        return all_parts[:, 1:4], all_parts[:, 4:]

    def furthest(self, nu: Array) -> float:
        """Return the largest distance of the surface from the origin."""
        import numpy as np

        return float(np.linalg.norm(self.derivatives(nu)[0], axis=-1).max())

    def size(self, nu: Array) -> float:
        """Return the largest extent of the body."""
        import numpy as np

        points = self.derivatives(nu)[0]
        return float(np.linalg.norm(points - points.mean(axis=0), axis=-1).max())

    def radii(self, nu: Array) -> tuple[Array, Array]:
        """Return the two radii of curvature: the eigenvalues of ∇∇h besides the 0 along ν."""
        import numpy as np

        xx, xy, xz, yy, yz, zz = self.derivatives(nu)[1].T
        mean = 0.5 * (xx + yy + zz)
        product = (xx * yy - xy * xy) + (yy * zz - yz * yz) + (zz * xx - xz * xz)
        apart = np.sqrt(np.maximum(mean * mean - product, 0.0))
        return mean - apart, mean + apart

    def check_jumps(self, size: float) -> None:
        """Refuse an X(ν) that jumps: along great circles it must change as its derivative says."""
        import numpy as np

        draw = np.random.default_rng(1)
        e, f = np.linalg.qr(draw.normal(size=(_CIRCLES, 3, 2)))[0].transpose(2, 0, 1)
        e, f = (np.repeat(v, _STEPS, axis=0) for v in (e, f))
        first = np.tile(np.arange(_STEPS) * (2 * np.pi / _STEPS), _CIRCLES)
        last = first + 2 * np.pi / _STEPS
        jumps = self._jump(e, f, first, last)
        if jumps.max() <= _JUMP * size:
            return
        worst = np.argsort(-jumps)[:_CLOSER]
        e, f, first, last = e[worst], f[worst], first[worst], last[worst]
        for _ in range(_HALVINGS):
            middle = 0.5 * (first + last)
            before = self._jump(e, f, first, middle) > self._jump(e, f, middle, last)
            first, last = np.where(before, first, middle), np.where(before, middle, last)
        ends = [self.derivatives(_along(e, f, angle)[0])[0] for angle in (first, last)]
        gap = np.linalg.norm(ends[1] - ends[0], axis=-1)
        if gap.max() > _JUMP * size:
            at = int(np.argmax(gap))
            raise _flat(str(self.text), _along(e, f, first)[0][at])

    def _jump(self, e: Array, f: Array, first: Array, last: Array) -> Array:
        """Return by how much X(ν) changes over an arc besides what Simpson's rule makes of its derivative."""
        import numpy as np

        change, rate = np.zeros(3)[:, None], np.zeros(3)[:, None]
        for angle, weight, sign in ((first, 1, -1), (0.5 * (first + last), 4, 0), (last, 1, 1)):
            nu, along = _along(e, f, angle)
            X, (xx, xy, xz, yy, yz, zz) = (part.T for part in self.derivatives(nu))
            tx, ty, tz = along.T
            turned = np.stack([xx * tx + xy * ty + xz * tz, xy * tx + yy * ty + yz * tz, xz * tx + yz * ty + zz * tz])
            change, rate = change + sign * X, rate + weight * turned
        return np.linalg.norm(change - rate * ((last - first) / 6), axis=0)


def looks_the_same_all_round(h: Callable[[Vector], Any]) -> bool:
    """Tell whether h changes with a turn about the third axis by no more than rounding.

    Examples
    --------
    >>> looks_the_same_all_round(lambda nu: nu.x**2 + nu.y**2), looks_the_same_all_round(lambda nu: nu.x**2)
    (True, False)
    """
    import numpy as np

    height = np.linspace(-0.97, 0.97, 23)[:, None]
    angle = np.linspace(0.1, 6.2, 29)[None, :]
    across = np.sqrt(1 - height * height)
    nu = (across * np.cos(angle), across * np.sin(angle), height + 0.0 * angle)
    values = np.broadcast_to(h(Vector(*nu)), nu[0].shape)
    return bool(np.ptp(values, axis=1).max() <= 1e-14 * np.abs(values).max())


def _directions() -> Array:
    """Return directions all over the sphere, among them those where formulas are most often singular."""
    import numpy as np

    height = np.cos((np.arange(_LATITUDES) + 0.5) * (np.pi / _LATITUDES))
    angle = (np.arange(_LONGITUDES) + 0.25) * (2 * np.pi / _LONGITUDES)
    z, phi = (part.ravel() for part in np.meshgrid(height, angle, indexing="ij"))
    across = np.sqrt(1 - z * z)
    grid = np.stack([across * np.cos(phi), across * np.sin(phi), z], axis=-1)
    corners = np.array([v for v in np.ndindex(3, 3, 3) if v != (1, 1, 1)]) - 1.0
    return np.concatenate([corners / np.linalg.norm(corners, axis=-1, keepdims=True), grid])


def _closer(nu: Array, values: Array, function: Callable[[Array], Array]) -> tuple[Array, float]:
    """Return where a function of the direction is least, and its value, by ever closer looks around the least few."""
    import numpy as np

    best, least = nu[np.argsort(values)[:4]], np.sort(values)[:4]
    reach = np.pi / _LATITUDES
    offsets = np.stack([part.ravel() for part in np.meshgrid(*[np.linspace(-1, 1, 5)] * 3)], axis=-1)
    for _ in range(_CLOSER):
        around = best[:, None, :] + reach * offsets
        around /= np.linalg.norm(around, axis=-1, keepdims=True)
        found = function(around.reshape(-1, 3)).reshape(around.shape[:2])
        chosen = np.argmin(found, axis=1)
        lower = found.min(axis=1) < least
        best = np.where(lower[:, None], around[np.arange(len(best)), chosen], best)
        least, reach = np.minimum(least, found.min(axis=1)), 0.5 * reach
    return best[np.argmin(least)], float(least.min())


def _along(e: Array, f: Array, angle: Array) -> tuple[Array, Array]:
    import numpy as np

    c, s = np.cos(angle)[:, None], np.sin(angle)[:, None]
    return e * c + f * s, f * c - e * s


def _flat(text: str, at: Array) -> InvalidValueError:
    remedy = f"This one has one at nu = {_shown(at)}; a body that touches along a line or a face is not covered."
    return InvalidValueError(KEY, "must be that of a body without a flat face or a straight edge", str(text), remedy)


def _shown(nu: Array) -> str:
    return "(" + ", ".join(f"{float(part) + 0.0:.4g}" for part in nu) + ")"
