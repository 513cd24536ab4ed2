"""Checks every relative link and picture of the pages and of README.md: the file exists, and so does the heading behind a #. No page is
longer than LONGEST lines, and troubleshooting.md has each status and each warning of the header. The pages of ALONE
have no relative link."""

import re
import sys
from pathlib import Path

root = Path(__file__).resolve().parent.parent


LONGEST = 250
# Pages that registries of packages show without the other files of the project.
ALONE = ("python/README.md", "packaging/crate.md")


def anchors(page: Path) -> set[str]:
    """The anchors of a page's headings, as GitHub and MyST make them."""
    headings = re.findall(r"^#+ (.*)$", page.read_text(), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def not_explained() -> list[str]:
    """One line per status or warning without advice."""
    header = (root / "include" / "contact_normal.h").read_text()
    names = re.findall(r"^#define CONTACT_NORMAL_(\w+) (-\d+)$", header, re.MULTILINE)
    statuses = [f"{value} {name}" for name, value in names]
    warnings = re.findall(r"^#define CONTACT_NORMAL_WARNING_(\w+) ", header, re.MULTILINE)
    if len(statuses) < 10 or len(warnings) < 4:
        raise ValueError(f"the header was not understood: {statuses}, {warnings}")
    told = (root / "docs" / "troubleshooting.md").read_text()
    return [f"docs/troubleshooting.md: no advice for {name}" for name in [*statuses, *warnings] if f"| {name} |" not in told]


def not_alone() -> list[str]:
    """One line per relative link of ALONE."""
    texts = {name: (root / name).read_text() for name in ALONE}
    return [f"{name}: {target} leads nowhere on a registry" for name, text in texts.items() for target in re.findall(r"\]\(((?!https?://)[^)\s]+)\)", text)]


def broken() -> list[str]:
    """One line per link that leads nowhere."""
    found = []
    pages = [root / "README.md", root / "CONTRIBUTING.md", *sorted((root / "docs").rglob("*.md"))]
    count = 0
    for page in pages:
        lines = page.read_text().count("\n")
        if lines > LONGEST:
            found.append(f"{page.relative_to(root)}: {lines} lines; {LONGEST} is the most")
        text = re.sub(r"```.*?```", "", page.read_text(), flags=re.DOTALL)
        for target in re.findall(r"\]\(([^)\s]+)\)", text):
            if re.match(r"https?://", target):
                continue
            count += 1
            path, _, anchor = target.partition("#")
            to = (page.parent / path).resolve() if path else page
            if not to.exists():
                found.append(f"{page.relative_to(root)}: {target} does not exist")
            elif anchor and anchor not in anchors(to):
                found.append(f"{page.relative_to(root)}: {target} has no such heading")
    print(f"{count} links checked")
    return found


if __name__ == "__main__":
    sys.exit("\n".join(broken() + not_explained() + not_alone()) or None)
