"""The gallery: every example program with what it is about, and the pictures that it draws."""

import ast
import re
from pathlib import Path

from pictures import EXAMPLES

LANGUAGES = {"C": ("c_examples", ".c"), "C++": ("cxx_examples", ".cpp"), "Fortran": ("fortran_examples", ".f90"), "Python": ("python_examples", ".py")}


def first_sentence(text: str) -> str:
    """Of a comment, in one line; commands are left out."""
    told = " ".join(re.sub(r"^[!/* ]+", "", line) for line in text.strip().splitlines())
    told = re.split(r" `python3|  |(?<=[a-z)])\. (?=[A-Z`])| Usage:", told)[0].strip().rstrip(".")
    return told.replace("*", "\\*")


def comment(path: Path) -> str:
    """What a program says of itself at its beginning."""
    text = path.read_text()
    if path.suffix == ".py":
        return ast.get_docstring(ast.parse(text)) or ""
    pattern = {".c": r"/\*(.*?)\*/", ".cpp": r"((?://.*\n)+)", ".f90": r"((?:!.*\n)+)"}[path.suffix]
    return re.match(pattern, text, re.DOTALL if path.suffix == ".c" else 0).group(1)


def page(root: Path) -> str:
    """The page: cards with pictures, and a table of all programs."""
    out = []
    for name in EXAMPLES:
        out += [f"## {name}", "", first_sentence(comment(root / "python_examples" / f"{name}.py")) + ".", ""]
        found = [stem for stem in sorted(path.stem for path in (root / "docs" / "pictures").glob("*.svg")) if stem in EXAMPLES[name].pictures]
        if not found:
            raise ValueError(f"no picture of {name} in docs/pictures")
        out += [line for stem in found for line in (f"![{stem.replace('_', ' ')}](../../pictures/{stem}.svg)", "")]
        out += [f"Program: [`python_examples/{name}.py`](../../../python_examples/{name}.py)", ""]
    out += ["## All programs", "", "| example | | |", "|---|---|---|"]
    programs: dict[str, dict[str, Path]] = {}
    for language, (folder, ending) in LANGUAGES.items():
        for path in sorted((root / folder).glob(f"*{ending}")):
            programs.setdefault(path.stem, {})[language] = path
    for name, of in sorted(programs.items()):
        links = ", ".join(f"[{language}](../../../{path.relative_to(root)})" for language, path in of.items())
        out.append(f"| {name} | {first_sentence(comment(next(iter(of.values()))))} | {links} |")
    return "\n".join(["# Gallery", "", "Every example program prints the file `.expected` beside it. `make pictures` draws the pictures.", "", *out, ""])
