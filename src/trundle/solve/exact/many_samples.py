"""Many samples of T5, fast: on an even grid by matrix products, anywhere by compiled code."""

from __future__ import annotations

from dataclasses import astuple
from typing import Any

from ...errors import OutOfDomainError
from ...mechanics.scalars import is_number, leaves

_BLOCK, _BLOCKS_AT_ONCE = 2048, 16  # samples: a block's table stays in the processor's cache


class ManySamples:
    """What `SphereOnPlane` can do with very many times."""

    def path_on_grid(self: Any, step: float, count: int, out: Any = None) -> Any:
        """Return the path of this one ball at 0, h, 2h, ...: the fastest way to many samples.

        The motion starts anew every few thousand samples from T5, and inside such a block it is the same linear
        function of the block's start, ζ_b + τφ₁(λτ) ζ̇_b + τ²φ₂(λτ) φ: one matrix product for all blocks.

        Examples
        --------
        >>> from trundle.solve.exact import SphereOnPlane
        >>> SphereOnPlane(0.025, 0.065, 0.4, 3.5, (0.1, 0.0), (0.0, 0.2)).path_on_grid(0.01, 3).shape
        (2, 3)
        """
        import numpy as np

        blocks = -(-count // _BLOCK)
        if out is None:
            out = np.empty((2, blocks * _BLOCK))
        position, velocity, _, _ = self.motion_at(np.arange(blocks) * (_BLOCK * step))
        _, gain, push = self._terms(np.arange(_BLOCK) * step)
        pushed = push * self.phi
        start, table = np.empty((2, blocks, 4)), np.empty((2, 4, _BLOCK))
        for row, parts in zip(
            start, ((position.x, velocity.x, -velocity.y), (position.y, velocity.y, velocity.x)), strict=True
        ):
            row.T[:] = np.broadcast_arrays(*parts, np.ones(blocks))
        for row, part in zip(table, (pushed.re, pushed.im), strict=True):
            row[:] = np.broadcast_arrays(np.ones(_BLOCK), gain.re, gain.im, part)
        shaped = out.reshape(2, blocks, _BLOCK)
        for first in range(0, blocks, _BLOCKS_AT_ONCE):  # what is written stays in the cache until it is done
            part = slice(first, first + _BLOCKS_AT_ONCE)
            np.matmul(start[:, part], table, out=shaped[:, part])
        return out[:, :count]

    def compiled(self: Any) -> Any:
        """Compile the path ζ(t) of this one ball to machine code with heyoka.

        Examples
        --------
        >>> import numpy as np
        >>> from trundle.solve.exact import SphereOnPlane
        >>> path = SphereOnPlane(0.025, 0.065, 0.4, 3.5, (0.1, 0.0), (0.0, 0.2)).compiled()
        >>> path(np.zeros((1, 2)))
        array([[0.1, 0.1],
               [0. , 0. ]])
        """
        import heyoka

        if not all(is_number(value) for value in leaves(astuple(self))):
            raise OutOfDomainError("The compiled path is of one ball: its parameters must be numbers, not arrays.")
        t = heyoka.make_vars("t")
        x, y, _ = self.position_at(t)
        return heyoka.cfunc([heyoka.expression(part) if is_number(part) else part for part in (x, y)], [t])
