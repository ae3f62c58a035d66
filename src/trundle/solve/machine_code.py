"""What a tape holds as machine code, by LLVM: twenty times faster than the same text in Python.

It is the same to the last bit: each operation is one instruction, in the tape's order, and the functions are those of
the C library that Python asks, too.
"""

from __future__ import annotations

import ctypes
import struct
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from importlib.util import find_spec
from typing import Any

import numpy as np

from ..mechanics.surfaces.splines import Pieces
from .tape import Node, Tape

IN_HASTE, WITH_CARE = 0, 2  # LLVM's levels of optimisation
_MOST_WITH_CARE = 4000  # operations: with more of them care takes seconds, and the code is hardly faster
_FIRST = (16,)  # LLVM whose pointers have no types
_TWO = {"+": "fadd", "-": "fsub", "*": "fmul", "/": "fdiv", "<": "fcmp olt", ">": "fcmp ogt"}
_LIBRARY = {"sin": 1, "cos": 1, "tan": 1, "exp": 1, "expm1": 1, "log": 1, "atan2": 2}  # and how many operands each has
_INSTRUCTIONS = {"sqrt": "llvm.sqrt.f64", "abs": "llvm.fabs.f64"}
_HEAD = "\n".join(
    f"declare double @{name}({', '.join(['double'] * count)})"
    for name, count in (_LIBRARY | dict.fromkeys(_INSTRUCTIONS.values(), 1)).items()
)


@cache
def available() -> bool:
    """Tell whether LLVM is here, and finds the C library's functions.

    Examples
    --------
    >>> available() in (True, False)
    True
    """
    if find_spec("llvmlite") is None:
        return False
    from llvmlite import binding

    library = ctypes.CDLL("ucrtbase" if sys.platform == "win32" else None)
    if binding.llvm_version_info < _FIRST or not all(hasattr(library, name) for name in _LIBRARY):
        return False
    binding.initialize_native_target()
    binding.initialize_native_asmprinter()
    for name in _LIBRARY:
        binding.add_symbol(name, ctypes.cast(getattr(library, name), ctypes.c_void_p).value)
    return True


@dataclass(frozen=True)
class MachineCode:
    """A function of a tape's inputs, a sequence of floats, that gives a list of outputs.

    Parameters
    ----------
    address : int
        Of a C function that takes where the inputs lie, and where the outputs are to lie, doubles.
    inputs, outputs : int
        How many.
    kept : object
        What it lives in.

    Examples
    --------
    >>> tape = Tape()
    >>> x, y = tape.inputs(2)
    >>> machine_code(tape, [x * y + 1.0, x * y])([3.0, 2.0])
    [7.0, 6.0]
    """

    address: int
    inputs: int
    outputs: int
    kept: Any

    @cached_property
    def _called(self) -> tuple[Any, Any, Any]:
        function = ctypes.PYFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p)(self.address)
        return function, ctypes.c_double * self.inputs, ctypes.c_double * self.outputs

    def __call__(self, x: Sequence[float]) -> list[float]:
        """Return the outputs."""
        function, inputs, outputs = self._called
        found = outputs()
        function(inputs(*x), found)
        return found[:]


def machine_code(tape: Tape, outputs: Sequence[Any], level: int = IN_HASTE) -> MachineCode:
    """Return the function of a tape's inputs that gives some outputs.

    Examples
    --------
    >>> tape = Tape()
    >>> x, y = tape.inputs(2)
    >>> machine_code(tape, [x / y])([1.0, 0.0])
    [inf]
    """
    from llvmlite import binding

    available()
    needed = tape.needed(outputs)
    splines = [part for i in needed for part in tape.steps[i][1:] if isinstance(part, Pieces)]
    tables = {pieces: _Table(pieces) for pieces in dict.fromkeys(splines)}
    lines = [_HEAD, *([_SPLINE] if tables else []), "define void @law(ptr %x, ptr %out) {"]
    lines += [line for i in needed for line in _written(i, tape.steps[i], tables)]
    for i, part in enumerate(outputs):
        lines += [f"%o{i} = getelementptr double, ptr %out, i64 {i}", f"store double {_operand(part)}, ptr %o{i}"]
    module = binding.parse_assembly("\n".join([*lines, "ret void", "}"]))
    careful = level if len(needed) <= _MOST_WITH_CARE else IN_HASTE
    machine = binding.Target.from_default_triple().create_target_machine(opt=careful)
    engine = binding.create_mcjit_compiler(module, machine)
    engine.finalize_object()
    return MachineCode(engine.get_function_address("law"), tape.size, len(outputs), (engine, tables))


