"""What work costs: processor time per point, memory, size and operations of code. Processor time, since other
processes share the machine."""

from __future__ import annotations

import ast
import inspect
import resource
import textwrap
import time
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from benchmarks.peers import generated_rotor
from benchmarks.peers.random_rotors import random_rotors, rotor

BATCHES = (1, 100, 10_000)
COMPARED = 100  # random rotors; a size of batch that JAX has compiled already
_ROUNDS, _ROUND_SECONDS = 5, 0.1
Evaluate = Callable[[Mapping[str, Any]], Any]


def per_point(evaluate: Evaluate) -> dict[str, Any]:
    """Microseconds a point by size of the batch, the first call of each in seconds, and memory beyond the start, MB."""
    found: dict[str, Any] = {"microseconds": {}, "first call": {}}
    before = peak_memory()
    for count in BATCHES:
        quantities = random_rotors(count)
        quantities = rotor(quantities, 0) if count == 1 else quantities
        first = seconds(lambda q=quantities: evaluate(q), 1)
        found["first call"][str(count)] = first
        found["microseconds"][str(count)] = fastest(lambda q=quantities: evaluate(q), first) / count * 1e6
    return found | {"memory": peak_memory() - before}


def fastest(work: Callable[[], object], first: float) -> float:
    """Least processor time of one call, s; work of more than two seconds is called once."""
    if first > 2 and (again := seconds(work, 1)) > 2:
        return again
    calls = max(1, int(_ROUND_SECONDS / max(seconds(work, 1), 1e-6)))
    return min(seconds(work, calls) for _ in range(_ROUNDS)) / calls


def seconds(work: Callable[[], object], calls: int) -> float:
    start = time.process_time()
    for _ in range(calls):
        work()
    return time.process_time() - start


def peak_memory() -> float:
    """MB."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def worst_disagreement(
    evaluate: Evaluate, places: Sequence[int] = tuple(range(18)), seed: int = 7
) -> dict[str, float]:
    """Greatest difference of M, C and K from the generated ones over random rotors, in the chosen coordinates.

    Relative to the entry or, if that is larger, to what inertia at 1/rev puts there: Omega^k sqrt(M_ii M_jj).
    """
    quantities = random_rotors(COMPARED, seed)
    expected = generated_rotor.rotor_matrices(quantities)
    expected = [matrix[:, list(places)][:, :, list(places)] for matrix in expected]
    root = np.sqrt(np.einsum("...ii->...i", expected[0]))
    natural = root[:, :, None] * root[:, None, :]
    speed = quantities["rotor_speed"][:, None, None]
    found = {}
    for power, (name, actual, right) in enumerate(zip("MCK", evaluate(quantities), expected, strict=True)):
        scale = np.maximum(np.abs(right), speed**power * natural)
        found[name] = float(np.max(np.abs(np.asarray(actual) - right) / scale))
    return found


def code_size(functions: Sequence[Callable]) -> dict[str, int]:
    """Bytes of the functions' source without docstrings and comments, and arithmetic operations in it."""
    trees = [ast.parse(textwrap.dedent(inspect.getsource(function))) for function in functions]
    for tree in trees:
        body = tree.body[0].body
        if isinstance(body[0], ast.Expr) and isinstance(body[0].value, ast.Constant):
            del body[0]
    return {
        "bytes": sum(len(ast.unparse(tree).encode()) for tree in trees),
        "operations": sum(operation(node) for tree in trees for node in ast.walk(tree)),
    }


def operation(node: ast.AST) -> bool:
    """Whether a node is arithmetic on what is not a constant: + - * / **, a sign, a sine, cosine or root."""
    if isinstance(node, ast.BinOp):
        return not (isinstance(node.left, ast.Constant) and isinstance(node.right, ast.Constant))
    if isinstance(node, ast.UnaryOp):
        return not isinstance(node.operand, ast.Constant)
    if isinstance(node, ast.Call):
        name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
        return name in ("sin", "cos", "tan", "sqrt")
    return False
