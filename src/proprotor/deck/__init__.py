"""Decks: text to configuration, and configuration back to text.

In come the name or path of a deck, a TOML file, and settings for single fields; out goes a configuration of the kind
asked for, with the source of every number, or the text of a deck and the description of its fields.

    file                find and read deck files, with the deck that each alters
    alternatives        fields that exclude each other, and how a variant replaces them
    default_provenance  a status and source for all numbers of one file
    written             texts whose meaning depends on their file: names of files, frequencies per revolution
    per_revolution      the rotor speed of each frequency per revolution
    reading             one number: text to SI, with status and source
    reading_lists       lists of numbers: curves, distributions along blade or wing
    stations            distributions in a CSV file
    blade_file          the stations of an elastic blade in a CSV file
    fields              types of fields: form, unit, bound
    sections            the sections of a deck, their fields and the meaning of each
    support_sections    the section [support], one set of fields for each kind
    envelope_sections   the sections [envelope] and [variants.NAME]
    control_sections    the section [control]: control loops
    tables              walk nested tables
    text                printable text, prose on one line
    validation          check tables against the sections, a line for each problem
    settings            set single fields before a deck is validated
    numbers             the numbers of a deck by path
    build               rotor, operation and support from numbers
    build_support       the support from numbers and files
    build_airfoil       the airfoil, or the airfoils by region of the span
    build_aircraft      the airframe of a whole aircraft from numbers
    build_control       control loops from a deck, and their numbers by path
    each_design         each different design of a batch, built once
    left_out            numbers that a deck leaves out, at their defaults
    left                what differs on the left side of an aircraft
    input_values        values of an input in every form that a deck takes
    vary                other designs: other values for numbers of the deck
    conditions          the conditions of an envelope: the deck and its variants, each as a case
    describe            every field in words
    fields_page         docs/decks.md
    schema              the JSON schema, for editors
    template            a deck as commented text
    decks/              the bundled decks

The room may import the ground (`errors`, `typing`, `needs`, `units`, `datum`, `files`), `rotor`, `support` and `model`.
`fields` and the modules that import it need pydantic, which is slow to import: `build.load` imports them when called.
"""

from proprotor.deck.build import load
from proprotor.deck.file import list_cases, read_tables
from proprotor.deck.input_values import input_values, shown_unit
from proprotor.deck.per_revolution import as_one_file
from proprotor.deck.vary import (
    added_loops,
    check_input,
    design_inputs,
    inputs_at,
    varied_numbers,
    vary,
    with_control,
)
from proprotor.deck.written import FilePath, PerRevolution

__all__ = [
    "FilePath",
    "PerRevolution",
    "added_loops",
    "as_one_file",
    "blade_file",
    "check_input",
    "conditions",
    "describe",
    "design_inputs",
    "fields_page",
    "input_values",
    "inputs_at",
    "list_cases",
    "load",
    "read_tables",
    "schema",
    "settings",
    "shown_unit",
    "template",
    "validation",
    "varied_numbers",
    "vary",
    "with_control",
]
