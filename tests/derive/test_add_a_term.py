"""The changes that docs/howto/add-a-term.md shows fit the derivation, and do there what the page says."""

import re
import shutil
import subprocess
import sys

import pytest
from proprotor_equations import pitch

from proprotor.rotor.generated import evaluate
from tests.documentation import DOCS, ROOT

TERM, COORDINATE = re.split(
    r"^## A coordinate", (DOCS / "howto" / "add-a-term.md").read_text(encoding="utf-8"), flags=re.MULTILINE
)
DIFF = re.compile(r"^```diff\n(.*?)^```$", re.DOTALL | re.MULTILINE)

# A damper along the stroke ζ + κ β takes C (ζ' + κ β') in lag and κ times that in flap.
A_DAMPER_BY_HAND = """
from derive import equations, pitch
from derive import symbols as s
share = s.flap_in_lag_damper
assert pitch.damping("lag", "lag") == s.lag_damping
assert pitch.damping("lag", "flap") == pitch.damping("flap", "lag") == share * s.lag_damping
assert (pitch.damping("flap", "flap") - s.flap_damping - share**2 * s.lag_damping).expand() == 0
assert share in equations.consistent_functions("pitch")[0].arguments
"""
# The blades do not know whether the yoke moves in the plane of the rotor, or the hub with it.
A_YOKE_MOVES_AS_A_HUB = """
from derive import airloads, equations, inertia, multiblade, pitch
from derive import symbols as s
for yoke, hub in (("yoke_i", "hub_i"), ("yoke_j", "hub_j")):
    for name in ("hub_k", "flap", "lag", "azimuth", "gimbal_flap", "gimbal_roll", yoke):
        for matrix in (inertia.mass, inertia.gyroscopic, inertia.centrifugal_stiffness):
            assert matrix(yoke, name) == matrix(hub, name.replace("yoke", "hub")), name
    for motion in ("ut_0", "up_0", "ur_0", "ut_1"):
        assert airloads.rate_motion(motion, yoke) == airloads.rate_motion(motion, hub)
    assert pitch.stiffness(yoke, yoke) == s.yoke_stiffness / s.n_blades
assert multiblade.transform("yoke_j", "yoke_x") == multiblade.transform("hub_j", "x") != 0
rows = {row for function in equations.consistent_functions("inertia") for row, _ in function.entries}
assert {"yoke_i", "yoke_j"} <= rows
"""


@pytest.mark.parametrize(
    "text, check",
    [(TERM, A_DAMPER_BY_HAND), (COORDINATE, A_YOKE_MOVES_AS_A_HUB)],
    ids=["term", "coordinate"],
)
def test_the_changes_of_the_page(text, check, tmp_path):
    shutil.copytree(ROOT / "derive", tmp_path / "derive", ignore=shutil.ignore_patterns("__pycache__"))
    changes = "".join(DIFF.findall(text))
    assert changes.count("--- a/derive/") == changes.count("--- a/") > 2
    subprocess.run(["git", "apply", "-C1", "-"], cwd=tmp_path, input=changes, text=True, check=True)
    subprocess.run([sys.executable, "-c", check], cwd=tmp_path, check=True)


def test_a_number_that_no_rotor_has_is_told():
    with pytest.raises(KeyError, match=r"pitch\.damping takes 'n_blades', which nothing gives"):
        evaluate(pitch.damping, {"lag_damping": 1.0})
