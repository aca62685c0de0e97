"""Files: what is read from users, written for users, and identified by content.

In: paths, and content to write or to identify. Out: texts, files that are written whole, and fingerprints. This room
imports `errors` alone.

    text          a text file of a user, read within limits
    output        write_whole, the one function that writes files, and checks of a path before anything is computed
    fingerprint   a short text that identifies inputs: numbers, arrays, objects, functions
    source_code   a short text that identifies the code of this package

The public names of these modules are the room's face.
"""

__all__ = ["fingerprint", "output", "source_code", "text"]
