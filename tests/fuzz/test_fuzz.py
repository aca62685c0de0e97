"""A sample of the campaign, and that its judge sees what it is for. `make fuzz` runs 100,000 inputs."""

import os
import pickle
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

import click
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from proprotor import InputError, load_case
from tests.fuzz import campaign, watch
from tests.fuzz.__main__ import _verdicts
from tests.fuzz.decks import written

SEED = 0
INPUTS = 1500


@pytest.fixture(scope="module", autouse=True)
def warm():
    campaign.warm_up(SEED)


def test_every_input_is_read_or_refused():
    found = list(campaign.campaign(SEED, list(campaign.inputs(INPUTS))))
    faults = [verdict for verdict in found if verdict.outcome not in ("accepted", "refused")]
    assert not faults, "\n".join(f"{one.kind} {one.number}: {one.outcome}\n{one.told}" for one in faults[:3])
    assert len(found) == INPUTS
    for kind in campaign.KINDS:  # the inputs must get far into the readers, but not always through
        accepted = [verdict.outcome == "accepted" for verdict in found if verdict.kind == kind]
        assert 0.03 < sum(accepted) / len(accepted) < 0.5, kind


@pytest.mark.parametrize("kind", campaign.KINDS)
def test_an_input_is_the_same_in_another_process(kind):
    code = f"from tests.fuzz.campaign import make; print([make({kind!r}, number, 3) for number in range(40)])"
    told = [
        subprocess.run(
            [sys.executable, "-c", code],
            env=os.environ | {"PYTHONHASHSEED": str(seed)},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for seed in (1, 2)
    ]
    assert told[0] == told[1] != ""


tables = st.recursive(
    st.booleans()
    | st.integers()
    | st.floats()
    | st.text(st.characters(exclude_categories=["Cs"]), max_size=9),
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(
            st.sampled_from(["value", "unit", "kind", "modes", "r_over_R", "collective"]), inner, max_size=3
        )
    ),
    max_leaves=5,
)
SECTIONS = ("case", "rotor", "rotor.airfoil", "operation", "support", "support.wing_aerodynamics")
FIELDS = (
    "name",
    "n_blades",
    "chord",
    "twist",
    "lift_slope",
    "trim",
    "kind",
    "modes",
    "file",
    "mass",
    "span",
    "base",
)


@settings(max_examples=100, deadline=None)
@given(
    st.dictionaries(st.sampled_from(SECTIONS), st.dictionaries(st.sampled_from(FIELDS), tables, max_size=3))
)
def test_any_sections_and_fields_are_read_or_refused(tmp_path_factory, sections):
    """On the bundled deck, with the values that hypothesis makes up."""
    text = "".join(f"[{name}]\n{written(fields)}\n" for name, fields in sections.items())
    path = tmp_path_factory.getbasetemp() / "made-up.toml"
    path.write_text(f'base = "xv15-uncoupled"\n{text}', encoding="utf-8")
    try:
        load_case(path)
    except InputError as error:
        assert all(": " in line and line.isprintable() for line in str(error).split("\n"))


# The judge ----------------------------------------------------------------------------------------


class _Writes:
    """What a pickle may do."""

    def __reduce__(self):
        return (open, ("executed", "w"))


DEEDS = {
    "writes a file": lambda folder: (folder / "new").write_text("x"),
    "appends to a file": lambda folder: (folder / "input").open("ab").close(),
    "writes by a descriptor": lambda folder: os.open(folder / "new", os.O_CREAT | os.O_WRONLY),
    "removes a file": lambda folder: (folder / "input").unlink(),
    "moves a file out": lambda folder: (folder / "input").rename(folder / "out" / "input"),
    "makes a folder": lambda folder: (folder / "new").mkdir(),
    "leaves the folder by a link": lambda folder: (folder / "out" / ".." / "new").write_text("x"),
    "starts a process": lambda folder: subprocess.run(["true"], check=False),
    "asks a shell": lambda folder: os.system("true"),
    "evaluates": lambda folder: eval("1 + 1"),
    "imports": lambda folder: __import__("this"),
    "unpickles": lambda folder: pickle.loads(pickle.dumps(_Writes())),
}


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "out").mkdir()
    (tmp_path / "input").write_text("x")
    return tmp_path


@pytest.mark.parametrize("deed", DEEDS)
@pytest.mark.parametrize("hidden", [False, True])
def test_what_no_input_may_do_is_seen_and_stopped(folder, monkeypatch, deed, hidden):
    """Also by code that takes every exception for a mistake of the input."""
    monkeypatch.chdir(folder)

    def use(folder):
        try:
            DEEDS[deed](folder)
        except Exception:
            if not hidden:
                raise
            raise InputError("file", None, "is damaged") from None

    monkeypatch.setitem(campaign.KINDS, "bad", _kind(use))
    (folder / "input").unlink()
    (folder / "out").rmdir()
    verdict = campaign.judged("bad", 0, SEED, folder)
    assert verdict.outcome == "breach", verdict
    assert sorted(path.name for path in folder.iterdir()) == ["input", "out"]
    assert not list((folder / "out").iterdir())


