"""The documentation site: `make docs`. Nothing is fetched from a network to build or to read it."""

import gc
import sys
from importlib.metadata import version as version_of
from pathlib import Path
from typing import Any

# New objects before cycles are looked for: at 700, its usual number, that takes a quarter of the time.
gc.set_threshold(50_000)
sys.path[:0] = [str(Path(__file__).parent / "extensions"), str(Path(__file__).parents[1])]

project = "proprotor"
author = "The proprotor developers"
version = release = version_of("proprotor")

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "numpydoc",
    "sphinx_click",
    "mathml",
    "plain_text",
    "source_pages",
]
exclude_patterns = ["_build", "extensions", "templates"]
source_suffix = {
    ".rst": "restructuredtext",
    ".md": "myst-nb",
}  # autosummary writes pages of the API with the first

myst_enable_extensions = ["dollarmath", "colon_fence"]
myst_heading_anchors = 4
myst_url_schemes = {"http": None, "https": None, "source": None}
nb_execution_mode = "auto"  # of pages that are notebooks, such as howto/notebook.md
nb_execution_raise_on_error = True
nb_execution_timeout = 300

templates_path = ["templates"]
autosummary_generate = True
autodoc_typehints = "none"  # docstrings tell types, with shapes and units
autodoc_member_order = "bysource"
autodoc_preserve_defaults = (
    True  # the name of a default in place of its value, which may be an object with an address
)
numpydoc_show_class_members = False
nitpicky = True
smartquotes = False  # two hyphens of an option stay two

highlight_language = "none"
html_math_renderer = "mathml"
html_theme = "furo"
html_title = f"proprotor {version}"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_copy_source = False
html_show_sphinx = False
html_show_copyright = False
html_theme_options = {"source_repository": "", "top_of_page_buttons": []}


def setup(app: Any) -> None:
    """Notebooks are files to download, as those of the examples, and no pages."""
    app.registry.source_suffix.pop(".ipynb")
