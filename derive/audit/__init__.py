"""The print against the derivation: a computed verdict on every equation and table of AIAA-2002-1604.

In come the derivation (`derive`) and the transcription of the paper (`printed`). Out go the verdicts on every term, the
page docs/audit.md and the record tests/golden/audit.csv, all written by ``python -m derive.audit``.

| module | what it does |
|---|---|
| `printed` | the equations and tables as they stand in the paper, as data |
| `counterparts` | what the derivation has for each printed equation |
| `comparison` | the two compared term by term |
| `invariants` | what a printed equation must obey whoever derives it: symmetry, dimensions, rigid motion |
| `tables` | the numbers of the tables compared with each other |
| `consequences` | what a difference does to the stability boundary of the XV-15 |
| `headings` | names of equations and tables, and their anchors in pages |
| `report` | all verdicts as a table, a page and a record |

The modules above import the derivation and one another in the order of the list. `consequences` alone imports
`proprotor`, by its public names.
"""

__all__ = [
    "comparison",
    "consequences",
    "counterparts",
    "headings",
    "invariants",
    "printed",
    "report",
    "tables",
]
