"""Mutation of the equations: does a wrong sign, a missing term or one per cent in any generated expression go unseen?

`mutants` makes the wrong functions, `checks` holds what must notice them, `survey` runs one against the other,
`python -m tests.mutation` writes the report.
"""
