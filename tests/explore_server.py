"""The server of the explorer in a process of its own, for tests."""

import os
import subprocess
import sys
from contextlib import contextmanager

_COMMAND = "from proprotor.commands.main import main; main()"


@contextmanager
def serving(*arguments):
    """Address of a page on a free port of this machine."""
    command = [sys.executable, "-c", _COMMAND, "explore", *arguments, "--port", "0", "--no-browser"]
    started = subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        env=os.environ | {"COLUMNS": "200"},
    )
    try:
        for line in started.stdout:
            if line.startswith("http://"):
                yield line.split()[0]
                return
        raise AssertionError("the server did not start")
    finally:
        started.terminate()
        started.wait(timeout=30)
        started.stdout.close()
