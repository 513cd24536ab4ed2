"""The pages of the C reference, one for each noun."""

import re

from reference_text import Examples, escaped, joined, paragraphs

# Of each page its title, what it is about, and which structs and functions it has, by the beginnings of their names.
NOUNS = {
    "solve": ("Solve", "One scene: fields, report and ledger.", ("fields", "ledger", "report", "solve")),
    "scene": ("Scene and effects", "What is simulated. An effect is a pointer in the scene; NULL: not simulated.", ()),
    "options": ("Options and progress", "How a scene is solved.", ("cycle", "options", "progress", "set_option", "set_cycle_option")),
    "solver": ("Solver", "A handle for many solves on one grid.", ("solver",)),
    "tangential": ("Tangential problems", "Tractions of given pressures.", ("friction_results", "solve_tangential")),
    "accuracy": ("Accuracy and its price", "A target in the place of a grid.", ("accuracy", "price", "solve_to_accuracy", "cost_of_accuracy", "surface", "quantit")),
    "effects_bill": ("The bill of effects", "Which effects a scene calls for.", ("effects",)),
    "adhesion": ("Adhesion", "Attraction across the gap.", ("adhesion", "pull_off")),
    "stress": ("Stresses below the surface", "From pressures and tractions.", ("stress", "subsurface")),
    "heat": ("Flash temperature", "From the heat of friction.", ("heat", "flash")),
    "wear": ("Wear", "From the work of friction.", ("wear", "worn")),
    "closed_forms": ("Closed forms", "Hertz, influence coefficients, coatings.", ("hertz", "influence_half_space", "influence_rolling", "coating_compliance")),
    "library": ("The library", "Versions, statuses, log, memory.", ()),
}


def noun_of(name: str, is_struct: bool) -> str:
    """The page of a struct or a function: that with the longest fitting beginning. Other structs are effects, other functions the library's."""
    name = name.removeprefix("contact_normal_")
    fitting = [(len(start), noun) for noun, (_, _, starts) in NOUNS.items() for start in starts if name.startswith(start)]
    return max(fitting)[1] if fitting else "scene" if is_struct else "library"


def pages(header: str, examples: Examples) -> dict[str, str]:
    """The pages by name, and the page that lists them."""
    found = {noun: [f"# {title}", "", about, ""] for noun, (title, about, _) in NOUNS.items()}
    constants, counts = [], {"functions": 0, "structs": 0}
    entries = re.findall(r"/\*\n(.*?)\*/\n(.*?)(?=\n\n|\n/\*)", header, re.DOTALL)
    # Functions first, those that fill a struct behind the others; structs after them.
    for comment, code in sorted(entries, key=lambda entry: entry[1].startswith("static inline")):
        if code.startswith("#define"):
            constants.append((comment, *code.split()[1:3]))
        elif re.match(r"[\w ]+\*?contact_normal_\w+\(", code):
            name = re.search(r"(contact_normal_\w+)\(", code).group(1)
            found[noun_of(name, is_struct=False)] += [f"## {name}", "", "```c", signature(code), "```", "", paragraphs(comment), "", *examples.of(name)]
            counts["functions"] += 1
    for comment, code in entries:
        if re.match(r"typedef struct \w+ \{", code):
            name = code.split()[2]
            found[noun_of(name, is_struct=True)] += struct(comment, name, header)
            counts["structs"] += 1
        elif code.startswith("typedef"):
            name = re.search(r"contact_normal_\w+", code).group()
            found[noun_of(name, is_struct="struct" in code)] += [f"## {name}", "", "```c", code, "```", "", paragraphs(comment), ""]
    if counts["functions"] < 20 or counts["structs"] < 10 or len(constants) < 30:
        raise ValueError(f"the header was not understood: {counts}, {len(constants)} constants")
    named = {f"c_{noun}.md": "\n".join(lines) + "\n" for noun, lines in found.items()}
    return {"c.md": index(), **named, "c_constants.md": constants_page(constants)}


def signature(code: str) -> str:
    """A function without the body of one that is written in the header."""
    head, _, body = code.partition("\n{")
    return head.removeprefix("static inline ") + ";" if body else code


def struct(comment: str, name: str, header: str) -> list[str]:
    """A struct with a table of its members."""
    body = re.search(rf"typedef struct {name} \{{\n(.*?)\n\}} {name};", header, re.DOTALL).group(1)
    out = [f"## {name}", "", paragraphs(comment), "", "| member | |", "|---|---|"]
    for told, code in members(body):
        out.append(f"| `{joined(code)}` | {escaped(joined(told))} |")
    return [*out, ""]


def members(body: str) -> list[tuple[str, str]]:
    """The comment and the code of each member of a struct."""
    return re.findall(r"/\*\n(.*?)\*/\n(.*?);", body, re.DOTALL)


def index() -> str:
    """The page that lists the others."""
    names = [f"c_{noun}" for noun in NOUNS] + ["c_constants"]
    rows = [f"| [{title}](c_{noun}.md) | {about} |" for noun, (title, about, _) in NOUNS.items()]
    return "\n".join([
        "# C", "", "Drawn from `include/contact_normal.h`. [Conventions](../../conventions.md) has what holds for every call.", "",
        "| page | |", "|---|---|", *rows, "| [Constants](c_constants.md) | Statuses, methods, warnings. |", "",
        "```{toctree}", ":hidden:", "", *names, "```", "",
    ])


def constants_page(constants: list[tuple[str, str, str]]) -> str:
    """A table of all constants."""
    rows = [f"| `{name.removeprefix('CONTACT_NORMAL_')}` | {value} | {escaped(joined(comment))} |" for comment, name, value in constants]
    return "\n".join(["# Constants", "", "Each name begins with `CONTACT_NORMAL_`.", "", "| constant | value | |", "|---|---:|---|", *rows, ""])
