"""Files: what is read from users, written for users, and identified by content.

In: paths, and content to write or to identify. Out: texts, files that are written whole, and fingerprints. This room
imports `errors` and `units` alone.

    text          a text file of a user, read within limits
    csv_columns   a table of a user as CSV: named columns with units, and lines of cells
    json_text     plain data as JSON
    output        write_whole, the one function that writes files, and checks of a path before anything is computed
    fingerprint   a short text that identifies inputs: numbers, arrays, objects, functions
    source_code   a short text that identifies the code of this package

The public names of these modules are the room's face.
"""

__all__ = ["csv_columns", "fingerprint", "json_text", "output", "source_code", "text"]
