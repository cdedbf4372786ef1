"""Sphinx settings: Markdown pages (MyST), furo theme, API pages from docstrings."""

from gpsynth import __version__

project = "gpsynth"
author = "gpsynth contributors"
copyright = "2026, gpsynth contributors"
version = release = __version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx.ext.viewcode"]
exclude_patterns = ["_build"]

myst_enable_extensions = ["amsmath", "deflist", "dollarmath"]
myst_heading_anchors = 3
autodoc_member_order = "bysource"
autodoc_typehints = "description"

html_theme = "furo"
html_title = f"gpsynth {release}"
