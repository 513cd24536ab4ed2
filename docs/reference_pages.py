"""Draws the pages of the reference: C, C++ and Fortran from include/, Rust from the crate, Python and the command line from the package.

The header and the module are regular: a comment stands before what it is about. The header is generated; a test compares it with src/ffi.
"""

from pathlib import Path

import reference_c
import reference_cxx
import reference_fortran
import reference_gallery
import reference_python
import reference_rust
from reference_text import Examples


def write(root: Path, folder: Path) -> None:
    """Writes all pages and what pages include into `folder`."""
    include = root / "include"
    folder.mkdir(parents=True, exist_ok=True)
    header = (include / "contact_normal.h").read_text()
    module = "\n".join(part.read_text() for part in [include / "contact_normal.f90", *sorted(include.glob("*.inc"))])
    pages = {
        **reference_c.pages(header, Examples(root, "c_examples", "*.c")),
        **reference_fortran.pages(module, Examples(root, "fortran_examples", "*.f90")),
        "python_members.txt": reference_python.members(),
        "report_keys.md": reference_python.report_keys(header),
        "cxx.md": reference_cxx.page(include),
        "rust.md": reference_rust.page((root / "src" / "lib.rs").read_text()),
        "gallery.md": reference_gallery.page(root),
        "command_line.txt": reference_python.command_line(),
    }
    for name, text in pages.items():
        path = folder / name
        # An unchanged page is not built again.
        if not path.exists() or path.read_text() != text:
            path.write_text(text)
