"""How Sphinx makes the site of what tools/make_site.py has laid out in build/site-source.

SPDX-License-Identifier: MIT
"""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

project = "facet"
author = "the authors of facet"
project_copyright = "the authors of facet, MIT licence"
version = release = os.environ["FACET_VERSION"]
language = "en_GB"

extensions = ["myst_parser", "source_pages"]
root_doc = "index"
smartquotes = False                  # quoted text is often code
highlight_language = "text"          # of indented blocks, which are formulas
pygments_style, pygments_dark_style = "tango", "github-dark"
myst_heading_anchors = 4             # those that code forges make
myst_url_schemes = ("http", "https", "mailto", "tree")
nitpick_ignore = [("c:identifier", name) for name in ("size_t", "uint32_t")]

html_theme = "furo"
html_title = f"facet {release}"
html_static_path = ["site.css"]
html_css_files = ["site.css"]
html_copy_source = False
html_show_sphinx = False
html_theme_options = {
    "light_css_variables": {"color-brand-primary": "#0a5f96", "color-brand-content": "#0a5f96"},
    "dark_css_variables": {"color-brand-primary": "#6cb8ea", "color-brand-content": "#6cb8ea"},
}
