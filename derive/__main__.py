"""Regenerate ``generated/proprotor_equations``, or with ``--check`` compare it with the derivation."""

import argparse
import sys

from derive import emit


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m derive", description=__doc__)
    parser.add_argument(
        "--check", action="store_true", help="change nothing; exit 1 if a generated file differs"
    )
    if not parser.parse_args().check:
        try:
            emit.update()
        except OSError as error:
            print(f"the equations cannot be written ({error.strerror or error})", file=sys.stderr)
            return 1
        return 0
    found = emit.differences()
    for difference in found:
        print(difference)
    print("generated files differ from the derivation" if found else "generated files match the derivation")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
