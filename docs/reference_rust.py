"""The page of the Rust reference: what the crate says of itself."""

import re


# The hidden end of an example that is a test of the crate, with the type of its errors.
_END = re.compile(r"^# Ok::<\(\), (?P<error>[\w:]+)>\(\(\)\)\n", re.MULTILINE)


def _program(code: str) -> str:
    """An example as a whole program: what is beside `use` stands in `main`."""
    end = _END.search(code)
    if not end:
        return code
    lines = _END.sub("", code).strip("\n").split("\n")
    first = next(k for k, line in enumerate(lines) if line and not line.startswith("use "))
    inside = "\n".join("    " + line if line else line for line in lines[first:])
    return "\n".join(["", *lines[:first], f"fn main() -> Result<(), {end['error']}> {{", inside, "    Ok(())", "}", ""])


def page(library: str) -> str:
    """The crate's documentation, of src/lib.rs, as a page. Its example is a test of the crate."""
    lines = re.findall(r"^//! ?(.*)$", library, re.MULTILINE)
    text = re.sub(r"\[(`[^`]*`)\](?!\()", r"\1", "\n".join(lines))
    # Headings one level deeper; an unmarked block is Rust, whose lines with # are hidden.
    blocks, shown = text.split("```"), []
    for number, block in enumerate(blocks):
        if number % 2 == 0:
            shown.append(re.sub(r"^# ", "## ", block, flags=re.MULTILINE))
        else:
            code = re.sub(r"^# .*\n", "", _program(block), flags=re.MULTILINE)
            shown.append(("rust" if code.startswith("\n") else "") + code)
    if not any("fn main()" in block for block in shown):
        raise ValueError("the crate's documentation has no whole program: its example must end with # Ok::<(), ...>(())")
    return "# Rust\n\n`cargo add contact-normal --path path/to/the/clone`; `cargo doc --open` in a clone has every item.\n\n" + "```".join(shown) + "\n"
