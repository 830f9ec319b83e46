# How the site is made: scripts/site.sh.
import os

project = "lightnet"
extensions = ["myst_parser"]
html_theme = "furo"
html_title = "lightnet"
html_copy_source = False
html_show_sphinx = False
myst_heading_anchors = 4
# What is no page of the site, but of the tree, is named by its path in the text; links to folders and code stay as they are.
suppress_warnings = ["myst.header"]
pygments_style = "friendly"
html_search_scorer = os.path.join(os.path.dirname(os.path.abspath(__file__)), "scorer.js")
