"""Members on an accelerator: DOP853 in steps of one length, by JAX, with an error for each from half as many steps."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidValueError
from ...extras import need
from ...mechanics.parameters import numbers
from ...mechanics.system import RollingSystem
from ...solve.compiled_steps import tables
from ...solve.ensemble import Block, Piece, completed
from ...solve.laws import RollingLaw

Array = NDArray[np.float64]

ERROR = 1e-9  # largest share at which a member is kept
_GOAL = 1e-11  # of the members that are looked at first
_PILOT, _MOST_STEPS = 64, 2**16  # of these, and in an interval between two instants
_AT_ONCE = 2**24  # numbers that a call gives back
_ORDER_LEFT = 2.0**7  # by so much a step of half the length is better, at least: the order is 8
_MANY = 0.9  # share of the members for which steps have to be short enough
_CONVERGES = 2.0**5  # by less than this, and it is not yet seen to be
_ROUNDING = 1e-15  # of each step


def check_device(device: Any) -> Any:
    """Return the device of a platform that JAX finds here."""
    need("jax", "simulate_many(device=...)", "Without `device` heyoka does it on the processor.")
    import jax

    try:
        return jax.devices(device or "none")[0]
    except (RuntimeError, TypeError, AttributeError):
        found = " or ".join(sorted({repr(each.platform) for each in jax.devices()} | {"'cpu'"}))
        raise InvalidValueError("device", "must be a platform that JAX finds here", device, f"Give {found}.") from None


@dataclass(frozen=True)
class OnDevice:
    """Many members of systems of one structure on a device."""

    systems: Sequence[RollingSystem]  # all of them
    states: Array  # (all, size): as `ensemble.rolling_from` gives them
    times: Array  # (n,): ascending, s, the first that of the starts
    device: Any  # where

    def follow(self, members: Sequence[int], done: Callable[[Block], None]) -> tuple[list[int], Array]:
        """Follow members that roll, for as long as they do.

        Parameters
        ----------
        members : sequence of int
            Which.
        done : callable
            Given each block as it is done.

        Returns
        -------
        left : list of int
            Members that came to an event, or whose error is too large.
        errors : array (members,)
            Of each, as a share of the largest of its kind.
        """
        steps = self._steps(members)
        most = max(1, _AT_ONCE // (self.times.size * self.states.shape[1]))
        left: list[int] = []
        errors = []
        for first in range(0, len(members), most):
            some = list(members[first : first + most])
            filled = some + some[-1:] * (min(most, len(members)) - len(some))  # of one size, so as to compile once
            path, lowest = self._course(filled, steps)
            apart = _apart(path, self._course(filled, steps // 2)[0])[: len(some)]
            error = apart / _ORDER_LEFT + _ROUNDING * steps * self.times.size
            good = (error <= ERROR) & (lowest[: len(some)] > 0)
            left += [member for member, sound in zip(some, good.tolist(), strict=True) if not sound]
            kept = [member for member, sound in zip(some, good.tolist(), strict=True) if sound]
            if kept:
                states = path[:, : len(some)][:, good].swapaxes(1, 2)
                piece = Piece(kept, 0, states)
                done(completed(RollingLaw(), self.systems, self.times, [piece]))
            errors.append(error)
        return left, np.concatenate(errors)

    def _steps(self, members: Sequence[int]) -> int:
        """Return how many steps in each interval make the error small, by some of the members; an even number."""
        some = list(members[:: max(1, len(members) // _PILOT)])
        steps, coarse, before = 2, self._course(some, 1)[0], np.full(len(some), np.inf)
        while steps < _MOST_STEPS:
            fine, lowest = self._course(some, steps)
            apart = _apart(fine, coarse)
            well = (apart / _ORDER_LEFT <= _GOAL) & ((apart * _CONVERGES <= before) | (apart <= _GOAL))
            if (well | ~(lowest > 0)).mean() >= _MANY:
                return steps
            steps, coarse, before = 2 * steps, fine, apart
        return steps

    def _course(self, members: Sequence[int], steps: int) -> tuple[Array, Array]:
        """Return the states (times, members, size), and the lowest that any event function came to, in each step."""
        import jax

        with jax.enable_x64(True), jax.default_device(self.device):
            given = np.array([numbers(self.systems[i]) for i in members])
            path, lowest = self._compiled(
                self.states[list(members)], given, self.times[:-1], np.diff(self.times), steps
            )
            return np.concatenate([self.states[None, list(members)], np.asarray(path)]), np.asarray(lowest)

    @cached_property
    def _compiled(self) -> Any:
        """The function (states, numbers, when intervals begin, how long they are, steps in each) of JAX."""
        import jax
        import jax.numpy as jnp

        field = self.systems[0].vector_field("jax")
        a, c, *_ = tables()
        A, C, u = a[:13, :12], c[:13], field.inputs
        event_functions = field.events if field.event_names else None

        def step(t: Any, h: Any, y: Any, p: Any) -> Any:
            def stage(i: Any, k: Any) -> Any:
                return k.at[i].set(field.rates(t + jnp.asarray(C)[i] * h, y + h * (jnp.asarray(A)[i] @ k), p, u))

            k = jax.lax.fori_loop(0, 12, stage, jnp.zeros((12, y.size)))
            new = y + h * (jnp.asarray(A)[12] @ k)
            q = new[3:7]
            return new.at[3:7].set(q / jnp.sqrt(q @ q))

        def course(y0: Any, p: Any, begins: Any, lengths: Any, steps: Any) -> Any:
            def interval(carried: Any, when: Any) -> Any:
                begin, h = when[0], when[1] / steps

                def one(i: Any, at: Any) -> Any:
                    y, low = at
                    t = begin + i * h
                    y = step(t, h, y, p)
                    if event_functions is not None:
                        low = jnp.minimum(low, jnp.min(event_functions(t + h, y, p, u)))
                    return y, low

                carried = jax.lax.fori_loop(0, steps, one, carried)
                return carried, carried[0]

            (_, low), path = jax.lax.scan(interval, (y0, jnp.asarray(jnp.inf)), jnp.stack([begins, lengths], axis=1))
            return path, low

        return jax.jit(jax.vmap(course, in_axes=(0, 0, None, None, None), out_axes=(1, 0)))


def _apart(one: Array, other: Array) -> Array:
    """Return how far each member's states (times, members, size) are apart, as a share of the largest of a kind."""
    found = np.zeros(one.shape[1])
    for part in (slice(0, 3), slice(3, 7), slice(7, 10), slice(10, None)):
        size = np.abs(one[:, :, part]).max(axis=(0, 2), initial=1e-300)
        found = np.maximum(found, np.abs(one[:, :, part] - other[:, :, part]).max(axis=(0, 2), initial=0.0) / size)
    return np.where(np.isnan(found), np.inf, found)
