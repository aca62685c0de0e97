"""Accept the modes of the model as it is, and tell what moved.

python -m tests.accept_golden
"""

import sys

from tests.golden import decks, switches
from tests.golden.modes import Modes, Record, accepted, changes


def main() -> None:
    for source in (switches, decks):
        try:
            accept(source.RECORD, source.computed())
        except OSError as error:
            sys.exit(f"{source.RECORD.file} cannot be written ({error.strerror or error}); it is as it was")


def accept(record: Record, now: Modes) -> None:
    """Put these modes into the file of a record, and print what they change.

    Raises
    ------
    OSError
        When the file cannot be written; it then is as it was.
    """
    was = record.kept()
    if found := changes(was, now):
        print(record.told(found, len(now)))
    if found or set(was) != set(now):
        record.keep(accepted(was, now))
        print(f"written: {record.file.name}")
    else:
        print(f"nothing moved; {record.file.name} is as it was")


if __name__ == "__main__":
    main()
