"""The page on other programs: its code runs as it stands, its deck and its file of stations are read."""

import re
from pathlib import Path

import numpy as np
import pytest

import proprotor as pp

PAGE = (Path(__file__).parents[1] / "docs" / "interoperability.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
TABLES = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)


def test_the_code_runs_as_it_stands(tmp_path, monkeypatch, capsys):
    pytest.importorskip("openmdao.api")
    monkeypatch.chdir(tmp_path)
    assert len(BLOCKS) == 5
    names = {}
    for block in BLOCKS:
        exec(block, names)
    assert capsys.readouterr().out
    assert {"xv15.mat", "sweep.mat"} <= {path.name for path in tmp_path.iterdir()}


def test_the_decks_are_read(tmp_path):
    stations = re.search(r"^    (r \[ft\].*?)\n\n", PAGE, re.DOTALL | re.MULTILINE)[1]
    (tmp_path / "stations.csv").write_text(re.sub(r"(?m)^ +", "", stations))
    deck = tmp_path / "page.toml"
    deck.write_text('base = "xv15"\n[case]\nname = "page"\n' + "\n".join(TABLES))
    case = pp.load_case(deck)
    assert len(TABLES) == 2
    np.testing.assert_allclose(case.rotor.chord[1], np.array([17.0, 14.5, 14.0]) * 0.0254)
    assert case.sources["operation.density"].status == "derived"
