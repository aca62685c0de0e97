"""Accept the modes of the model as it is, and tell what moved.

python -m tests.accept_golden
"""

import sys

import proprotor as pp
from tests.golden.combinations import computed, record
from tests.golden.modes import Modes, Record, accepted, changes


def main() -> None:
    for deck in pp.list_cases():
        kept = record(deck)
        try:
            accept(kept, computed(deck))
        except OSError as error:
            sys.exit(f"{kept.file} cannot be written ({error.strerror or error}); it is as it was")


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
