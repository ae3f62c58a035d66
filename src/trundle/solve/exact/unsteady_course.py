"""How T9's sphere goes on from piece to piece of time: the quadratures of a motion under a rate and loads in time."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ...errors import OutOfDomainError, SolverError
from ..patience import Patience
from .quadrature import rule, series_at

_LONGEST = 0.5  # s, of a piece: what a rate or a load does within a fiftieth of it would not be seen
_MOST_PHASE = 1.0  # rad of κ and e-folds of drag on a piece
_SHARE, _SHORTEST = 4e-15, 1e-13  # left by the last coefficients; of a piece where the rate or a load has a kink
_NOTHING = 1e-300  # in SI: smaller floats have fewer digits
# Ten seconds and one; then Taylor's method is quicker.
_PATIENCE: dict[str, Any] = {"steps": 2e4, "spare": 3e3, "name": "The quadrature of T9", "error": OutOfDomainError}
_AT_ONCE = 8  # pieces
_MOST_KNOWN, _MOST_KINKS = 1000, 200


class Course:
    """ζ and ζ̇ piece by piece, from ζ_j and V_j at the start of each, so that strong drag costs no digits.

    ζ = ζ_j + ξ with ξ = e^Λ ∫e^−Λ N dt, ζ̇ = λξ + N, N = V_j + i(κ − κ_j)ζ_j + ∫φ dt, Λ = ∫λ dt and λ = iκ − γ.
    """

    def __init__(self, form: Any) -> None:
        self.form, self.edges, self.length = form, [0.0], min(_LONGEST, _start_length(form))
        self.zeta, self.velocity = [complex(*form.position)], [complex(*form.velocity)]
        self.rate = [float(form.rates(0.0)[0])]
        self.turned, self.swept, self.kinks = [0.0], [0.0], 0
        self.series: list[Any] = []  # of ∫ω and ∫K_z, of ∫e^−Λ N and ∫φ
        self.stacked: Any = None

    def reach(self, t: Any) -> None:
        """Work out the pieces up to the last of the times."""
        last = float(np.max(t, initial=0.0))
        if self.edges[-1] <= last:
            self._extend(last)

    def at(self, t: Any, omega: Any) -> tuple[Any, Any, Any]:
        """Return ζ, ζ̇ and ∫K_z dt; ω is the plane's rate then."""
        t, form = np.asarray(t, dtype=float), self.form
        edges, real, plane, real0, plane0, zeta, velocity, rate, turned = self._arrays()
        j, x = self._place(t)
        (angle, couple), (weighted, push) = series_at(real, j, x) - real0[:, j], series_at(plane, j, x) - plane0[:, j]
        gone = np.exp(1j * form.share * angle - form.gamma * (t - edges[j])) * weighted
        driven = velocity[j] + 1j * form.share * (omega - rate[j]) * zeta[j] + push
        return zeta[j] + gone, (1j * form.share * omega - form.gamma) * gone + driven, turned[j] + couple

    def swept_at(self, t: Any) -> Any:
        """Return ∫ω dt, rad."""
        real, real0 = self._arrays()[1], self._arrays()[3]
        j, x = self._place(np.asarray(t, dtype=float))
        return np.array(self.swept)[j] + (series_at(real, j, x) - real0[:, j])[0]

    def _arrays(self) -> Any:
        if self.stacked is None:
            series = [np.stack(part, axis=-1) for part in zip(*self.series, strict=True)]
            begins = [series_at(part, np.arange(part.shape[2]), -1.0) for part in series]  # 0 but for rounding
            states = [np.array(part) for part in (self.zeta, self.velocity, self.rate, self.turned)]
            self.stacked = np.array(self.edges), *series, *begins, *states
        return self.stacked

    def _place(self, t: Any) -> tuple[Any, Any]:
        """Return the piece of each time, and the place in it from −1 to 1."""
        edges = self._arrays()[0]
        j = np.clip(np.searchsorted(edges, t, side="right") - 1, 0, len(edges) - 2)
        return j, 2 * (t - edges[j]) / (edges[j + 1] - edges[j]) - 1

    def _extend(self, end: float) -> None:
        self.stacked = None
        start = self.form.start_time
        patience = Patience(start + self.edges[-1], start + end, **_PATIENCE)
        while self.edges[-1] <= end:
            self.length = min(_LONGEST, 2 * self.length)
            while not (added := self._add(end)):
                self.length /= 2
            patience.after(added, start + self.edges[-1])

    def _given(self, begins: Any) -> tuple[Any, Any, Any, Any, Any]:
        """Return the points of pieces, and there ω, φ and K_z; and ω at their ends."""
        share = np.append(0.5 * (1 + rule().points), 1.0)
        times = begins[:, None] + self.length * share
        with np.errstate(all="ignore"):  # what is not finite is refused by name
            found = (self.form.rates(times.ravel())[0], *self.form.pushes(times.ravel())[2:])
        omega, push, couple = (np.broadcast_to(part, times.size).reshape(times.shape) for part in found)
        return times[:, :-1], omega[:, :-1], push[:, :-1], couple[:, :-1], omega[:, -1]

    def _add(self, end: float) -> int:
        """Add some pieces, together since each step costs as much for one; return how many, 0 where they are too long.

        None is added behind one that is too long for its polynomials, or where something is not finite.
        """
        form, this, half = self.form, rule(), 0.5 * self.length
        begins = [self.edges[-1]]
        while len(begins) < _AT_ONCE and begins[-1] + self.length <= end:
            begins.append(begins[-1] + self.length)
        given = self._given(np.array(begins))
        finite = np.logical_and.reduce([np.isfinite(part).reshape(len(begins), -1).all(axis=1) for part in given])
        if not finite[0]:
            times, *values, rate = (part[0] for part in given)
            if begins[0] + self.length > end and not (math.isfinite(rate) and _finite(times, end, *values)):
                return 0  # a pole just behind the run is none in it
            _check_finite(form.start_time + times, *values)
        largest = np.abs(given[1]).max(axis=1)
        slow = half * (form.gamma + form.share * largest) <= _MOST_PHASE
        kinked = self.length <= _SHORTEST * max(1.0, begins[0])
        if not slow[0]:
            if kinked:
                raise SolverError(
                    f"The plane's rate grows beyond any bound at t = {form.start_time + begins[0]:.6g} s."
                )
            return 0
        count = _leading(finite & slow) or 1
        times, omega, push, couple, rates = (part[:count] for part in given)
        before = np.append(self.rate[-1], rates[:-1])
        decay = np.exp(form.gamma * half * (1 + this.points) - 1j * form.share * half * (omega @ this.running.T))
        carried, pushed = 1j * form.share * (omega - before[:, None]), half * (push @ this.running.T)
        angle, turned, driven = (half * (part @ this.total) for part in (omega, couple, push))
        weighted, zeta, velocity = [], self.zeta[-1:], self.velocity[-1:]
        for j in range(count):
            weighted.append(decay[j] * (velocity[j] + carried[j] * zeta[j] + pushed[j]))
            gone = np.exp(1j * form.share * angle[j] - 2 * form.gamma * half) * (half * (this.total @ weighted[j]))
            gained = 1j * form.share * (rates[j] - before[j]) * zeta[j] + driven[j]
            velocity.append(complex((1j * form.share * rates[j] - form.gamma) * gone + velocity[j] + gained))
            zeta.append(complex(zeta[j] + gone))
        four = np.stack([omega, couple, np.array(weighted), push], axis=1)
        tail, size = np.abs(four @ this.coefficients[-2:].T).max(axis=2), np.abs(four).max(axis=2)
        size[:, 0] = np.maximum(size[:, 0], 1 / (form.share * half + 1e-300))
        size[:, 3] += size[:, 2] / half
        slope = np.abs(np.diff(four) / np.diff(times)[:, None]).max(axis=2)
        noise = 2e-15 * (abs(form.start_time) + times[:, :1] + self.length) * slope  # from rounding of the time itself
        noise[:, 2] += 1e-15 * form.share * largest[:count] * np.abs(zeta[:-1])  # from what is carried, a difference
        smooth = ~(tail > _SHARE * size + noise + _NOTHING).any(axis=1)
        if not smooth[0]:
            if not kinked:
                return 0
            self.kinks += 1
            if self.kinks > _MOST_KINKS:
                raise SolverError(
                    "The plane's rate, or a load, is not smooth enough for quadrature near "
                    f't = {form.start_time + begins[0]:.6g} s. Use method="taylor" or method="runge-kutta".'
                )
        count = _leading(smooth) or 1
        series = half * (this.antiderivative @ four[:count].swapaxes(1, 2))
        self.series += [(each[:, :2].real, each[:, 2:]) for each in series]
        self.zeta += zeta[1 : count + 1]
        self.velocity += velocity[1 : count + 1]
        self.rate += rates[:count].tolist()
        self.swept += (self.swept[-1] + np.cumsum(angle[:count])).tolist()
        self.turned += (self.turned[-1] + np.cumsum(turned[:count])).tolist()
        self.edges += [*begins[1:count], begins[count - 1] + self.length]
        return count


