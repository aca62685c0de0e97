"""How uncertain a result is, and which inputs make it so: distributions and Sobol indices from a study of a sample."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from proprotor.errors import InputError
from proprotor.model import stamp
from proprotor.model.doubts import reasons_for_doubt
from proprotor.needs import check_memory, need
from proprotor.study.designs import check_count
from proprotor.study.variables import STABLE, UNSTABLE
from proprotor.typing import Array, Dataset

_PERCENTILES = (1, 5, 25, 50, 75, 95, 99)
_MOST_LEFT_OUT = 0.05  # of the base samples, before indices say little about the sample that was drawn


def distribution(
    results: Dataset, of: str = "flutter_speed", percentiles: Sequence[float] = _PERCENTILES
) -> Dataset:
    """Return percentiles of a result over the designs of a sample.

    The flutter speed of a design that stays stable lies above the airspeeds of the study, and that of a design that is
    unstable from the start lies below: such designs count as above or below, and a percentile among them is inf or
    -inf, not a number made up. Failed designs are left out and counted.

    Parameters
    ----------
    results : xarray.Dataset
        A study of a plan of `latin_hypercube`, `sobol` or `points`; of `saltelli` too, whose designs repeat values.
    of : str
        A variable with one number for each design.
    percentiles : sequence of float
        0 to 100, dimensionless.

    Returns
    -------
    xarray.Dataset
        ``value`` over ``percentile``, and the numbers of designs that are ``known``, ``above`` or ``below`` the range,
        ``failed``, or ``doubtful``; the attribute ``doubts`` gives the reasons for doubt. Other attributes say the case
        and its options.

    Raises
    ------
    InputError
        For a variable that the results do not have, or not as one number a design, or when no design is left.
    """
    import xarray

    values, above, below = _one_a_design(results, of)
    known = np.isfinite(values)
    failed = ~(known | above | below)
    if failed.all():
        raise InputError(of, None, "has no value for any design")
    wanted = np.asarray(percentiles, dtype=float)
    if wanted.ndim != 1 or not np.all((wanted >= 0) & (wanted <= 100)):
        raise InputError("percentiles", percentiles, "must be a list of numbers from 0 to 100")
    ordered = np.where(above, np.inf, np.where(below, -np.inf, values))[~failed]
    # The value itself that a share of the designs does not exceed: between a number and infinity nothing lies.
    found = np.quantile(ordered, wanted / 100, method="inverted_cdf")
    warnings = _warnings(results, of)
    counts = {"known": known, "above": above, "below": below, "failed": failed, "doubtful": warnings != ""}
    own = {"units": results[of].attrs.get("units", "1"), "long_name": f"of {of}"}
    table: dict[str, Any] = {"value": ("percentile", found, own)}
    table |= {name: ((), int(mask.sum())) for name, mask in counts.items()}
    return xarray.Dataset(table, {"percentile": wanted}, _attributes(results, of, warnings))


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
    values, above, below = _one_a_design(results, of)
    known = np.isfinite(values)
    works = known | above | below
    if not works.any():
        raise InputError(of, None, "has no value for any design")
    lowest, highest = _range(results)
    if (above.any() and limit > highest) or (below.any() and limit < lowest):
        rule = f"must lie in the airspeeds of the study, {lowest:g} to {highest:g} m/s"
        raise InputError("limit", limit, rule)
    return float((below.sum() + (values[known] < limit).sum()) / works.sum())


def sobol_indices(
    results: Dataset, of: str = "flutter_speed", confidence: float = 0.95, resamples: int = 100
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
        Level of the intervals, dimensionless, from 0 to 1.
    resamples : int
        Number of resamples of the bootstrap that finds the intervals.

    Returns
    -------
    xarray.Dataset
        Over ``input``: ``first``, the share of the input alone, ``total``, with all its interactions, and half the
        width of both intervals; ``second`` over two inputs if the sample was drawn with ``second_order``. ``doubtful``
        counts the designs whose result is doubtful; the attribute ``doubts`` says why. Other attributes say the case
        and its options.

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
    values, whole = _base_samples(results, of, sample)
    found = _analysed(values[whole], sample, num_resamples=resamples, conf_level=confidence)
    warnings, names = _warnings(results, of), sample["inputs"]
    table: dict[str, Any] = {
        "first": ("input", found["S1"]),
        "first_half_interval": ("input", found["S1_conf"]),
        "total": ("input", found["ST"]),
        "total_half_interval": ("input", found["ST_conf"]),
        "left_out": ((), int((~whole).sum()), {"long_name": "base samples with a design that has no value"}),
        "doubtful": ((), int((warnings != "").sum()), {"long_name": "designs whose result is doubtful"}),
    }
    coordinates = {"input": names}
    if sample["second_order"]:
        upper = found["S2"]  # SALib fills half of a symmetric table; its diagonal is NaN
        table["second"] = (("input", "other_input"), np.where(np.isnan(upper), upper.T, upper))
        coordinates["other_input"] = names
    return xarray.Dataset(table, coordinates, _attributes(results, of, warnings) | {"confidence": confidence})


def _base_samples(results: Dataset, of: str, sample: Mapping[str, Any]) -> tuple[Array, Array]:
    """Return the values of base samples (samples, designs), and which samples have a value of every design."""
    values, above, below = _one_a_design(results, of)
    values = values.reshape(-1, len(sample["inputs"]) * (2 if sample["second_order"] else 1) + 2)
    whole = np.asarray(np.isfinite(values).all(axis=1))
    _check_left_out(of, whole, int(above.sum() + below.sum()))
    if np.ptp(values[whole]) == 0:
        rule = "is the same for every design: there is no variance to share out"
        raise InputError(of, float(values[whole].flat[0]), rule)
    return values, whole


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


def _one_a_design(results: Dataset, of: str) -> tuple[Array, Array, Array]:
    """Return the values of the designs, and which designs lie above and below the airspeeds of the study."""
    if of not in results.data_vars:
        known = ", ".join(str(name) for name in results.data_vars)
        raise InputError("of", of, f"must be a variable of the results ({known})")
    values = results[of]
    if values.dims != ("design",) or values.dtype.kind not in "fiu":
        rule = 'must have one number for each design: choose an airspeed, or quantities="flutter"'
        raise InputError("of", of, rule)
    notes = np.full(values.shape, "", dtype=object)
    if of.startswith("flutter_") and "flutter_note" in results:
        notes = results["flutter_note"].values
    found = values.values.astype(float)
    return found, notes == STABLE, (notes == UNSTABLE) & np.isnan(found)


def _range(results: Dataset) -> tuple[float, float]:
    """Return the lowest and the highest airspeed of a study, m/s; infinite without a range."""
    if "airspeed" not in results.dims:
        return -np.inf, np.inf
    return float(results.airspeed.min()), float(results.airspeed.max())


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
        hint = f"; {beyond} designs are stable or unstable throughout: widen the airspeeds" if beyond else ""
        count = f"no value in {left_out} of {len(whole)} base samples"
        raise InputError(of, count, f"must be known in {1 - _MOST_LEFT_OUT:.0%} of them{hint}")
