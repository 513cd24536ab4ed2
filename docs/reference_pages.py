"""Draws the pages of the reference: C and Fortran from include/, Python's list of names from the package.

The header and the module are regular: a comment stands before what it is about. The header is generated; a test compares it with src/ffi.
"""

import argparse
import importlib
import inspect
import re
from pathlib import Path


def write(root: Path, folder: Path) -> None:
    """Writes c.md, fortran.md, python_members.txt and command_line.txt into `folder`."""
    include = root / "include"
    folder.mkdir(parents=True, exist_ok=True)
    page = c_page((include / "contact_normal.h").read_text(), Examples(root, "c_examples", "*.c"))
    (folder / "c.md").write_text(page)
    parts = [include / "contact_normal.f90", *sorted(include.glob("*.inc"))]
    page = fortran_page([part.read_text() for part in parts], Examples(root, "fortran_examples", "*.f90"))
    (folder / "fortran.md").write_text(page)
    (folder / "python_members.txt").write_text(python_members())
    (folder / "command_line.txt").write_text(command_line())


class Examples:
    """The example programs of a language."""

    def __init__(self, root: Path, folder: str, files: str) -> None:
        self.texts = {f"{folder}/{path.name}": path.read_text() for path in sorted((root / folder).glob(files))}

    def of(self, name: str) -> list[str]:
        """A line that names up to three examples in which a procedure is called."""
        using = [path for path, text in self.texts.items() if re.search(rf"\b{name}\b *\(", text)][:3]
        return ["Example: " + ", ".join(f"[`{path}`](../../../{path})" for path in using) + ".", ""] if using else []


def escaped(text: str) -> str:
    """Text for a cell of a table: formulas with bars and underscores stay as they are."""
    return text.replace("|", "\\|").replace("*", "\\*").replace("$", "\\$")


def joined(comment: str) -> str:
    """A comment in one line."""
    return " ".join(comment.split())


def paragraphs(comment: str) -> str:
    """A comment as paragraphs."""
    lines = [line.strip() for line in comment.strip().splitlines()]
    text = "\n".join(lines)
    return "\n\n".join(joined(part) for part in text.split("\n\n")).replace("*", "\\*")


def c_page(header: str, examples: Examples) -> str:
    """The page of the C reference."""
    out = ["# C", "", "Drawn from `include/contact_normal.h`. [Conventions](../../conventions.md) has what holds for every call.", ""]
    functions, structs, constants, others = [], [], [], []
    for comment, code in re.findall(r"/\*\n(.*?)\*/\n(.*?)(?=\n\n|\n/\*)", header, re.DOTALL):
        if code.startswith("#define"):
            constants.append((comment, *code.split()[1:3]))
        elif re.match(r"typedef struct \w+ \{", code):
            structs.append((comment, code.split()[2]))
        elif code.startswith("typedef"):
            others.append((comment, code))
        elif re.match(r"[\w ]+\*?contact_normal_\w+\(", code):
            functions.append((comment, code))
    out += ["## Functions", ""]
    for comment, code in functions:
        name = re.search(r"(contact_normal_\w+)\(", code).group(1)
        out += [f"### {name}", "", "```c", code, "```", "", paragraphs(comment), "", *examples.of(name)]
    out += ["## Structs", ""]
    for comment, name in structs:
        body = re.search(rf"typedef struct {name} \{{\n(.*?)\n\}} {name};", header, re.DOTALL).group(1)
        out += [f"### {name}", "", paragraphs(comment), "", "| member | |", "|---|---|"]
        for told, code in re.findall(r"/\*\n(.*?)\*/\n(.*?);", body, re.DOTALL):
            out.append(f"| `{joined(code)}` | {escaped(joined(told))} |")
        out.append("")
    out += ["## Callbacks and handles", ""]
    for comment, code in others:
        out += ["```c", code, "```", "", paragraphs(comment), ""]
    out += ["## Constants", "", "| constant | value | |", "|---|---:|---|"]
    out += [f"| `{name}` | {value} | {escaped(joined(comment))} |" for comment, name, value in constants]
    if len(functions) < 20 or len(structs) < 10 or len(constants) < 30:
        raise ValueError(f"the header was not understood: {len(functions)} functions, {len(structs)} structs")
    return "\n".join(out) + "\n"


