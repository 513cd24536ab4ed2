"""Comments of the header and of the module as text of a page."""

import re
from pathlib import Path


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
