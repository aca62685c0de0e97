"""Every command without any extra: it runs, or says which extra it needs before anything is computed.

    python -m tests.extras FOLDER [PACKAGE ...]

Runs the commands in a folder; packages that are named count as not installed. Needs the package and click alone, so
that it runs in an environment that has no more.
"""

import math
import os
import sys
from collections.abc import Iterable
from pathlib import Path

from click.testing import CliRunner

CASE = "xv15-uncoupled"
SPEED = ("--speed", "100:200:50kt")
RANGE = ("--vary", "rotor.precone=1:2:1 deg")
SAMPLE = ("--vary", "rotor.precone=1:2 deg", "--sample", "saltelli", "--size", "2")
STATIONS = """r [m],mass [kg/m],EI_flat [N*m**2],EI_edge [N*m**2],GJ [N*m**2],twist [deg],chord [m],pitch_inertia [kg*m]
0.2,12,2e7,2e7,2e5,28,0.35,0.09
0.28,12,3e3,1.2e4,2e5,28,0.35,0.09
0.36,12,2e7,2e7,2e5,27,0.35,0.09
3.8,12,2e7,2e7,2e5,0,0.35,0.09
"""
ENVELOPE = (
    *("--set", "envelope.dive_speed=200 keas", "--scan", "150:240:45keas"),
    *("--set", 'envelope.altitudes={value=[0, 1000], unit="ft"}'),
)
DECAY = "time [s],a\n" + "".join(
    f"{0.02 * k},{math.exp(-0.5 * 0.02 * k) * math.cos(20 * 0.02 * k) + 1e-3 * (k % 3)}\n" for k in range(200)
)
POINTS = """airspeed [ktas],frequency [Hz],frequency_error,mode
200,3.2,0.1,beam
250,3.2,0.1,beam
"""
CLOSED = f"""base = "{CASE}"
[case]
name = "closed"
[[control.loops]]
name = "hold"
sensors = ["x rate"]
inputs = ["cyclic_1c"]
gain = -0.001
"""
BLADE = ("--at-rotor-speed", "458 rpm", "--collective", "10:50:20 deg", "--control-stiffness", "3e4 N*m/rad")
# Each command as it needs no extra.
PLAIN = {
    "cases": (CASE,),
    "blade": ("stations.csv", *BLADE),
    "new": ("new.toml",),
    "describe": ("rotor.precone",),
    "sweep": (CASE, *SPEED, "--csv", "sweep.csv", "--plot", "sweep.png"),
    "flutter": (CASE, "--scan", "300:400:50kt"),
    "margins": ("closed.toml", *SPEED, "--csv", "margins.csv", "--plot", "margins.png"),
    "boundary": (CASE, "--against", "rotor.precone=1:2:1 deg", "--scan", "300:400:50kt"),
    "envelope": (CASE, *ENVELOPE),
    "map": (CASE, "--x", "rotor.precone=1:2:1 deg", "--y", "airspeed=300:400:100kt"),
    "sensitivity": (CASE, "--wrt", "rotor.precone", "--scan", "300:400:50kt"),
    "attribution": (CASE, "--mode", "chord", "--speed", "200 kt"),
    "gust": (CASE, "--speed", "200 kt", "--output", "force_x", "--plot", "gust.png"),
    "identify": ("decay.csv",),
    "calibrate": (
        CASE,
        "--to",
        "points.csv",
        "--input",
        "support.modes[beam].frequency",
        "--out",
        "fitted.toml",
    ),
    "mac": (CASE, "xv15", "--plot", "mac.png"),
    "report": (CASE, "--out", "report.html"),
    "study": (CASE, *RANGE, "--speed", "200 kt", "--out", "study.nc"),
    "export": (CASE, "rotor.mat", "--speed", "200 kt"),
    "explore": ("--help",),
}
# Each command as it needs one, and the extra.
NEEDING = {
    "explore": ("explore", (CASE, "--no-browser")),
    "report": ("report", (CASE, "--out", "missing.pdf")),
    "study": ("study", (CASE, *SAMPLE, "--speed", "200 kt")),
}


class _Without:
    """A finder of modules that does not find some packages."""

    def __init__(self, finder: object, hidden: Iterable[str]) -> None:
        self.finder, self.hidden = finder, frozenset(hidden)

    def __getattr__(self, name: str) -> object:
        return getattr(self.finder, name)

    def find_spec(self, name: str, *more: object) -> object:
        hidden = name.partition(".")[0] in self.hidden
        return None if hidden else self.finder.find_spec(name, *more)


def hide(packages: Iterable[str]) -> None:
    """Let packages count as not installed for the rest of the process."""
    sys.meta_path[:] = [_Without(finder, packages) for finder in sys.meta_path]


def main(folder: str, *hidden: str) -> int:
    """Run every command; an assertion fails at the first that does something else."""
    os.environ["MPLBACKEND"] = "Agg"
    hide(hidden)
    from proprotor.case import Case
    from proprotor.commands.main import main as proprotor

    assert set(PLAIN) == set(proprotor.commands), set(PLAIN) ^ set(proprotor.commands)
    os.chdir(folder)
    texts = {"stations.csv": STATIONS, "decay.csv": DECAY, "points.csv": POINTS, "closed.toml": CLOSED}
    for name, text in texts.items():
        Path(name).write_text(text, encoding="utf-8")
    linearize, computed = Case.linearize, []
    for command, words in PLAIN.items():
        done = CliRunner().invoke(proprotor, [command, *words])
        assert done.exit_code == 0, (command, done.output, done.exception)
    Case.linearize = lambda *given, **more: computed.append(given) or linearize(*given, **more)
    made = set(os.listdir())
    for command, (extra, words) in NEEDING.items():
        done = CliRunner().invoke(proprotor, [command, *words])
        told = f'pip install "proprotor[{extra}]"'
        assert done.exit_code == 2 and told in done.stderr, (command, done.output, done.exception)
        assert len(done.stderr.splitlines()) == 1, done.stderr
    assert not computed and set(os.listdir()) == made
    print(f"{len(PLAIN)} commands run without an extra, {len(NEEDING)} say which they need")
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
