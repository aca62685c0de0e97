"""What the README points to exists. Its code runs in tests/project/test_docs_code.py."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
MAKEFILE = (ROOT / "Makefile").read_text(encoding="utf-8")


def test_folders_of_the_readme_exist():
    targets = re.findall(r"^\| `([^`]+)`", README, re.MULTILINE)
    assert len(targets) > 4
    for target in targets:
        assert (ROOT / target).exists(), target


def test_make_targets_named_in_the_readme_exist():
    named = set(re.findall(r"make ([a-z-]+)`", README)) | set(
        re.findall(r"^ +make ([a-z-]+)$", README, re.MULTILINE)
    )
    assert {"test", "verify", "docs"} <= named
    for target in named:
        assert re.search(rf"^{target}:", MAKEFILE, re.MULTILINE), target


def test_the_readme_is_short():
    assert len(README.splitlines()) < 100
