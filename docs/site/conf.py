"""Configuration of Sphinx. scripts/site gathers the pages in one folder, and calls Sphinx there."""

import importlib.util
import os
import re
import sys

from pygments.lexers.special import TextLexer
from sphinx.highlighting import lexers

sys.path.insert(0, os.environ["STIPPLE_PYTHON_MODULE"])

project = "Stipple"
author = "the authors of Stipple"
extensions = ["myst_parser", "sphinx.ext.autodoc", "breathe"]
html_theme = "furo"
html_title = "Stipple"
html_copy_source = False
html_show_copyright = False
html_static_path = ["_static"]
html_css_files = ["stipple.css"]

myst_heading_anchors = 4
highlight_language = "none"
lexers["hex"] = TextLexer()

breathe_projects = {"stipple": os.environ["STIPPLE_DOXYGEN_XML"]}
breathe_default_project = "stipple"
breathe_domain_by_extension = {"h": "cpp"}

autodoc_member_order = "bysource"
autodoc_typehints = "description"
autodoc_mock_imports = [] if importlib.util.find_spec("torch") else ["torch"]


def fields_of_arguments(app, what, name, subject, options, lines):
    """"name: text" at the beginning of a line of a docstring describes an argument."""
    fields, before = [], ""
    for line in lines:
        argument = re.match(r"(\w+(?:, \w+)*): (.*)", line)
        if argument and before and not before.startswith((":param", " ")):
            fields.append("")
        fields.append(f":param {argument[1]}: {argument[2]}" if argument else line)
        before = fields[-1]
    lines[:] = fields


def setup(app):
    app.connect("autodoc-process-docstring", fields_of_arguments)
