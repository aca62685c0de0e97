"""The command ``python -m derive.audit``: see `derive.audit.report`."""

import sys

from derive.audit.report import main

if __name__ == "__main__":
    sys.exit(main())
