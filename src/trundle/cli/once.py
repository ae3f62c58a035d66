"""An option that takes one value is given once: of two, one would be lost without a word."""

from __future__ import annotations

from typing import Any

from typer.core import TyperCommand

from ..errors import InvalidValueError


class Once(TyperCommand):
    """A command that refuses a second value of an option which takes one; a switch may be thrown twice."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Read what was typed."""
        order: list[Any] = self.make_parser(ctx).parse_args(args=list(args))[2]
        for option in order:
            single = option.param_type_name == "option" and not (option.multiple or option.is_flag or option.count)
            if single and order.count(option) > 1:
                name = max(option.opts, key=len)
                raise InvalidValueError(name, "must be given once", f"{order.count(option)} values", "Keep one.")
        return super().parse_args(ctx, args)
