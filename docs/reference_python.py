"""The Python reference: its members, the keys of a report, and the help of the command line."""

import argparse
import dataclasses
import importlib
import inspect
import re

from reference_c import members as members_of_struct
from reference_text import escaped, joined


def members() -> str:
    """Directives for every public name of the package: functions, the solver, and what they take, return and raise."""
    package = importlib.import_module("contact_normal")
    functions, classes, told = [], [], set()
    for name in package.__all__:
        member = getattr(package, name)
        if inspect.isclass(member):
            members = "" if issubclass(member, (tuple, dict, Exception)) else "   :members:\n"
            # What classes have in common stands with the first of them.
            hidden = {base for base in member.__bases__ if base.__module__.startswith("contact_normal._") and base.__name__ not in package.__all__}
            if hidden - told:
                members += "   :inherited-members:\n"
            told |= hidden
            # What stands among the attributes does not stand again below.
            listed = re.findall(r"^    ((?:\w+, )*\w+) : ", member.__doc__ or "", re.MULTILINE)
            again = sorted({one for group in listed for one in group.split(", ")})
            members += f"   :exclude-members: {', '.join(again)}\n" if members and again else ""
            classes.append((name, f".. autoclass:: {name}\n{members}\n"))
        elif inspect.isfunction(member) and member.__name__ == name:
            functions.append((name, f".. autofunction:: {name}\n\n"))
    first = ["solve", "Solver", "Result", "SolveOptions"]
    order = {name: place for place, name in enumerate(first)}
    listed = sorted([*functions, *classes], key=lambda each: order.get(each[0], len(first) + (each in classes)))
    return ".. py:module:: contact_normal\n\n" + "".join(directive for _, directive in listed)


def signature(app, what, name, obj, options, arguments, returns):
    """Classes that only the package makes have no arguments on the page, unless they are tuples, whose arguments are their fields."""
    if what != "class" or not arguments or issubclass(obj, tuple):
        return None
    made_by_users = re.search("^    Parameters$", obj.__doc__ or "", re.MULTILINE) or dataclasses.is_dataclass(obj) and "(_" not in arguments
    return None if made_by_users else ("", returns)


def report_keys(header: str) -> str:
    """A table of the keys of `result.report`, with what the header says of each number."""
    solved = importlib.import_module("contact_normal._solved")
    rows = ["| `ledger_rows` | Rows of `result.ledger`. |", "| `warnings` | The bits of `result.warnings`. |"]
    for group in solved._GROUPS:
        body = re.search(rf"typedef struct contact_normal_report_{group} \{{\n(.*?)\n\}}", header, re.DOTALL).group(1)
        for told, code in members_of_struct(body):
            name = re.search(r"(\w+)(\[\d+\])?$", joined(code)).group(1)
            if not name.startswith("reserved"):
                rows.append(f"| `{solved.report_key(group, name)}` | {escaped(joined(told))} |")
    return "\n".join(["| key | |", "|---|---|", *rows, ""])


def command_line() -> str:
    """The help of every command, as a terminal shows it."""
    top = importlib.import_module("contact_normal._command").parser()
    commands = next(action for action in top._actions if isinstance(action, argparse._SubParsersAction)).choices
    for one in (top, *commands.values()):
        one.formatter_class = lambda prog, base=one.formatter_class: base(prog, width=100)
    return "\n\n".join(f"$ {one.prog} --help\n{one.format_help()}" for one in (top, *commands.values()))
