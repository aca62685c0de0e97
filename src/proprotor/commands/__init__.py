"""The command line: a module for each command of `proprotor`, and modules that the commands share.

In come arguments and options; out go tables, JSON, CSV and figures. The commands only read arguments, call an analysis
and show its result; they compute nothing themselves.

    main        the command `proprotor`: the list of commands, and the messages with which an error ends a command
    exit_codes  what the exit code of a command means
    arguments   arguments and options that several commands share; `Request`, the case and options a user asks for
    output      tables, JSON, files and figures; `Outputs`, the files a user asks for
    terminal    the console on which commands print
    worst_of    the option --worst-of of the command boundary
    waiting     a spinner while a step takes more than a second

    cases new describe                              decks
    blade                                           a blade of a deck from a table of stations
    sweep flutter boundary envelope stability_map margins sensitivity attribution study    analyses of a case
    gust                                            what turbulence and single gusts do to a case
    identify calibrate mac                          records, test points and measured modes beside a case
    report explore                                  a page on a case, as a file and with sliders
    export                                          the equations of a case for another program

This room may import all others, and no room imports this one. Packages that are slow to import (rich, pydantic,
matplotlib, bokeh) wait until a command needs them, and a command waits until it is called, so that ``--help`` answers
at once.
"""

__all__ = [
    "attribution",
    "blade",
    "boundary",
    "calibrate",
    "cases",
    "describe",
    "envelope",
    "explore",
    "export",
    "flutter",
    "gust",
    "identify",
    "mac",
    "main",
    "margins",
    "new",
    "report",
    "sensitivity",
    "stability_map",
    "study",
    "sweep",
]