def _kind(use):
    class Kind:
        @staticmethod
        def make(rng):
            return {"input": b"x"}, {}

    Kind.use = staticmethod(use)
    return Kind


FAULTS = {
    "fault": lambda folder: 1 / 0,
    "bad message": lambda folder: _refuse_without_field("must be whole"),
    "accepted": lambda folder: (folder / "out" / "result").write_text("x"),
    "refused": lambda folder: _refuse("must be whole"),
}


def _refuse(rule):
    raise InputError("field", None, rule)


def _refuse_without_field(rule):
    raise click.ClickException(rule)


@pytest.mark.parametrize("outcome", FAULTS)
def test_what_becomes_of_an_input_is_told(tmp_path, monkeypatch, outcome):
    monkeypatch.setitem(campaign.KINDS, "bad", _kind(FAULTS[outcome]))
    assert campaign.judged("bad", 0, SEED, tmp_path).outcome == outcome


ENDS = {
    "dies": ("__import__('os').abort()", "crash", "ended with code -6"),
    "holds on to the interpreter": ("3 ** 10**9", "crash", "Timeout"),
    "takes all memory": ("bytearray(1 << 40)", "fault", "MemoryError"),
}


@pytest.mark.parametrize("end", ENDS)
def test_the_end_of_a_process_is_a_fault_of_its_input(end):
    """And of no other: those before it keep their verdicts, those after it are told to be unused."""
    deed, outcome, told = ENDS[end]
    code = f"""
import sys
from tests.fuzz import __main__ as fuzz, campaign

class Kind:
    make = staticmethod(lambda rng: ({{}}, {{}}))
    use = staticmethod(lambda folder: {deed} if folder.name == "1" else None)

fuzz._HANG, campaign._WARM_UP, campaign._IMPORTED_LATE = 1.0, 0, ()
campaign.KINDS, campaign.SHARES = {{"bad": Kind}}, {{"bad": 1.0}}
sys.exit(fuzz.main(["--share", "0:3", "--inputs", "3"]))
"""
    process = subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    found = _verdicts(process, [("bad", number) for number in range(3)])
    assert found[0].outcome == "accepted" and found[1].outcome == outcome and told in found[1].told
    if outcome == "crash":
        assert len(found) == 2 and "1 inputs after it were not used" in found[1].told
    else:
        assert found[2].outcome == "accepted"


def _works(folder):
    while True:
        pass


def test_an_input_that_works_too_long_is_a_fault(tmp_path, monkeypatch):
    monkeypatch.setattr(watch, "SECONDS", 0.05)
    monkeypatch.setitem(campaign.KINDS, "bad", _kind(_works))
    verdict = campaign.judged("bad", 0, SEED, tmp_path)
    assert verdict.outcome == "too slow" and "0.05 s of the processor" in verdict.told


def test_an_input_that_waits_for_ever_is_a_fault(tmp_path, monkeypatch):
    monkeypatch.setattr(watch, "WAITING", 0.05)
    monkeypatch.setitem(campaign.KINDS, "bad", _kind(lambda folder: time.sleep(60)))
    verdict = campaign.judged("bad", 0, SEED, tmp_path)
    assert verdict.outcome == "too slow" and "0.05 s of waiting" in verdict.told


def test_a_busy_machine_makes_no_input_slow(tmp_path, monkeypatch):
    """Time of the clock in which others work does not count."""
    monkeypatch.setattr(watch, "SECONDS", 0.05)
    monkeypatch.setitem(campaign.KINDS, "bad", _kind(lambda folder: time.sleep(0.3)))
    assert campaign.judged("bad", 0, SEED, tmp_path).outcome == "accepted"


@pytest.mark.parametrize("name", ["input", "new"])
def test_a_file_written_unseen_is_a_breach(tmp_path, monkeypatch, name):
    """By another thread, which the hook does not watch, as it does not see what C code writes."""
    with ThreadPoolExecutor(1) as unwatched:
        unwatched.submit(len, "").result()

        def use(folder):
            unwatched.submit((folder / name).write_text, "y").result()

        monkeypatch.setitem(campaign.KINDS, "bad", _kind(use))
        verdict = campaign.judged("bad", 0, SEED, tmp_path)
    assert verdict == ("bad", 0, "breach", f"files changed: ['{name}']")


def test_a_warning_is_a_fault(tmp_path, monkeypatch):
    import warnings

    monkeypatch.setitem(campaign.KINDS, "bad", _kind(lambda folder: warnings.warn("odd", stacklevel=1)))
    assert campaign.judged("bad", 0, SEED, tmp_path).outcome == "fault"
