"""Tables on narrow screens: long names in them may be parted behind an underscore."""

import re

_CELL = re.compile(r"<td.*?</td>", re.DOTALL)
# Text between tags, of which attributes are no part; and underscores within a name.
_TEXT = re.compile(r">[^<]+<")
_WITHIN = re.compile(r"(?<=\w\w_)(?=\w\w)")


def part_names(app, pagename, templatename, context, doctree):
    """Marks where a browser may part names. What is copied and searched stays as it is."""
    body = context.get("body")
    if body:
        context["body"] = _CELL.sub(lambda cell: _TEXT.sub(lambda text: _WITHIN.sub("<wbr>", text[0]), cell[0]), body)
