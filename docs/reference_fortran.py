"""The pages of the Fortran reference: plain calls, setters, and the calls of the library by noun."""

import re

from reference_c import NOUNS, noun_of
from reference_text import Examples, paragraphs


def pages(module: str, examples: Examples) -> dict[str, str]:
    """The pages by name, and the page that lists them."""
    module = re.sub(r" *&\n *", " ", module)
    found = procedures(module)
    listed = re.findall(r"^ *public :: (.*)$", module, re.MULTILINE)
    public = {name for names in listed for name in re.findall(r"\w+", names)}
    if public != set(found):
        raise ValueError(f"the module was not understood: {sorted(public ^ set(found))}")
    parts: dict[str, list[str]] = {}
    for name, (comment, code) in found.items():
        parts.setdefault(part_of(name), []).extend(procedure(name, comment, code, examples))
    titles = {"norm_solve": "norm_solve", "tang_solve": "tang_solve", "setters": "Setters", **{noun: title for noun, (title, *_) in NOUNS.items()}}
    order = [part for part in titles if part in parts]
    named = {f"fortran_{part}.md": "\n".join([f"# {titles[part]}", "", *parts[part]]) + "\n" for part in order}
    return {"fortran.md": index(module, {f"fortran_{part}": titles[part] for part in order}), **named}


def procedures(module: str) -> dict[str, tuple[str, str]]:
    """The comment and the code of each public procedure."""
    found = re.findall(r"((?:^ *!.*\n)+)^ *(?:recursive )?((?:pure |elemental )*(?:subroutine|function) .*?\))((?: bind| result).*?)?$", module, re.MULTILINE)
    named: dict[str, tuple[str, str]] = {}
    for comment, code, _rest in found:
        name = re.search(r"(?:subroutine|function) (\w+)", code).group(1)
        # norm_solve and tang_solve are there twice: the module's have the longer comments.
        if name.startswith(("contact_normal_", "norm_solve", "tang_solve")) and len(comment) > len(named.get(name, ("", ""))[0]):
            named[name] = (comment, code)
    return named


def part_of(name: str) -> str:
    """The page of a procedure."""
    if name in ("norm_solve", "tang_solve"):
        return name
    if name.startswith("contact_normal_set_") and not name.startswith(("contact_normal_set_option", "contact_normal_set_cycle_option")):
        return "setters"
    return noun_of(name, is_struct=name.endswith("_init"))


def procedure(name: str, comment: str, code: str, examples: Examples) -> list[str]:
    """A procedure, with its comment as paragraphs, or as it is where columns are aligned."""
    told = "\n".join(re.sub(r"^ *! ?", "", line) for line in comment.splitlines())
    aligned = re.search(r"^ {2,}\S", told, re.MULTILINE)
    text = f"```text\n{told}\n```" if aligned else paragraphs(told)
    return [f"## {name}", "", "```fortran", re.sub(r"\s+", " ", code), "```", "", text, "", *examples.of(name)]


def index(module: str, titles: dict[str, str]) -> str:
    """The page that lists the others, with the rules at the head of the module."""
    head = re.match(r"((?:!.*\n)+)", module).group(1).splitlines()[3:]
    lines = [re.sub(r"^! ?", "", line) for line in head if not line.startswith(("!   gfortran", "! Compile", "! The files"))]
    rules = re.sub(r"\n  \* ", "\n- ", "\n" + "\n".join(lines)).replace("\n    ", "\n  ").replace(":\n-", ":\n\n-", 1)
    return "\n".join([
        "# Fortran", "", "Drawn from `include/contact_normal.f90`. The [C reference](c.md) has the meaning of each component; names are the same.",
        rules, "", "| page |", "|---|", *(f"| [{title}]({name}.md) |" for name, title in titles.items()), "",
        "```{toctree}", ":hidden:", "", *titles, "```", "",
    ])
