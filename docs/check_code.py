"""Runs or compiles every code block of docs/ and of both README.md: `check_code.py PREFIX FOLDER [PAGE.md ...]`, with the library installed in PREFIX. FOLDER gets
the programs and their data.

All Python blocks of a page run in one process, in order. Notebooks run when their pages are written. A block of C, C++ or Fortran that is a program is
compiled, linked and run; any other one is compiled inside a function, with the variables that it uses declared. Blocks of sh, cmake, toml and text do not run:
`make package-test` runs their commands.
"""

import os
import re
import subprocess
import sys
from pathlib import Path

root = Path(__file__).resolve().parent.parent
PYTHON = """import contact_normal
import numpy as np
dx = dy = 0.2
x, y = (np.arange(95) - 47) * 0.2, (np.arange(88) - 43.5) * 0.2
h = 0.001 * x[None, :] ** 2 + 0.002 * y[:, None] ** 2
steel = dict(shear_modulus=82000.0, poisson_ratio=0.28)
"""
# Pages whose Python blocks are a complete program.
WHOLE = ("README.md", "tutorial.md", "creep_force_tables.md")
C = """#include <contact_normal.h>
#include <stdio.h>
contact_normal_status block(int mx, int my, const double *h, double *p, contact_normal_solver *solver);
contact_normal_status block(int mx, int my, const double *h, double *p, contact_normal_solver *solver)
{
    %s
    %s
    (void)mx, (void)my, (void)h, (void)p, (void)solver;
    return status;
}
"""
# The variables that a fragment of C uses without declaring them.
C_DECLARED = {
    "options.": "contact_normal_options options; contact_normal_options_init(&options);",
    "scene": "contact_normal_scene scene; contact_normal_scene_init(&scene);",
    "fields": "contact_normal_fields fields; contact_normal_fields_init(&fields);",
    "report": "contact_normal_report report; contact_normal_report_init(&report);",
    "status": "contact_normal_status status = CONTACT_NORMAL_OK;",
}
CPP = """#include <contact_normal.hpp>
#include <iostream>
void block(int mx, int my, const std::vector<double> &h);
void block(int mx, int my, const std::vector<double> &h)
{
%s
%s
}
"""
# The variables that a fragment of C++ uses without declaring them.
CPP_DECLARED = {
    "scene": "contact_normal::scene scene({mx, my, 0.2, 0.2}, {82000.0, 0.28}); scene.undeformed_distance(h);",
    "patch_of_element": "std::vector<std::int32_t> patch_of_element(h.size());",
    "factors": "std::vector<double> factors{1.0, 0.0, 0.0, 1.0};",
    "table": "std::vector<double> table;",
    "tables": "std::vector<double> tables;",
}
FORTRAN = """subroutine block(mx, my, h, p)
  use contact_normal
  use, intrinsic :: iso_c_binding
  implicit none
  integer(c_int32_t) :: mx, my, status, k
  real(c_double), target :: h(mx, my), p(mx, my)
  type(contact_normal_scene) :: scene
  type(contact_normal_fields) :: fields
  type(contact_normal_report) :: report
%s
end subroutine
"""
WARNINGS = ["-Wall", "-Wextra", "-Werror"]


def run(command: list, folder: Path, **more) -> None:
    """Runs a command. Its output is shown if it fails."""
    done = subprocess.run([str(word) for word in command], cwd=folder, capture_output=True, text=True, **more)
    if done.returncode:
        raise SystemExit(f"{' '.join(map(str, command))}:\n{done.stdout}\n{done.stderr}")


def declared_in_cpp(block: str) -> str:
    """Declarations of the variables that a fragment of C++ uses without declaring them."""
    return "\n".join(code for name, code in CPP_DECLARED.items() if re.search(rf"\b{name}\b", block) and not re.search(rf"contact_normal::{name} {name}\b", block))


def declared(block: str) -> str:
    """Declarations of the variables that a fragment of C, or the function around it, uses without declaring them."""
    block += " status"
    return "\n".join(code for name, code in C_DECLARED.items() if name in block and f"contact_normal_{name.rstrip('.')} {name.rstrip('.')};" not in block)


def main(prefix: Path, folder: Path, only: list) -> None:
    """Checks all pages, or only those with these names."""
    folder.mkdir(parents=True, exist_ok=True)
    for data in (*(root / "data" / "wheel_rail").glob("*.txt"), *(root / "data" / "heights").glob("*.npy"), *(root / "data" / "profiles").glob("*.pr?")):
        (folder / data.name).write_bytes(data.read_bytes())
    environment = {**os.environ, "LD_LIBRARY_PATH": str(prefix / "lib"), "MPLBACKEND": "Agg", "MPLCONFIGDIR": str(folder)}
    flags = [f"-I{prefix / 'include'}"]
    link = [f"-L{prefix / 'lib'}", "-lcontact_normal"]
    count = 0
    pages = [page for page in sorted((root / "docs").rglob("*.md")) if not {"generated", "notebooks"} & set(page.parts)]
    pages = [page for page in [root / "README.md", root / "python" / "README.md", *pages] if not only or page.name in only]
    for page in pages:
        blocks = re.findall(r"^```(\w+)\n(.*?)^```", page.read_text(), re.DOTALL | re.MULTILINE)
        python = [block for language, block in blocks if language == "python"]
        if python:
            script = folder / f"{page.stem}.py"
            script.write_text(("" if page.name in WHOLE else PYTHON) + "\n".join(python))
            run([sys.executable, script], folder, env=environment)
        for number, (language, block) in enumerate(blocks):
            source = folder / f"{page.stem}_{number}"
            program = [source, *link, "-lm"]
            if language == "c":
                whole = "int main" in block
                source = source.with_suffix(".c")
                source.write_text(block if whole or block.startswith("#include") else C % (declared(block), block))
                compiler = ["gcc", "-std=c99", *WARNINGS, *flags, source]
            elif language == "cpp":
                whole = "int main" in block
                source = source.with_suffix(".cpp")
                source.write_text(block if whole else CPP % (declared_in_cpp(block), block))
                compiler = ["g++", "-std=c++17", *WARNINGS, *flags, source]
            elif language == "fortran":
                whole = block.lstrip().startswith("program")
                source = source.with_suffix(".f90")
                source.write_text(block if whole else FORTRAN % block)
                # A fragment does not use all variables declared around it.
                unused = [] if whole else ["-Wno-unused-variable", "-Wno-unused-dummy-argument"]
                compiler = ["gfortran", *WARNINGS, *unused, prefix / "include" / "contact_normal.f90", source]
            else:
                continue
            if whole:
                run([*compiler, "-o", *program], folder)
                run([program[0]], folder, env=environment)
            else:
                run([*compiler, "-c"], folder)
            count += 1
        count += len(python)
    print(f"{count} code blocks checked")


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve(), sys.argv[3:])
