"""Damaged, strange and hostile inputs: decks, files of supports, airfoil tables, files of Nastran.

Whatever a file holds, the package makes a valid object of it or refuses it with an `InputError` of one line for each
problem. It never does anything else: no other exception, no warning, no hang, nothing written outside the output
folder, no process started, nothing of the file executed.

    python -m tests.fuzz --inputs 100000       the campaign (make fuzz)
    python -m tests.fuzz --kind deck --number 1234 --keep folder      one input again

What catches each of the things an input may not do:

crash
    An exception that is no `InputError`, a warning (an error here), a result that is not finite or not of its shape:
    "fault", by `campaign`. A process that dies, or asks for more than 4 GiB: "crash", by the process that started it,
    which names the input and goes on with the next share.
hang
    "too slow", by `watch`: 10 s of processor time, whatever else the machine does, or 120 s of the clock for what
    waits and does not work. What holds on to the interpreter, so that Python cannot be interrupted: the process is
    ended after 300 s without a verdict, with its traceback, and counts as a crash.
writing outside the output folder
    "breach", by the audit hook of `watch`, which sees every file opened to be written, removed, moved or changed, and
    stops it before it happens; and by comparing the folder of the input, which is the current one, with what was put
    there, for what C code writes without Python.
running code of the input
    "breach", by the same hook: compile, exec, import, marshal, unpickling, ctypes, a shell, a process, a socket, a
    signal. Everything a reader needs has been imported by a warm-up before.

`test_fuzz` does each of these deeds and sees it caught.

`mutation` has the ways to spoil a text or bytes; `decks`, `supports`, `structures`, `airfoils` and `nastran` make the
files of an input and use them; `watch` sees what happens meanwhile; `campaign` judges.
"""
