"""The comparison of generated equations between versions finds what differs. `make verify-versions` uses it."""

import pytest

from tests.verify import determinism


@pytest.fixture(scope="module")
def accepted():
    return {path: (determinism.GENERATED / path).read_text("utf-8") for path in determinism.generated_files()}


def test_every_function_is_compared_and_the_same_files_do_not_differ(accepted):
    functions, worst, where = determinism.compared(accepted, accepted)
    assert functions == sum(text.count("\ndef ") - text.count("\ndef _") for text in accepted.values())
    assert worst == 0 and where == "none"


@pytest.mark.parametrize(
    ("path", "old", "new"),
    [
        ("pitch.py", "pitch_inertia\n", "(1 + 1e-12) * pitch_inertia\n"),
        (
            "multiblade.py",
            "n_blades * (\n        (1 / 2) * mass[..., BLADE_HUB_I",
            "n_blades * (\n        0.500000000001 * mass[..., BLADE_HUB_I",
        ),
        ("airloads.py", "(-(np.swapaxes(", "(1 + 1e-12) * (-(np.swapaxes("),
    ],
)
def test_a_part_in_a_million_million_is_found(accepted, path, old, new):
    assert old in accepted[path]
    other = accepted | {path: accepted[path].replace(old, new, 1)}
    _, worst, where = determinism.compared(accepted, other)
    assert where.startswith(path.removesuffix(".py"))
    assert worst > 5 * determinism.TOLERANCE


def test_another_text_is_shown_as_a_difference(accepted):
    other = accepted | {"trim.py": accepted["trim.py"].replace("import numpy as np", "import numpy", 1)}
    lines = list(determinism.differences(accepted, other))
    assert lines[:2] == ["--- generated/trim.py", "+++ derived/trim.py"]
    assert "-import numpy as np" in lines and "+import numpy" in lines