def fortran_page(parts: list[str], examples: Examples) -> str:
    """The page of the Fortran reference."""
    module = "\n".join(parts)
    out = ["# Fortran", "", "Drawn from `include/contact_normal.f90`. What a structure's components mean is said in the",
           "[C reference](c.md), whose names are the same; `use contact_normal` gives all of it.", ""]
    head = re.match(r"((?:!.*\n)+)", module).group(1)
    out += [re.sub(r"^! ?", "", line) for line in head.splitlines()[3:] if not line.startswith("!   gfortran")] + [""]
    found = re.findall(r"((?:^ *!.*\n)+)^ *((?:pure |elemental )*(?:subroutine|function) .*?\))((?: bind| result).*?)?$",
                       re.sub(r" *&\n *", " ", module), re.MULTILINE)
    named: dict[str, tuple[str, str]] = {}
    for comment, code, _rest in found:
        name = re.search(r"(?:subroutine|function) (\w+)", code).group(1)
        # norm_solve and tang_solve are there twice: the module's have the longer comments.
        if name.startswith(("contact_normal_", "norm_solve", "tang_solve")) and len(comment) > len(named.get(name, ("", ""))[0]):
            named[name] = (comment, code)
    out += ["## Procedures", ""]
    for name, (comment, code) in named.items():
        told = "\n".join(re.sub(r"^ *! ?", "", line) for line in comment.splitlines())
        aligned = re.search(r"^ {2,}\S", told, re.MULTILINE)
        text = f"```text\n{told}\n```" if aligned else paragraphs(told)
        out += [f"### {name}", "", "```fortran", re.sub(r"\s+", " ", code), "```", "", text, "", *examples.of(name)]
    listed = re.findall(r"^ *public :: (.*)$", re.sub(r" *&\n *", " ", module), re.MULTILINE)
    public = {name for names in listed for name in re.findall(r"\w+", names)}
    if public != set(named):
        raise ValueError(f"the module was not understood: {sorted(public ^ set(named))}")
    return "\n".join(out) + "\n"


def python_members() -> str:
    """Directives for every public name of the package: functions, the solver, and what they take, return and raise."""
    package = importlib.import_module("contact_normal")
    functions, classes, told = [], [], set()
    for name in package.__all__:
        member = getattr(package, name)
        if inspect.isclass(member):
            members = "" if issubclass(member, (tuple, dict, Exception)) else "   :members:\n"
            # What classes have in common stands with the first of them.
            hidden = {base for base in member.__bases__ if base.__module__.startswith("contact_normal._") and base.__name__ not in package.__all__}
            if hidden - told:
                members += "   :inherited-members:\n"
            told |= hidden
            classes.append((name, f".. autoclass:: {name}\n{members}\n"))
        elif inspect.isfunction(member) and member.__name__ == name:
            functions.append((name, f".. autofunction:: {name}\n\n"))
    first = ["solve", "Solver", "Result", "SolveOptions"]
    order = {name: place for place, name in enumerate(first)}
    listed = sorted([*functions, *classes], key=lambda each: order.get(each[0], len(first) + (each in classes)))
    return ".. py:module:: contact_normal\n\n" + "".join(directive for _, directive in listed)


def command_line() -> str:
    """The help of every command, as a terminal shows it."""
    top = importlib.import_module("contact_normal._command").parser()
    commands = next(action for action in top._actions if isinstance(action, argparse._SubParsersAction)).choices
    for one in (top, *commands.values()):
        one.formatter_class = lambda prog, base=one.formatter_class: base(prog, width=100)
    return "\n\n".join(f"$ {one.prog} --help\n{one.format_help()}" for one in (top, *commands.values()))
