"""Turns adjacent code blocks of several languages into tabs of the site. A chosen language holds on all pages."""

from docutils import nodes
from sphinx.transforms import SphinxTransform
from sphinx_design.shared import create_component

NAMES = {"python": "Python", "c": "C", "cpp": "C++", "fortran": "Fortran", "rust": "Rust", "sh": "Command line"}


class LanguageTabs(SphinxTransform):
    """Puts each row of adjacent blocks into a tab set of sphinx-design."""

    default_priority = 100

    def apply(self, **kwargs):
        parents = {id(block.parent): block.parent for block in self.document.findall(nodes.literal_block)}
        for parent in parents.values():
            row = []
            for child in [*parent.children, None]:
                language = child.get("language") if isinstance(child, nodes.literal_block) else None
                if language not in NAMES or language in [one["language"] for one in row]:
                    as_tabs(row)
                    row = []
                if language in NAMES:
                    row.append(child)


def as_tabs(row):
    """Replaces the blocks of a row by tabs."""
    if len(row) < 2:
        return
    parent, place = row[0].parent, row[0].parent.index(row[0])
    items = []
    for block in row:
        parent.remove(block)
        name = NAMES[block["language"]]
        label = nodes.rubric(name, name, classes=["sd-tab-label"], sync_group="language", sync_id=block["language"])
        content = create_component("tab-content", children=[block], classes=["sd-tab-content"])
        items.append(create_component("tab-item", children=[label, content], classes=["sd-tab-item"], selected=False))
    parent.insert(place, create_component("tab-set", children=items, classes=["sd-tab-set"]))
