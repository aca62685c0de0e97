"""The chain of each notebook agrees with the derivation, and a sign turned round in it is told."""

import ast

import jupytext
import pytest

from derive.audit.comparison import CONTRADICTS
from derive.pages import notebooks
from derive.pages.display import chain

SOURCES = {source.stem: source for source in notebooks.sources()}
CHAINS = {
    name: "\n".join(
        cell.source for cell in jupytext.read(source).cells if "chain" in cell.metadata.get("tags", ())
    )
    for name, source in SOURCES.items()
}
STATEMENTS = 15  # "a dozen lines", and room for naming what they use
TURNED = {ast.Add: ast.Sub, ast.Sub: ast.Add, ast.USub: ast.UAdd}


def verdicts(tree):
    """Run a chain, and return what its calls of `chain` show, in their order."""
    names = {"__name__": "chain"}
    shown = []
    for statement in tree.body:
        if isinstance(statement, ast.Expr):
            shown.append(eval(compile(ast.Expression(statement.value), "chain", "eval"), names).text)
        else:
            exec(compile(ast.Module([statement], []), "chain", "exec"), names)
    return shown


def signs(tree):
    return [node for node in ast.walk(tree) if type(getattr(node, "op", None)) in TURNED]


def turned(name, place):
    """The chain with one of its signs turned round."""
    tree = ast.parse(CHAINS[name])
    node = signs(tree)[place]
    node.op = TURNED[type(node.op)]()
    return ast.fix_missing_locations(tree)


@pytest.mark.parametrize("name", CHAINS)
def test_a_chain_is_short_and_finds_every_term_of_the_derivation(name):
    tree = ast.parse(CHAINS[name])
    work = [statement for statement in tree.body if not isinstance(statement, (ast.Import, ast.ImportFrom))]
    assert 5 <= len(work) <= STATEMENTS
    shown = verdicts(tree)
    assert shown
    for text in shown:
        assert "those of the derivation: reproduced" in text and CONTRADICTS not in text


EVERY_SIGN = [(name, place) for name, text in CHAINS.items() for place in range(len(signs(ast.parse(text))))]


@pytest.mark.parametrize(("name", "place"), EVERY_SIGN)
def test_a_sign_turned_round_makes_the_audit_fail(name, place):
    text = "\n".join(verdicts(turned(name, place)))
    assert f"**{CONTRADICTS}**" in text and "| this chain | derived |" in text


def test_the_sign_of_the_first_erratum_is_told_where_it_stands():
    """A lag angle turned round turns the Coriolis term of Eq. 13, among others, and leaves those without lag."""
    chain = CHAINS["2-inertia"].replace(
        'kin.lagged(outward, kin.q["lag"])', 'kin.lagged(outward, -kin.q["lag"])'
    )
    (text,) = verdicts(ast.parse(chain))
    assert chain != CHAINS["2-inertia"] and f"**{CONTRADICTS}**" in text
    row = text.splitlines()[-1]
    assert r"\zeta'" in row and r"\beta''" not in row


@pytest.mark.parametrize(
    ("number", "found", "message"),
    [
        (36, {"K_PB": 0}, "found = K_PB: is no part of this equation, which has K_Pβ"),
        (3, {"i": 0, "z": 0}, "found = z: is no part of this equation, which has i, j, k"),
        (3, {}, "found: must give one of the parts i, j, k"),
    ],
)
def test_a_part_that_the_derivation_lacks_is_told(number, found, message):
    """And nothing is no chain whose terms all agree."""
    with pytest.raises(ValueError) as caught:
        chain(number, found)
    assert message in str(caught.value)
