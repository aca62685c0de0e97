"""Damaged, strange and hostile inputs: decks, files of supports, airfoil tables.

Whatever a file holds, the package makes a valid object of it or refuses it with an `InputError` of one line for each
problem. It never does anything else: no other exception, no warning, no hang, nothing written outside the output
folder, no process started, nothing of the file executed.

    python -m tests.fuzz --inputs 100000       the campaign (make fuzz)
    python -m tests.fuzz --kind deck --number 1234 --keep folder      one input again

`mutation` has the ways to spoil a text or bytes; `decks`, `supports` and `airfoils` make the files of an input and
use them; `watch` sees what happens meanwhile; `campaign` judges.
"""
