"""The site of `make docs`: Sphinx with MyST. Warnings are errors there."""

import re
import sys
from pathlib import Path

here = Path(__file__).parent
root = here.parent
sys.path.insert(0, str(root / "python"))
sys.path.insert(0, str(here))

import dark_pictures  # noqa: E402 - beside this file
import reference_pages  # noqa: E402

project = "contact-normal"
author = "the contact-normal authors"
copyright = "2026, the contact-normal authors"
release = re.search(r'^version = "(.*)"', (root / "Cargo.toml").read_text(), re.MULTILINE).group(1)

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
myst_enable_extensions = ["dollarmath", "deflist"]
myst_heading_anchors = 3
napoleon_google_docstring = False
napoleon_use_rtype = False
napoleon_use_ivar = True
autodoc_member_order = "bysource"
autodoc_typehints = "none"
autodoc_preserve_defaults = True
exclude_patterns = ["reference/generated/.*"]

html_theme = "furo"
html_title = f"contact-normal {release}"

# The C and the Fortran reference are drawn from the header and from the module.
reference_pages.write(root, here / "reference" / "generated")


def setup(app):
    """What this project adds to Sphinx."""
    app.add_transform(dark_pictures.DarkPictures)
