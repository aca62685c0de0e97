"""What the package tells by `logging`: nothing by itself, and what a study does to whoever listens."""

import logging
import os
import subprocess
import sys
from types import SimpleNamespace

import proprotor as pp
from proprotor.study import workers
from proprotor.study.workers import Processes

CASE = pp.load_case("xv15-uncoupled")
PRECONE = {"rotor.precone": [0.03, 0.04]}


def told(caplog):
    return [record.getMessage() for record in caplog.records if record.name.startswith("proprotor.")]


def test_a_study_tells_which_batches_it_keeps_and_which_it_finds(tmp_path, caplog):
    caplog.set_level(logging.INFO, "proprotor")
    study = {"airspeed": 100.0, "checkpoint": tmp_path, "batch": 1, "workers": 1}
    pp.study(CASE, PRECONE, **study)
    assert told(caplog) == [f"kept batch {number} in {tmp_path}" for number in (0, 1)]
    caplog.clear()
    pp.study(CASE, PRECONE, **study)
    assert told(caplog) == [f"found batch {number} of 2 in {tmp_path}" for number in (0, 1)]


def test_a_worker_that_dies_is_told(monkeypatch, caplog):
    """The first process ends at its first batch; another analyses the batch."""
    asked = []

    def ask(batch):
        asked.append(batch)
        if len(asked) == 1:
            raise EOFError
        return batch

    worker = SimpleNamespace(ask=ask, lives=True, end=lambda: None)
    monkeypatch.setattr(Processes, "_begin", lambda self: worker)
    monkeypatch.setattr(Processes, "_release", lambda self, worker, keep=False: None)
    assert list(Processes(None, iter([(7, "batch")]), 1).results()) == [(7, "batch")]
    assert told(caplog) == [f"batch 7 has ended its worker process, 1 of {workers._MOST_DEATHS} times"]


def test_nothing_is_printed_by_itself():
    code = "import logging, proprotor; logging.getLogger('proprotor.study').error('lost'); print(logging.root.handlers)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=os.environ)
    assert (done.stdout.strip(), done.stderr) == ("[]", "")
