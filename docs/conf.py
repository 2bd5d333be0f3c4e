"""Sphinx settings. Build with: sphinx-build -W -b html docs docs/_build/html

Pictures and the page of claims are computed at build time into docs/_generated (see _ext/generated.py).
"""

import sys
from importlib.metadata import version as installed_version
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "_ext"))

project = "exactacq"
version = release = installed_version("exactacq")
author = copyright = "the exactacq authors"
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx-mathjax-offline", "generated"]
exclude_patterns = ["_build", "_ext", "_generated/*.md"]

html_theme = "pydata_sphinx_theme"
html_title = "exactacq"
html_show_sourcelink = False
html_theme_options = {
    "navigation_with_keys": False,
    "show_toc_level": 2,
    "footer_start": ["copyright"],
    "footer_end": [],
    "header_links_before_dropdown": 7,
}
# Pages without pages below them need no column for these.
html_sidebars = {
    page: [] for page in ("tutorial", "course", "sensing", "shortest_paths", "exactness", "figures")
}

myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 3

# Docstrings name what they speak of in single backticks.
default_role = "py:obj"
autodoc_member_order = "bysource"
autodoc_default_options = {"members": True}
autodoc_typehints = "signature"
