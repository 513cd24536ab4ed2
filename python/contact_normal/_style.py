"""The style of this project's pictures: contact_normal.mplstyle; for dark pages dark.mplstyle replaces some of its settings."""

from __future__ import annotations

from pathlib import Path
from typing import Any

LIGHT = Path(__file__).with_name("contact_normal.mplstyle")
DARK = Path(__file__).with_name("dark.mplstyle")


def matplotlib_style(dark: bool = False) -> Any:
    """A context in which matplotlib uses the style. Needs matplotlib."""
    try:
        from matplotlib import style
    except ImportError as error:
        raise ImportError("pictures need matplotlib: pip install 'contact-normal[plot]'") from error
    return style.context([LIGHT, DARK] if dark else [LIGHT])
