"""One measurement in a process of its own, printed as JSON.

python -m benchmarks.peers.measure generated
python -m benchmarks.peers.measure fused
python -m benchmarks.peers.measure kane flap lag pitch azimuth
python -m benchmarks.peers.measure lambdify cse|plain
python -m benchmarks.peers.measure jax Lagrangian|positions
python -m benchmarks.peers.measure regeneration
"""

from __future__ import annotations

import json
import resource
import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from typing import Any

from benchmarks.peers import cost, generated_rotor

Result = dict[str, Any]
WITHOUT_AIRLOADS = ("inertia", "flap_lag_springs", "pitch", "multiblade")


def regeneration() -> Result:
    """Deriving and emitting: the modules of the rotor without airloads, then all in a new process."""
    from derive import emit, equations

    def spent(who: int) -> float:
        used = resource.getrusage(who)
        return used.ru_utime + used.ru_stime

    start = time.process_time()
    for module in WITHOUT_AIRLOADS:
        emit.render_module(equations.consistent_functions(module), equations.STEPS[module].title)
    formatting = spent(resource.RUSAGE_CHILDREN)
    some = time.process_time() - start + formatting
    subprocess.run([sys.executable, "-m", "derive", "--check"], stdout=subprocess.DEVNULL)
    return {"without airloads": some, "all": spent(resource.RUSAGE_CHILDREN) - formatting}


def generated() -> Result:
    """The generated equations: blade and rotor."""
    blade = cost.code_size(generated_rotor.BLADE_FUNCTIONS)
    whole = cost.code_size(generated_rotor.BLADE_FUNCTIONS + generated_rotor.ROTOR_FUNCTIONS)
    found = {"blade code": blade, "code": whole} | cost.per_point(generated_rotor.rotor_matrices)
    return found | {"runtime": runtime()}


def fused() -> Result:
    """The fused functions without airloads: operations, and time in that of lambdify in interleaved rounds."""
    import numpy as np

    from benchmarks import fused as rounds
    from benchmarks.peers.lambdified import Lambdified, rotor_expressions
    from derive.fused import in_vacuum, named_values
    from derive.plain import PLAIN_ROTORS

    plans = in_vacuum(PLAIN_ROTORS), named_values(PLAIN_ROTORS, "flap_lag_springs", "effective_stiffness")
    lambdified = Lambdified(rotor_expressions(), cse=True)
    ratios = {}
    for count in cost.BATCHES:
        found = rounds.times(rounds.without_airloads(count, lambdified), count)
        ratios[str(count)] = float(np.median(found["fused"] / found["lambdify"]))
    operations = sum(plan.plan.operations for plan in plans)
    return {"operations": operations, "of lambdify": ratios, "versions": rounds.versions()}


def runtime() -> dict[str, float]:
    """Microseconds a point of the bundled XV-15's rotor, trim and airloads included."""
    import numpy as np

    import proprotor as pp

    case = pp.load_case("xv15-uncoupled")
    found = {}
    for count in cost.BATCHES[1:]:
        speeds = np.linspace(60.0, 180.0, count)

        def work(speeds=speeds):
            return pp.rotor_model(case.rotor, case.operation, speeds)

        found[str(count)] = cost.fastest(work, cost.seconds(work, 1)) / count * 1e6
    return found


def kane(*coordinates: str) -> Result:
    """A blade of these coordinates by Kane's method, all without names."""
    import sympy as sp

    from benchmarks.peers import blade_sum, kane_rotor
    from benchmarks.peers.lambdified import Lambdified

    names = coordinates or kane_rotor.COORDINATES
    blade = kane_rotor.linear_blade(names)
    matrices = (blade.mass, blade.damping, blade.stiffness)
    found: Result = {"coordinates": names, "seconds": blade.seconds}
    found["operations"] = sum(int(sp.count_ops(matrix)) for matrix in matrices)
    found["plain bytes"] = sum(len(str(entry)) for matrix in matrices for entry in matrix if entry != 0)
    start = time.process_time()
    function = Lambdified(matrices, cse=True)
    found["seconds"]["lambdify"] = time.process_time() - start
    found["code"] = cost.code_size([function.function])
    places = [blade_sum.FIXED.index(name) for name in blade_sum.fixed_coordinates(names)]
    found["disagreement"] = cost.worst_disagreement(
        lambda q: blade_sum.over_blades(q, names, function(q)), places
    )
    return found | cost.per_point(function)


def lambdify(kind: str) -> Result:
    """The derivation's own expressions through lambdify, from the blade's numbers to the rotor's matrices."""
    from benchmarks.peers.lambdified import Lambdified, rotor_expressions

    start = time.process_time()
    matrices = rotor_expressions()
    expressions = time.process_time() - start
    start = time.process_time()
    function = Lambdified(matrices, cse=kind == "cse")
    found = {"expressions": expressions, "lambdify": time.process_time() - start}
    found |= {"code": cost.code_size([function.function]), "disagreement": cost.worst_disagreement(function)}
    return found | cost.per_point(function)


def jax(form: str) -> Result:
    """The nonlinear rotor in JAX; each size of a batch is compiled by itself, in its first call."""
    import jax as library
    import numpy as np

    from benchmarks.peers import jax_rotor

    single = library.jit(jax_rotor.FORMS[form])
    batch = library.jit(library.vmap(jax_rotor.FORMS[form]))

    def evaluate(quantities: Mapping[str, Any]):
        given = {name: np.asarray(quantities[name]) for name in jax_rotor.INPUTS}
        function = batch if given["rotor_speed"].ndim else single
        return library.block_until_ready(function(given))

    found = cost.per_point(evaluate)
    return found | {"disagreement": cost.worst_disagreement(evaluate)}


PARTS: dict[str, Callable[..., Result]] = {
    "regeneration": regeneration,
    "generated": generated,
    "fused": fused,
    "kane": kane,
    "lambdify": lambdify,
    "jax": jax,
}


def main(part: str, *arguments: str) -> None:
    print(json.dumps(PARTS[part](*arguments)))


if __name__ == "__main__":
    main(*sys.argv[1:])
