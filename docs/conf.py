"""The site of `make docs`: Sphinx with MyST. Warnings are errors there."""

import re
import sys
from pathlib import Path

here = Path(__file__).parent
root = here.parent
sys.path.insert(0, str(root / "python"))
sys.path.insert(0, str(here))

import dark_pictures  # noqa: E402 - beside this file
import language_tabs  # noqa: E402
import mathml  # noqa: E402
import narrow_tables  # noqa: E402
import reference_pages  # noqa: E402
import reference_python  # noqa: E402

project = "contact-normal"
author = "the contact-normal authors"
copyright = "2026, the contact-normal authors"
release = re.search(r'^version = "(.*)"', (root / "Cargo.toml").read_text(), re.MULTILINE).group(1)

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx_copybutton", "sphinx_design"]
myst_enable_extensions = ["colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3
napoleon_google_docstring = False
napoleon_use_rtype = False
# "dx, dy : float" stays one entry, and its text stands once.
napoleon_custom_sections = [("Parameters", "params_style"), ("Attributes", "params_style")]
autodoc_member_order = "bysource"
autodoc_typehints = "none"
autodoc_preserve_defaults = True
exclude_patterns = ["reference/generated/.*", "reference/generated/report_keys.md"]

html_math_renderer = "mathml"
# Prompts are not copied.
copybutton_prompt_text = r"\$ |>>> |\.\.\. "
copybutton_prompt_is_regexp = True
html_theme = "furo"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_title = f"contact-normal {release}"

# The C and the Fortran reference are drawn from the header and from the module.
reference_pages.write(root, here / "reference" / "generated")


def setup(app):
    """What this project adds to Sphinx."""
    app.add_html_math_renderer("mathml", (mathml.visit_math, None), (mathml.visit_displaymath, None))
    app.connect("autodoc-process-signature", reference_python.signature)
    app.connect("html-page-context", narrow_tables.part_names)
    app.add_transform(dark_pictures.DarkPictures)
    app.add_transform(language_tabs.LanguageTabs)
