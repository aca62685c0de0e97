"""Accept the modes of the model as it is, and tell what moved.

python -m tests.accept_golden
"""

from tests.golden import switches


def main() -> None:
    was = switches.kept() if switches.FILE.exists() else {}
    now = switches.computed()
    if found := switches.changes(was, now):
        print(switches.told(found, len(now)))
    if found or set(was) != set(now):
        switches.keep(switches.accepted(was, now))
        print(f"written: {switches.FILE.name}")
    else:
        print("nothing moved; the file is as it was")


if __name__ == "__main__":
    main()
