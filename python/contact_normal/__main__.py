"""`python -m contact_normal`: the command line, `contact-normal` where the package is installed."""

import sys

from ._command import main

if __name__ == "__main__":
    sys.exit(main())
