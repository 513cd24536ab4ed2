"""Renews the tables of pages from what a program prints: `PROGRAM | renew.py PAGE.md ...`.

A fenced block of a page is replaced by the printed paragraph with the same first line. A table is replaced by the printed one whose header is the same, or
begins the same; columns that only the page has stay, row by row. What is replaced is said; the text around it is yours to read.
"""

import re
import sys
from pathlib import Path


def cells(line: str) -> list[str]:
    """The cells of a row of a table."""
    return [cell.strip() for cell in line.strip().strip("|").split("|")]


def words(row: list[str]) -> tuple[str, ...]:
    """What names a row: its cells that do not begin with a number."""
    return tuple(cell for cell in row if not re.match(r"[-+]?[.\d]", cell))


def is_prefix(one: list[str], other: list[str]) -> bool:
    """Whether the shorter row begins the longer one, and has two cells at least."""
    shorter = min(len(one), len(other))
    return shorter > 1 and one[:shorter] == other[:shorter]


def new_table(old: list[str], printed: list[str]) -> list[str]:
    """The printed table, with the columns that only the old one has behind it."""
    more = len(cells(old[0])) - len(cells(printed[0]))
    if more <= 0:
        return printed
    columns = len(cells(printed[0]))
    kept = {words(cells(line)[:columns]): cells(line)[-more:] for line in old[2:]}
    if len(kept) < len(old) - 2:
        sys.exit(f"rows of the table {old[0]} have the same words: which one is kept?")
    rows = [cells(printed[0]) + cells(old[0])[-more:]]
    rows += [row + kept.get(words(row), ["?"] * more) for row in map(cells, printed[2:])]
    text = ["| " + " | ".join(row) + " |" for row in rows]
    return [text[0], old[1], *text[1:]]


def paragraphs(text: str) -> list[list[str]]:
    """Lines between blank lines."""
    return [part.splitlines() for part in re.split(r"\n\s*\n", text.strip("\n")) if part.strip()]


def renewed(page: str, printed: list[list[str]]) -> tuple[str, list[str]]:
    """The page, and the first lines of what was replaced; what was printed is taken once."""
    done = []

    def block(found):
        for lines in printed:
            if lines[0].rstrip() == found[2].splitlines()[0].rstrip():
                printed.remove(lines)
                done.append(lines[0])
                return "\n".join([found[1], *(line.rstrip() for line in lines), "```"])
        return found[0]

    def table(found):
        old = found[0].splitlines()
        for lines in printed:
            rows = [line for line in lines if line.startswith("|")]
            if len(rows) > 2 and is_prefix(cells(old[0]), cells(rows[0])):
                printed.remove(lines)
                done.append(rows[0])
                return "\n".join(new_table(old, rows))
        return found[0]

    page = re.sub(r"^(```\w*)\n((?:(?!```).*\n)+?)```", block, page, flags=re.MULTILINE)
    return re.sub(r"^\|.*(?:\n\|.*)+", table, page, flags=re.MULTILINE), done


def main(names: list[str]) -> None:
    """Reads what was printed, and renews the pages."""
    printed = paragraphs(sys.stdin.read())
    for path in map(Path, names):
        text, done = renewed(path.read_text(), printed)
        if not done:
            sys.exit(f"{path} has nothing of what was printed")
        path.write_text(text)
        print(f"{path}: {len(done)} renewed", *done, sep="\n    ")


if __name__ == "__main__":
    main(sys.argv[1:])
