"""On dark pages of the site, shows the picture of the same name in `dark/`, a folder beside the picture, if there is one."""

from pathlib import Path

from docutils import nodes
from sphinx.transforms import SphinxTransform

here = Path(__file__).parent


class DarkPictures(SphinxTransform):
    """Puts the dark picture beside the light one; the theme shows one of them."""

    default_priority = 100

    def apply(self, **kwargs):
        for light in list(self.document.findall(nodes.image)):
            place = Path(light["uri"])
            dark = place.parent / "dark" / place.name
            if (here / self.env.docname).parent.joinpath(dark).exists():
                other = light.deepcopy()
                other["uri"] = str(dark)
                light["classes"].append("only-light")
                other["classes"].append("only-dark")
                light.parent.insert(light.parent.index(light) + 1, other)