def _written(index: int, step: tuple[Any, ...], tables: dict[Pieces, _Table]) -> Iterator[str]:
    """Yield a step's instructions."""
    operation, *operands = step
    if operation == "input":
        yield f"%i{index} = getelementptr double, ptr %x, i64 {operands[0]}"
        yield f"%v{index} = load double, ptr %i{index}"
    elif operation in _TWO:
        yield f"%v{index} = {_TWO[operation]} double {', '.join(map(_operand, operands))}"
    elif operation == "neg":
        yield f"%v{index} = fneg double {_operand(operands[0])}"
    elif operation == "where":
        condition, *values = operands
        known = f"%v{condition.index}" if isinstance(condition, Node) else str(bool(condition)).lower()
        yield f"%v{index} = select i1 {known}, {', '.join(f'double {_operand(one)}' for one in values)}"
    elif operation == "spline":
        pieces, x, *y = operands
        yield f"%v{index} = call double @spline({tables[pieces].given}, {_given([x, *(y or [0.0])])})"
    else:
        yield f"%v{index} = call double @{_INSTRUCTIONS.get(operation, operation)}({_given(operands)})"


def _given(operands: Sequence[Any]) -> str:
    return ", ".join(f"double {_operand(one)}" for one in operands)


def _operand(part: Any) -> str:
    """Return a step's name, or a number by its bits."""
    return f"%v{part.index}" if isinstance(part, Node) else f"0x{struct.pack('>d', float(part)).hex()}"


class _Table:
    """The numbers of a spline's pieces, where machine code finds them."""

    def __init__(self, pieces: Pieces) -> None:
        terms = np.array(pieces.terms, dtype=float)
        self.arrays = np.array(pieces.x, dtype=float), np.array(pieces.y, dtype=float), terms
        places = [f"ptr inttoptr (i64 {one.ctypes.data} to ptr)" for one in self.arrays]
        self.given = ", ".join([*places, *(f"i64 {size}" for size in terms.shape)])


# `splines.evaluated`, in the same order.
_SPLINE = """
define double @spline(ptr %starts, ptr %others, ptr %terms, i64 %n, i64 %m, i64 %rows, i64 %columns, double %x,
    double %y) {
begin:
  %i = call i64 @piece(ptr %starts, i64 %n, double %x)
  %j = call i64 @piece(ptr %others, i64 %m, double %y)
  %at_i = getelementptr double, ptr %starts, i64 %i
  %at_j = getelementptr double, ptr %others, i64 %j
  %start = load double, ptr %at_i
  %other = load double, ptr %at_j
  %u = fsub double %x, %start
  %v = fsub double %y, %other
  %size = mul i64 %rows, %columns
  %row_of = mul i64 %i, %m
  %which = add i64 %row_of, %j
  %offset = mul i64 %which, %size
  %first = getelementptr double, ptr %terms, i64 %offset
  br label %row
row:
  %a = phi i64 [0, %begin], [%next_a, %summed]
  %value = phi double [0.0, %begin], [%next_value, %summed]
  %before = mul i64 %a, %columns
  br label %term
term:
  %b = phi i64 [0, %row], [%next_b, %term]
  %part = phi double [0.0, %row], [%next_part, %term]
  %place = add i64 %before, %b
  %at = getelementptr double, ptr %first, i64 %place
  %coefficient = load double, ptr %at
  %raised = fmul double %part, %v
  %next_part = fadd double %raised, %coefficient
  %next_b = add i64 %b, 1
  %more_terms = icmp slt i64 %next_b, %columns
  br i1 %more_terms, label %term, label %summed
summed:
  %grown = fmul double %value, %u
  %next_value = fadd double %grown, %next_part
  %next_a = add i64 %a, 1
  %more_rows = icmp slt i64 %next_a, %rows
  br i1 %more_rows, label %row, label %end
end:
  ret double %next_value
}
define i64 @piece(ptr %starts, i64 %count, double %x) {
begin:
  %end = sub i64 %count, 1
  br label %look
look:
  %i = phi i64 [0, %begin], [%next_i, %halve]
  %last = phi i64 [%end, %begin], [%next_last, %halve]
  %more = icmp slt i64 %i, %last
  br i1 %more, label %halve, label %found
halve:
  %sum = add i64 %i, %last
  %above = add i64 %sum, 1
  %middle = sdiv i64 %above, 2
  %place = getelementptr double, ptr %starts, i64 %middle
  %start = load double, ptr %place
  %below = fcmp olt double %x, %start
  %before = sub i64 %middle, 1
  %next_last = select i1 %below, i64 %before, i64 %last
  %next_i = select i1 %below, i64 %i, i64 %middle
  br label %look
found:
  ret i64 %i
}
"""
