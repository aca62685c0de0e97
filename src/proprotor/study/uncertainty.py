"""How uncertain a result is, and which inputs make it so: distributions and Sobol indices from a study of a sample."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from proprotor.errors import InputError, list_choices
from proprotor.model import stamp
from proprotor.model.doubts import reasons_for_doubt
from proprotor.needs import check_memory, need
from proprotor.study.censoring import Bounds, bounds_of
from proprotor.study.designs import check_count
from proprotor.typing import Array, Dataset

_PERCENTILES = (1, 5, 25, 50, 75, 95, 99)
_BEYOND = ("left out", "limit")  # what is done with designs beyond the airspeeds of a study
_MOST_LEFT_OUT = 0.05  # of the base samples, before indices say little about the sample that was drawn


def distribution(
    results: Dataset, of: str = "flutter_speed", percentiles: Sequence[float] = _PERCENTILES
) -> Dataset:
    """Return percentiles of a result over the designs of a sample, whose inputs were drawn at random.

    The flutter speed of a design that stays stable lies above a limit, and that of a design that is unstable from the
    start lies below one. Such designs count with all speeds that they may have: a percentile that is the same for all
    these speeds is a number, and any other lies between two bounds. Designs without any value are left out and counted.

    Parameters
    ----------
    results : xarray.Dataset
        A study of a plan of `latin_hypercube` or `sobol`; of `saltelli` too, whose designs repeat values; of `points`
        that were drawn by the caller, ``points(inputs, drawn=True)``.
    of : str
        A variable with one number for each design.
    percentiles : sequence of float
        0 to 100, dimensionless.

    Returns
    -------
    xarray.Dataset
        ``value`` over ``percentile``, with the bounds ``at_least`` and ``at_most``; the value is inf where only a lower
        bound is known, -inf where only an upper one is, and NaN between two different numbers. The numbers of designs
        that are ``known``, ``above`` or ``below`` a limit, ``failed`` (without a value), or ``doubtful``; the
        attribute ``doubts`` gives the reasons for doubt. Other attributes say the case and its options.

    Raises
    ------
    InputError
        For a variable that the results do not have, or not as one number a design, for designs that were chosen and not
        drawn, or when no design is left.
    """
    import xarray

    _check_drawn(results)
    found = _one_a_design(results, of)
    if found.failed.all():
        raise InputError(of, None, "has no value for any design")
    wanted = np.asarray(percentiles, dtype=float)
    if wanted.ndim != 1 or not np.all((wanted >= 0) & (wanted <= 100)):
        raise InputError("percentiles", percentiles, "must be a list of numbers from 0 to 100")
    # The value itself that a share of the designs does not exceed: between a number and infinity nothing lies.
    low, high = (np.quantile(end[~found.failed], wanted / 100, method="inverted_cdf") for end in found)
    warnings = _warnings(results, of)
    own = {"units": results[of].attrs.get("units", "1"), "long_name": f"of {of}"}
    table: dict[str, Any] = {"value": ("percentile", _between(low, high), own)}
    for name, end in (("at_least", low), ("at_most", high)):
        table[name] = ("percentile", end, own | {"long_name": f"bound of {of}"})
    counts = {name: getattr(found, name) for name in ("known", "above", "below", "failed")}
    table |= {name: ((), int(mask.sum())) for name, mask in (counts | {"doubtful": warnings != ""}).items()}
    return xarray.Dataset(table, {"percentile": wanted}, _attributes(results, of, warnings))


def _between(low: Array, high: Array) -> Array:
    """Return the numbers between bounds: a bound where both are one, inf or -inf where one side is open, else NaN."""
    open_side = np.where(
        np.isneginf(low) == np.isposinf(high), np.nan, np.where(np.isposinf(high), high, low)
    )
    return np.where(low == high, low, open_side)


def _check_drawn(results: Dataset) -> None:
    """Refuse designs that somebody chose: their shares say nothing about how likely a result is."""
    if "sample" not in results.attrs:
        rule = "must be a study of inputs drawn at random, such as sampling.latin_hypercube: a grid has no percentiles"
        raise InputError("results", None, rule)


def _warnings(results: Dataset, of: str) -> Array:
    """Return the warning that makes the result of each design (designs,) doubtful."""
    name = "flutter_warning" if of.startswith("flutter_") else "warning"
    if name in results and results[name].dims == results[of].dims:
        return np.asarray(results[name].values)
    return np.full(results[of].shape, "")


def _attributes(results: Dataset, of: str, warnings: Array) -> dict[str, Any]:
    """Return attributes that say which case and options a result over the designs comes from, and its doubts."""
    doubts = {"doubts": "; ".join(reasons_for_doubt(warnings.tolist()))}
    return stamp.of(results.attrs) | {"of": of} | doubts


def share_below(results: Dataset, limit: float, of: str = "flutter_speed") -> float:
    """Return the share of the designs whose result is below a limit (SI), such as a flutter speed below an airspeed.

    Parameters
    ----------
    results : xarray.Dataset
        As for `distribution`.
    limit : float
        In the SI unit of the result.
    of : str
        A variable with one number for each design.

    Returns
    -------
    float
        A share of the designs that did not fail, 0 to 1.

    Raises
    ------
    InputError
        As `distribution`; and when designs beyond the airspeeds of the study may lie on either side of the limit.
    """
    _check_drawn(results)
    found = _one_a_design(results, of)
    if found.failed.all():
        raise InputError(of, None, "has no value for any design")
    beneath = (found.high < limit) | (found.below & (found.high <= limit))
    unclear = (found.low < limit) & ~beneath & ~found.known
    if unclear.any():
        lowest = float(found.high[found.below].max(initial=-np.inf))
        highest = float(found.low[found.above].min(initial=np.inf))
        where = "the airspeeds of the study at which the stability of every design is known"
        raise InputError("limit", limit, f"must lie in {where}, {lowest:g} to {highest:g} m/s")
    return float(beneath.sum() / (~found.failed).sum())


def sobol_indices(
    results: Dataset,
    of: str = "flutter_speed",
    confidence: float = 0.95,
    resamples: int = 100,
    beyond: str = "left out",
) -> Dataset:
    """Return the share of the variance that each input of a Saltelli sample causes (SALib).

    Parameters
    ----------
    results : xarray.Dataset
        A study of `proprotor.sampling.saltelli`.
    of : str
        A variable with one number for each design. Base samples with a design without a number are left out, at most
        5 % of all.
    confidence : float
        Level of the intervals, dimensionless, from 0 to 1. The bootstrap takes base samples for independent draws;
        those of a Sobol sequence are spread more evenly, so that the true shares lie within more often than that.
    resamples : int
        Number of resamples of the bootstrap that finds the intervals.
    beyond : "left out" or "limit"
        What is done with a design whose flutter speed lies beyond the airspeeds of the study: its base sample is left
        out, or the limit stands in its place. With "limit" the indices are those of the flutter speed cut off at the
        limits, of which no base sample is left out for that reason.

    Returns
    -------
    xarray.Dataset
        Over ``input``: ``first``, the share of the input alone, ``total``, with all its interactions, and half the
        width of both intervals; ``second`` over two inputs if the sample was drawn with ``second_order``. ``left_out``
        counts base samples that are left out, and ``at_limit`` designs that count with their limit; the attribute
        ``treatment`` says it in a sentence. ``doubtful`` counts the designs whose result is doubtful; the attribute
        ``doubts`` says why. Other attributes say the case and its options.

    Raises
    ------
    InputError
        When the results are of no Saltelli sample, too many designs have no value, or all have the same value; when
        SALib is not installed, or the resamples do not fit into memory.
    """
    need("SALib", "of", "Sobol indices", "study")
    import xarray

    sample = _saltelli_of(results)
    check_count("resamples", resamples)
    size = 24.0 * resamples * results.sizes.get("design", 0)  # places, and two values at each
    check_memory("resamples", resamples, size, "the bootstrap")
    if beyond not in _BEYOND:
        raise InputError("beyond", beyond, f"must be {list_choices(_BEYOND)}")
    samples = _base_samples(results, of, sample, beyond == "limit")
    found = _analysed(samples.values, sample, num_resamples=resamples, conf_level=confidence)
    warnings, names = _warnings(results, of), sample["inputs"]
    table: dict[str, Any] = {
        "first": ("input", found["S1"]),
        "first_half_interval": ("input", found["S1_conf"]),
        "total": ("input", found["ST"]),
        "total_half_interval": ("input", found["ST_conf"]),
        "left_out": ((), samples.left_out, {"long_name": "base samples with a design that has no value"}),
        "at_limit": (
            (),
            samples.at_limit,
            {"long_name": "designs that count with the limit of their result"},
        ),
        "doubtful": ((), int((warnings != "").sum()), {"long_name": "designs whose result is doubtful"}),
    }
    coordinates = {"input": names}
    if sample["second_order"]:
        upper = found["S2"]  # SALib fills half of a symmetric table; its diagonal is NaN
        table["second"] = (("input", "other_input"), np.where(np.isnan(upper), upper.T, upper))
        coordinates["other_input"] = names
    own = {"confidence": confidence, "treatment": samples.treatment}
    return xarray.Dataset(table, coordinates, _attributes(results, of, warnings) | own)


class _BaseSamples(NamedTuple):
    """Values of base samples (samples, designs) that are whole, and what became of the others."""

    values: Array
    left_out: int
    at_limit: int
    treatment: str


def _base_samples(results: Dataset, of: str, sample: Mapping[str, Any], at_limits: bool) -> _BaseSamples:
    """Return the values of the base samples that have a value of every design.

    Raises
    ------
    InputError
        When too many base samples are left out, or all values are the same.
    """
    found, size = _one_a_design(results, of), len(sample["inputs"]) * (2 if sample["second_order"] else 1) + 2
    values = np.where(found.known, found.low, np.nan)
    beyond = found.above | found.below
    if at_limits:
        values = np.where(found.above, found.low, np.where(found.below, found.high, values))
    values, censored = values.reshape(-1, size), beyond.reshape(-1, size).any(axis=1)
    whole = np.asarray(np.isfinite(values).all(axis=1))
    _check_left_out(of, whole, int(beyond.sum()) if not at_limits else 0)
    if np.ptp(values[whole]) == 0:
        rule = "is the same for every design: there is no variance to share out"
        raise InputError(of, float(values[whole].flat[0]), rule)
    left_out, at_limit = int((~whole).sum()), int(beyond.sum()) if at_limits else 0
    text = f"{left_out} of {len(whole)} base samples are left out"
    if left_out and not at_limits:
        text += f", {int((censored & ~whole).sum())} of them for a design beyond the airspeeds of the study"
    if at_limit:
        text += f"; {at_limit} designs beyond the airspeeds of the study count with their limit"
    return _BaseSamples(values[whole], left_out, at_limit, f"{text}.")


def _analysed(values: Array, sample: Mapping[str, Any], **bootstrap: Any) -> Mapping[str, Array]:
    """Return SALib's indices from the values of whole base samples (samples, designs)."""
    from SALib.analyze import sobol as salib_sobol

    names = sample["inputs"]
    found: Mapping[str, Array] = salib_sobol.analyze(
        {"num_vars": len(names), "names": names, "bounds": [[0, 1]] * len(names)},
        values.reshape(-1),
        calc_second_order=sample["second_order"],
        seed=sample["seed"] + 1,  # SALib takes 0 for none
        **bootstrap,
    )
    return found


