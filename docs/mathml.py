"""Formulas as MathML, which browsers draw by themselves: no script, and nothing to load."""

from docutils import nodes
from docutils.utils.math import latex2mathml


def visit_math(self, node):
    """A formula within a line."""
    self.body.append(latex2mathml.tex2mathml(node.astext(), as_block=False))
    raise nodes.SkipNode


def visit_displaymath(self, node):
    """A formula of its own."""
    self.body.append(f'<div class="math">{latex2mathml.tex2mathml(node.astext(), as_block=True)}</div>')
    raise nodes.SkipNode
