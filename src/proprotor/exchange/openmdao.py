"""Components for OpenMDAO: results on a case as functions of its inputs, with exact derivatives.

`WhirlFlutter` has the flutter speed and the damping of modes; `GrowthConstraint` one number for an optimiser to keep at
or below zero, which exists at stable designs as well.

::

    import openmdao.api as om
    from proprotor.exchange.openmdao import WhirlFlutter

    problem = om.Problem()
    problem.model.add_subsystem(
        "wing", WhirlFlutter(case="xv15", inputs=["rotor.precone", "support.chord_frequency"]), promotes=["*"]
    )
    problem.setup()
    problem.set_val("rotor_precone", 2.0, units="deg")
    problem.run_model()
    problem.get_val("flutter_speed", units="kn")

Needs the extra ``openmdao``.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import partial
from typing import Any

import numpy as np

try:
    import openmdao.api as om
except ImportError as missing:
    hint = 'proprotor.exchange.openmdao needs OpenMDAO: pip install "proprotor[openmdao]"'
    raise ImportError(hint) from missing

from numpy.typing import NDArray

from proprotor.case import Case, load_case
from proprotor.deck.vary import inputs_at
from proprotor.errors import InputError, check_known
from proprotor.model.stamp import one_density
from proprotor.stability.boundary import Boundary
from proprotor.stability.eigenvalue_derivatives import eigenvalue_change, with_changes
from proprotor.stability.flutter import boundary_of, flutter_point
from proprotor.stability.growth_constraint import SHARPNESS, growth_constraint
from proprotor.stability.modes import decomposition
from proprotor.stability.sensitivity import at_boundary, damping_rate, sensitivity
from proprotor.typing import Dataset
from proprotor.units import in_metres_per_second

_UNITS = {"": None, "K": "degK"}  # units that OpenMDAO writes in another way


def variable_name(path: str) -> str:
    """Return the OpenMDAO variable of a path or a mode: ``support.modes[beam].x`` is support_modes_beam_x.

    Parameters
    ----------
    path : str

    Returns
    -------
    str
    """
    return re.sub(r"[^A-Za-z0-9]+", "_", path).strip("_")


class _OfCase(om.ExplicitComponent):  # type: ignore[misc]
    """A component whose inputs are numbers of the deck of a case."""

    def initialize(self) -> None:
        """Declare the options."""
        declare = self.options.declare
        declare("case", recordable=False, desc="Case, or name or path of a deck")
        declare("inputs", default=(), desc="paths of inputs, or a mapping of variable names to paths")
        declare("model_options", default={}, recordable=False, desc="options of the model")

    def _add_inputs(self) -> None:
        """Add an input for each path, with the value of the case."""
        case = self.options["case"]
        self._case = case if isinstance(case, Case) else load_case(case)
        self._paths = self._paths_by_name()
        numbers = inputs_at(self._case, self._paths.values())
        for name, path in self._paths.items():
            number = numbers[path]
            self.add_input(name, float(number.si), units=_UNITS.get(number.unit, number.unit), desc=path)

    @property
    def _model_options(self) -> dict[str, Any]:
        return dict(self.options["model_options"])

    def _paths_by_name(self) -> dict[str, str]:
        """Return the paths of the inputs by the names of their variables."""
        given = self._listed("inputs", "paths")
        paths = dict(given) if isinstance(given, Mapping) else {variable_name(path): path for path in given}
        inputs_at(self._case, paths.values())  # refuses what is no input
        return paths

    def _listed(self, option: str, names: str) -> Any:
        """Return an option that lists names of a kind; refuse a text, which would be a list of its letters."""
        if isinstance(given := self.options[option], str):
            raise InputError(option, given, f"must be a list of {names}")
        return given

    def _varied(self, inputs: Mapping[str, NDArray[np.float64]]) -> Case:
        return self._case.vary({path: inputs[name].item() for name, path in self._paths.items()})


class WhirlFlutter(_OfCase):
    """Flutter speed, and damping of named modes, of a case as functions of numbers of its deck.

    Inputs are named by their paths (`variable_name`) and have SI units, which OpenMDAO converts: rotor_precone in rad.
    With `damping`, airspeed is an input as well, (speeds,) in m/s. Outputs: flutter_speed in m/s and flutter_frequency
    in rad/s, of the lowest onset or of the chosen mode; damping_<mode> (speeds,), the ratio -Re λ/|λ|.

    A point that cannot be analysed raises `openmdao.api.AnalysisError` with the reason, and optimisers can step back
    from the point: no trim, no mode that becomes unstable in the range, an unknown mode, or a number that is not
    physical.

    Parameters
    ----------
    case : Case or str
        A case, or the name or path of a deck.
    inputs : sequence of str, or mapping of str to str
        Paths of inputs (`proprotor.deck.vary.design_inputs`), or paths by the names of their variables.
    flutter_speed : bool
        Whether flutter_speed and flutter_frequency are outputs.
    search : airspeeds in m/s, text such as "100:400:5kt", or pint quantity
        Airspeeds among which the flutter speed is searched; 0.2 to 1.2 of the tip speed by default.
    mode : str
        A mode whose first boundary is the flutter speed, instead of the lowest onset of any mode.
    level : float
        Damping ratio at which a mode counts as unstable, dimensionless.
    damping : sequence of str
        Modes whose damping is an output.
    airspeed : airspeeds as for `search`
        First values of the input airspeed.
    model_options : mapping
        See `proprotor.rotor.options.Options`.

    Raises
    ------
    InputError
        In setup, for an unknown path or mode, or when no output is asked for.
    """

    def initialize(self) -> None:
        """Declare the options."""
        super().initialize()
        declare = self.options.declare
        declare("flutter_speed", default=True, types=bool, desc="whether the flutter speed is an output")
        declare("search", default=None, desc="airspeeds in which the flutter speed is searched")
        declare("mode", default=None, desc="mode whose boundary is the flutter speed; any by default")
        declare("level", default=0.0, desc="damping ratio that counts as the boundary")
        declare("damping", default=(), desc="modes whose damping at the airspeeds is an output")
        declare("airspeed", default=None, desc="first values of the input airspeed")

    def setup(self) -> None:
        """Add inputs, outputs and partial derivatives.

        Raises
        ------
        InputError
            For an unknown path or mode, airspeeds that are missing, or when no output is asked for.
        """
        self._add_inputs()
        self._damping = {f"damping_{variable_name(mode)}": mode for mode in self._listed("damping", "modes")}
        self._found: dict[tuple[float, ...], Boundary] = {}  # by the inputs of the last flutter search
        if not (self.options["flutter_speed"] or self._damping):
            raise InputError("damping", None, "must name a mode, or flutter_speed must be true")
        if self.options["flutter_speed"]:
            self.add_output("flutter_speed", 100.0, units="m/s")
            self.add_output("flutter_frequency", 10.0, units="rad/s")
            if self._paths:
                self.declare_partials(["flutter_speed", "flutter_frequency"], list(self._paths))
        if self._damping:
            self._setup_damping()

    def _setup_damping(self) -> None:
        if self.options["airspeed"] is None:
            raise InputError("airspeed", None, "must be given for the damping")
        density = one_density(self._case, self._paths.values())
        speeds = in_metres_per_second(self.options["airspeed"], density).reshape(-1)
        points = np.arange(len(speeds))
        self.add_input("airspeed", speeds, units="m/s")
        for output in self._damping:
            self.add_output(output, shape=len(speeds))
            self.declare_partials(output, "airspeed", rows=points, cols=points)
            if self._paths:
                self.declare_partials(output, list(self._paths))

    def compute(self, inputs: Mapping[str, NDArray[np.float64]], outputs: Any) -> None:
        """Find the flutter speed and the damping at the airspeeds.

        Parameters
        ----------
        inputs : mapping of str to array
            SI, by the names of the variables.
        outputs : mapping of str to array
            Filled: flutter_speed in m/s, flutter_frequency in rad/s, damping ratios.

        Raises
        ------
        openmdao.api.AnalysisError
            When the point cannot be analysed, with the reason.
        """
        try:
            case = self._varied(inputs)
            if self.options["flutter_speed"]:
                boundary = self._boundary(case)
                outputs["flutter_speed"] = boundary.position
                outputs["flutter_frequency"] = boundary.frequency
                self._found = {self._key(inputs): boundary}
            if self._damping:
                modes = self._modes_at(case, inputs["airspeed"])
                for output, mode in self._damping.items():
                    outputs[output] = modes.damping_ratio.sel(mode=mode).values
        except InputError as error:
            raise om.AnalysisError(str(error)) from None

    def compute_partials(self, inputs: Mapping[str, NDArray[np.float64]], partials: Any) -> None:
        """Find exact derivatives by complex steps of the equations, without a further flutter search.

        Parameters
        ----------
        inputs : mapping of str to array
            SI, by the names of the variables.
        partials : mapping
            Filled, by output and input, SI.

        Raises
        ------
        openmdao.api.AnalysisError
            When the point cannot be analysed, with the reason.
        """
        try:
            case = self._varied(inputs)
            if self.options["flutter_speed"] and self._paths:
                self._flutter_partials(case, inputs, partials)
            if self._damping:
                self._airspeed_partials(case, inputs["airspeed"], partials)
            if self._damping and self._paths:
                self._damping_partials(case, inputs["airspeed"], partials)
        except InputError as error:
            raise om.AnalysisError(str(error)) from None

    def _key(self, inputs: Mapping[str, NDArray[np.float64]]) -> tuple[float, ...]:
        return tuple(inputs[name].item() for name in self._paths)

    def _boundary(self, case: Case) -> Boundary:
        """Return the boundary whose position is the flutter speed."""
        mode, level = self.options["mode"], self.options["level"]
        found = flutter_point(case, self.options["search"], level=level, **self._model_options)
        return boundary_of(found, mode)

    def _flutter_partials(self, case: Case, inputs: Mapping[str, NDArray[np.float64]], partials: Any) -> None:
        boundary = self._found.get(self._key(inputs)) or self._boundary(case)
        rates = at_boundary(case, boundary, inputs_at(case, self._paths.values()), self._model_options)
        for name, path in self._paths.items():
            own = rates.sel(input=path)
            partials["flutter_speed", name] = own.derivative.item()
            partials["flutter_frequency", name] = own.frequency_derivative.item()

    def _damping_partials(self, case: Case, speeds: NDArray[np.float64], partials: Any) -> None:
        paths = list(self._paths.values())
        by_speed = [
            sensitivity(case, "damping", paths, airspeed=float(speed), **self._model_options).derivative
            for speed in speeds
        ]
        for output, mode in self._damping.items():
            for name, path in self._paths.items():
                rates = [derivative.sel(input=path, mode=mode).item() for derivative in by_speed]
                partials[output, name] = np.reshape(rates, (-1, 1))

    def _airspeed_partials(self, case: Case, speeds: NDArray[np.float64], partials: Any) -> None:
        named = self._modes_at(case, speeds).sel(mode=list(self._damping.values()))
        model, changes = with_changes(partial(case.linearize, **self._model_options), np.asarray(speeds))
        spectrum = decomposition(model)
        apart = np.abs(spectrum.values[:, None, :] - named.eigenvalue.values[:, :, None])
        modes = spectrum.modes(apart.argmin(axis=-1))
        rates = damping_rate(modes.values, eigenvalue_change(model, changes, modes))
        for place, output in enumerate(self._damping):
            partials[output, "airspeed"] = rates[:, place]

    def _modes_at(self, case: Case, speeds: NDArray[np.float64]) -> Dataset:
        """Return the modes at the airspeeds; refuse an airspeed that failed and a wanted mode that does not exist."""
        line, places = np.unique(speeds, return_inverse=True)
        found = case.sweep(line, **self._model_options)
        for speed, reason in zip(line, found.reason.values, strict=True):
            if reason:
                raise InputError("airspeed", f"{speed:.6g} m/s", str(reason))
        names = found.mode.values.tolist()
        for mode in self._damping.values():
            check_known("damping", mode, names, "mode")
            missing = ~np.isfinite(found.damping_ratio.sel(mode=mode).values)
            if missing.any():
                raise InputError("damping", mode, f"is no mode at {line[missing][0]:.6g} m/s")
        return found.isel(airspeed=places)


class GrowthConstraint(_OfCase):
    """Aggregated growth of all roots of a case, a constraint with exact partial derivatives.

    Inputs are named by their paths (`variable_name`) and have SI units, which OpenMDAO converts. The output is growth
    in 1/s, at or below zero where every root at every airspeed has the damping wanted; stable designs have it as well
    as unstable ones: see `proprotor.stability.growth_constraint.growth_constraint`.

    A point that cannot be analysed raises `openmdao.api.AnalysisError` with the reason, and optimisers can step back
    from the point: an airspeed without a trim, or a number that is not physical.

    Parameters
    ----------
    case : Case or str
        A case, or the name or path of a deck.
    inputs : sequence of str, or mapping of str to str
        Paths of inputs (`proprotor.deck.vary.design_inputs`), or paths by the names of their variables.
    airspeed : airspeeds in m/s, text such as "100:360:10kt", or pint quantity
        Where damping is wanted.
    level : float
        Damping ratio that every root must have, dimensionless.
    sharpness : float
        How closely the largest growth is followed, s.
    model_options : mapping
        See `proprotor.rotor.options.Options`.

    Raises
    ------
    InputError
        In setup, for an unknown path, or when no airspeed is given.
    """

    def initialize(self) -> None:
        """Declare the options."""
        super().initialize()
        declare = self.options.declare
        declare("airspeed", default=None, desc="airspeeds at which damping is wanted")
        declare("level", default=0.0, desc="damping ratio that every root must have")
        declare("sharpness", default=SHARPNESS, desc="how closely the largest growth is followed, s")

    def setup(self) -> None:
        """Add inputs, the output and its partial derivatives.

        Raises
        ------
        InputError
            For an unknown path, or when no airspeed is given.
        """
        if self.options["airspeed"] is None:
            raise InputError("airspeed", None, "must be given for the growth")
        self._add_inputs()
        self.add_output("growth", -1.0, units="1/s")
        if self._paths:
            self.declare_partials("growth", list(self._paths))

    def compute(self, inputs: Mapping[str, NDArray[np.float64]], outputs: Any) -> None:
        """Find the aggregated growth.

        Parameters
        ----------
        inputs : mapping of str to array
            SI, by the names of the variables.
        outputs : mapping of str to array
            Filled: growth in 1/s.

        Raises
        ------
        openmdao.api.AnalysisError
            When the point cannot be analysed, with the reason.
        """
        outputs["growth"] = self._constraint(inputs, ()).constraint.item()

    def compute_partials(self, inputs: Mapping[str, NDArray[np.float64]], partials: Any) -> None:
        """Find exact derivatives by complex steps of the equations.

        Parameters
        ----------
        inputs : mapping of str to array
            SI, by the names of the variables.
        partials : mapping
            Filled, by output and input, SI.

        Raises
        ------
        openmdao.api.AnalysisError
            When the point cannot be analysed, with the reason.
        """
        rates = self._constraint(inputs, tuple(self._paths.values())).derivative
        for name, path in self._paths.items():
            partials["growth", name] = rates.sel(input=path).item()

    def _constraint(self, inputs: Mapping[str, NDArray[np.float64]], wrt: tuple[str, ...]) -> Dataset:
        """Return the constraint with its derivatives by some inputs."""
        asked = {name: self.options[name] for name in ("level", "sharpness")}
        try:
            case = self._varied(inputs)
            return growth_constraint(case, self.options["airspeed"], wrt, **asked, **self._model_options)
        except InputError as error:
            raise om.AnalysisError(str(error)) from None
