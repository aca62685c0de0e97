"""`python -m benchmarks.paper_figures`: see `benchmarks.paper_figures.command`."""

from benchmarks.paper_figures.command import figures

if __name__ == "__main__":
    figures(prog_name="python -m benchmarks.paper_figures")
