"""Settings of the documentation site; scripts/build-site calls Sphinx with them, on pages that site_pages.py prepares."""

import os
import re
import sys
from pathlib import Path

ROOT = Path(os.environ["PLICA_ROOT"])  # of the repository
release = re.search(r'^version = "(.+)"', (ROOT / "Cargo.toml").read_text(encoding="utf-8"), re.M).group(1)
project = "Plica"
author = copyright = "The Plica authors"

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.mathjax", "sphinx_design"]
myst_enable_extensions = ["attrs_block", "attrs_inline", "colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 4
exclude_patterns = ["pictures/README.md"]
highlight_language = "text"

# MathJax lies beside the pages, which need no network.
mathjax_path = "mathjax/tex-svg-full.js"
mathjax3_config = {"options": {"enableMenu": False}}

# The documentation strings of the Python module, without the compiled module.
sys.path.insert(0, str(ROOT / "crates/plica-python/python"))
autodoc_mock_imports = ["plica._native"]
autodoc_member_order = "bysource"
autodoc_typehints_format = "short"

html_title = f"Plica {release}"
html_theme = "pydata_sphinx_theme"
html_static_path = ["theme", "vendor"]
html_css_files = ["plica.css"]
html_favicon = "theme/icon.svg"
html_context = {"default_mode": "auto"}
html_sidebars = {page: [] for page in ("install", "tutorial")}
html_copy_source = html_show_sourcelink = False
html_theme_options = {
    "github_url": "https://github.com/plica/plica",
    "header_links_before_dropdown": 6,
    "footer_start": ["copyright"],
    "footer_end": [],
    "navigation_with_keys": False,
    "secondary_sidebar_items": ["page-toc"],
    "show_toc_level": 2,
}
