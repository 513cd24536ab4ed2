"""Runs the command line by `python -m contact_normal`. Where the package is installed, the command `contact-normal` does the same."""

import sys

from ._command import main

if __name__ == "__main__":
    sys.exit(main())