def _leading(good: Any) -> int:
    """Count those at the beginning that are good."""
    return int(good.size if good.all() else good.argmin())


class PreciseCourse:
    """The same with mpmath's numbers, on even pieces and by T9 as it stands: ζ = e^Λ (ζ_j + ∫e^−Λ M dt)."""

    def __init__(self, form: Any) -> None:
        self.form, self.digits, self.length = form, 0, min(0.25, _start_length(form))
        self.states: list[Any] = []
        self.known: dict[Any, tuple[Any, Any, Any]] = {}

    def reach(self, t: Any) -> None:
        """Pieces are worked out as they are needed."""

    def at(self, t: Any, omega: Any) -> tuple[Any, Any, Any]:
        """Return ζ, ζ̇ and ∫K_z dt at t ≥ 0; ω is the plane's rate then."""
        import mpmath

        form = self.form
        if self.digits != mpmath.mp.dps or len(self.known) > _MOST_KNOWN:
            zeta, rate = mpmath.mpc(*form.position), form.rates(mpmath.mpf(0))[0]
            moment = mpmath.mpc(*form.velocity) - (1j * (self._share * rate) - self._gamma) * zeta
            self.digits, self.states, self.known = mpmath.mp.dps, [(zeta, moment, mpmath.mpf(0))], {}
        if t not in self.known:
            self.known[t] = self._at(t)
        zeta, moment, turned = self.known[t]
        return zeta, (1j * (self._share * omega) - self._gamma) * zeta + moment, turned

    def _at(self, t: Any) -> tuple[Any, Any, Any]:
        import mpmath

        length = mpmath.mpf(self.length)
        whole = max(0, int(mpmath.floor(t / length)))
        while len(self.states) <= whole:
            self.states.append(self._ahead(self.states[-1], (len(self.states) - 1) * length, length))
        return self._ahead(self.states[whole], whole * length, t - whole * length)

    @property
    def _share(self) -> Any:
        import mpmath

        k = mpmath.mpf(self.form.inertia_ratio)
        return k / (1 + k)

    @property
    def _gamma(self) -> Any:
        import mpmath

        return mpmath.mpf(self.form.drag) / (mpmath.mpf(self.form.mass) * (1 + mpmath.mpf(self.form.inertia_ratio)))

    def _ahead(self, state: tuple[Any, Any, Any], begin: Any, length: Any) -> tuple[Any, Any, Any]:
        import mpmath

        this, half, (zeta, moment, turned) = rule(self.digits), length / 2, state
        times = [begin + half * (1 + x) for x in this.points]
        omega = np.array([self.form.rates(t)[0] for t in times], dtype=object)
        pushes = [self.form.pushes(t) for t in times]
        push, couple = (np.array([row[i] for row in pushes], dtype=object) for i in (2, 3))
        exponent = self._gamma * half * (1 + this.points) - 1j * (self._share * half * (this.running @ omega))
        grown = np.frompyfunc(mpmath.exp, 1, 1)(exponent)
        weighted = grown * (moment + half * (this.running @ push))
        whole = 1j * (self._share * half * (this.total @ omega)) - self._gamma * length
        return (
            mpmath.exp(whole) * (zeta + half * (this.total @ weighted)),
            moment + half * (this.total @ push),
            turned + half * (this.total @ couple),
        )


def _start_length(form: Any) -> float:
    rate = form.motion.fastest_rate_within(form.start_time, form.start_time + _LONGEST)
    return 1.0 / max(float(rate) + float(form.gamma), 2.0)


def _finite(times: Any, end: float, *values: Any) -> bool:
    """Tell whether values are finite at all times of a piece, or not even before the end of the run."""
    wrong = ~np.logical_and.reduce([np.isfinite(value) for value in values])
    return not wrong.any() or bool(times[wrong].min() <= end)


def _check_finite(times: Any, *values: Any) -> None:
    for value, name in zip(values, ("the plane's rate", "a force or torque", "a torque"), strict=True):
        wrong = ~np.isfinite(value)
        if wrong.any():
            raise SolverError(f"{name[0].upper()}{name[1:]} is not finite at t = {times[wrong].min():.6g} s.")
