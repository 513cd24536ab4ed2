"""The command line: `contact-normal solve`, `prices`, `bill`, `creep-table`, `replay`."""

from __future__ import annotations

import argparse
import io
import os
import re
import sys
import warnings
from collections.abc import Sequence

from . import _command_bill, _command_prices, _command_replay, _command_solve, _command_table
from ._library import VERSION, ContactNormalError

# The exit codes. The page on the command line has the same table.
STOPPED_EARLY, REFUSED, NO_FILE, INTERRUPTED, READER_GONE = 1, 3, 4, 130, 141
_CODES = """\
exit codes:
  0    done; of a solve: its contact conditions hold to the tolerance
  1    stopped early: the best so far is printed and written; of replay: another status than that of the file
  2    the options are wrong; of replay: the file is no dump
  3    refused: the scene, a value or a file's contents; the message names the rule
  4    a file cannot be read or written, or a package or program that this needs is not installed
  128+ of replay: the signal of this number more ended the program
  130  interrupted
  141  the program that read the output, as head, ended before
"""


def parser() -> argparse.ArgumentParser:
    """The parser of all commands."""
    top = argparse.ArgumentParser(
        prog="contact-normal", description="Where two elastic bodies touch when they are pressed together, and with what pressure.",
        epilog=_CODES, formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    top.add_argument("--version", action="version", version=f"contact-normal {VERSION}")
    commands = top.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for module in (_command_solve, _command_prices, _command_bill, _command_table, _command_replay):
        module.add(commands)
    for command in commands.choices.values():
        # Older versions of argparse take -1e-6 for an option, and all versions take -1:1:3 for one.
        command._negative_number_matcher = re.compile(r"-(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?([:,].*)?$")
    return top


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs one command; returns the exit code.

    Parameters
    ----------
    arguments : sequence of str, optional
        By default the arguments of the process.
    """
    given = parser().parse_args(arguments)
    if isinstance(sys.stdout, io.TextIOWrapper):
        # A character that the terminal cannot show, as a micro sign, must not turn a finished solve into an error.
        sys.stdout.reconfigure(errors="replace")
    try:
        with warnings.catch_warnings():
            warnings.showwarning = lambda message, *place, **more: print(f"contact-normal: {message}", file=sys.stderr)
            code = int(given.run(given))
        if sys.stdout is not None:
            sys.stdout.flush()
        return code
    except BrokenPipeError:
        # The program that reads the output, as `head`, has ended. Without this line Python would report the error again when it closes stdout.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return READER_GONE
    except (ContactNormalError, ValueError, TypeError, OverflowError) as error:
        return _failed(error, REFUSED)
    except MemoryError as error:
        return _failed(": ".join(text for text in ("out of memory", str(error)) if text), REFUSED)
    except (OSError, ImportError) as error:
        return _failed(error, NO_FILE)
    except KeyboardInterrupt:
        return _failed("interrupted", INTERRUPTED)


def _failed(why: object, code: int) -> int:
    print(f"contact-normal: {why}", file=sys.stderr)
    return code
