"""`python -m benchmarks.paper_figures`: see `benchmarks.paper_figures.command`."""

from benchmarks.paper_figures.command import figures

figures(prog_name="python -m benchmarks.paper_figures")
