"""Pages of the documentation that show the derivation and the audit.

In come the derivation (`derive`) and the audit (`derive.audit`). Out go Markdown pages and pictures in docs/, each
written by a command.

| module | what it makes |
|---|---|
| `display` | an equation, a table or a list as a notebook shows it |
| `chain` | the tools of the cells that a reader may change |
| `figures` | pictures of the notebooks |
| `drawings` | drawings of axes, hinges, gimbal and swashplate, by ``python -m derive.pages.drawings`` |
| `notebooks` | docs/notebooks, by ``python -m derive.pages.notebooks`` |
| `index` | docs/equations.md, by ``python -m derive.pages.index`` |
| `glossary` | docs/symbols.md, by ``python -m derive.pages.glossary`` |

The modules may import anything of `derive`, and of the runtime the style of its plots alone. Nothing else in `derive`
imports them.
"""

__all__ = ["chain", "display", "drawings", "figures", "glossary", "index", "notebooks"]
