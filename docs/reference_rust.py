"""The page of the Rust reference: what the crate says of itself."""

import re


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
            code = re.sub(r"^# .*\n", "", block, flags=re.MULTILINE)
            shown.append(("rust" if code.startswith("\n") else "") + code)
    return "# Rust\n\n`cargo add contact-normal --path path/to/the/clone`; `cargo doc --open` in a clone has every item.\n\n" + "```".join(shown) + "\n"
