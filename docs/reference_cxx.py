"""The page of the C++ reference: the classes and the functions of contact_normal.hpp."""

import re
from pathlib import Path

from reference_text import escaped, joined

_DECLARED = re.compile(
    r"(?P<comment>(?:^ *///.*\n)+) *(?:template <[^\n]*>\n *)?"
    r"(?:(?:class|struct|enum class) (?:\[\[nodiscard\]\] )?(?P<type>\w+)|inline [^\n(]*?(?P<function>\w+)\()", re.MULTILINE)


def page(include: Path) -> str:
    """A table of types and one of functions, from the header and its parts."""
    types, functions = {}, {}
    for part in sorted(include.glob("*.hpp")):
        public = re.sub(r"namespace detail \{.*?\} // namespace detail", "", part.read_text(), flags=re.DOTALL)
        for found in _DECLARED.finditer(public):
            told = joined(re.sub(r"^ *///", "", found["comment"], flags=re.MULTILINE))
            if found["type"]:
                types.setdefault(found["type"], told)
            else:
                # Overloads stand together.
                functions[found["function"]] = "; ".join(text for text in (functions.get(found["function"]), told) if text)
    if len(types) < 10 or len(functions) < 5:
        raise ValueError(f"contact_normal.hpp was not understood: {len(types)} types, {len(functions)} functions")
    return "\n".join([
        "# C++", "", "Drawn from `include/contact_normal.hpp`, for C++17: header-only, on the C ABI, in the namespace `contact_normal`. Members have the names of the",
        "[C structs](c.md). [Conventions](../../conventions.md#c) says what differs from C.", "", "## A program", "",
        "```{literalinclude} ../../../cxx_examples/hertz.cpp", ":language: cpp", "```", "", "## Types", "", "| type | |", "|---|---|",
        *(f"| `{name}` | {escaped(told)} |" for name, told in types.items()), "", "## Functions", "", "| function | |", "|---|---|",
        *(f"| `{name}` | {escaped(told)} |" for name, told in functions.items()), "",
    ])