def _one_a_design(results: Dataset, of: str) -> Bounds:
    """Return what is known of a result of each design."""
    if of not in results.data_vars:
        known = ", ".join(str(name) for name in results.data_vars)
        raise InputError("of", of, f"must be a variable of the results ({known})")
    values = results[of]
    if values.dims != ("design",) or values.dtype.kind not in "fiu":
        rule = 'must have one number for each design: choose an airspeed, or quantities="flutter"'
        raise InputError("of", of, rule)
    return bounds_of(results, of)


def _saltelli_of(results: Dataset) -> dict[str, Any]:
    """Return how a Saltelli sample was drawn; refuse results of anything else."""
    sample: dict[str, Any] = json.loads(results.attrs.get("sample", "{}"))
    if sample.get("method") != "saltelli":
        raise InputError("results", sample.get("method"), "must be a study of proprotor.sampling.saltelli")
    return sample


def _check_left_out(of: str, whole: Array, beyond: int) -> None:
    """Refuse indices of too few base samples, with the number of designs beyond the airspeeds as a hint."""
    left_out = len(whole) - whole.sum()
    if left_out > _MOST_LEFT_OUT * len(whole):
        remedy = 'widen the airspeeds, or take beyond="limit"'
        hint = f"; {beyond} designs are stable or unstable throughout: {remedy}" if beyond else ""
        count = f"no value in {left_out} of {len(whole)} base samples"
        raise InputError(of, count, f"must be known in {1 - _MOST_LEFT_OUT:.0%} of them{hint}")
