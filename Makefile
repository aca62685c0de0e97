# Needs Python 3.11 or newer with venv, make and git; everything else goes into .venv.
PYTHON ?= python3
BIN := .venv/bin
# A file's tests stay together: what they have in common is computed once. Files come in the order of tests/conftest.py.
PARALLEL := --numprocesses auto --maxprocesses 8 --dist loadfile --no-loadscope-reorder
# Of the tests that use the C compiler, those that ask about the cache of the library, or build with another compiler.
ANY_COMPILER := --deselect tests/compiled/test_library.py::test_processes_that_build_at_once_make_one_library_and_a_damaged_one_is_built_again \
	--deselect tests/compiled/test_library.py::test_a_folder_whose_files_may_not_be_run_is_a_reason \
	--deselect tests/compiled/test_single_file.py::test_the_function_of_matlab_refuses_what_it_cannot_take
# A thread of OpenBLAS that waits for work sleeps at once: else it turns in a loop on the processor that another test needs.
export OPENBLAS_THREAD_TIMEOUT := 4

demo: .venv/installed  ## Set up .venv, then analyse the XV-15 from 50 to 400 kt: a table, and damping.png (the default)
	$(BIN)/proprotor sweep xv15 --speed 50:400:5kt --plot damping.png

test: .venv/installed  ## Run the tests
	$(BIN)/python -m pytest --ignore=tests/verify --ignore=tests/browser $(PARALLEL)

test-all: .venv/verify-installed  ## Run the tests with those of `make test-browser` and of tests/verify, the longest files first; needs what these need
	$(BIN)/python -m pytest $(PARALLEL)

test-browser: .venv/installed  ## Move the sliders of `proprotor explore` in a real browser; needs Chromium and its driver
	$(BIN)/python -m pytest tests/browser

test-languages: .venv/installed test-clang  ## Run the compiled solver from C, Fortran and Octave, and all compiled functions by Clang; needs gfortran, octave-dev and clang
	$(BIN)/python -m pytest tests/compiled/test_single_file.py

test-clang: .venv/installed  ## Run all compiled functions by Clang
	CC=clang $(BIN)/python -m pytest tests/compiled $(ANY_COMPILER)

verify: .venv/verify-installed  ## Check the equations against derivation and an independent engine, numbers under several kernels of OpenBLAS, packages and site
	$(BIN)/python -m derive --check
	$(BIN)/python -m pytest tests/verify $(PARALLEL)
	$(BIN)/python -m tests.verify.kernels

verify-kernels: .venv/installed  ## Run the numerical tests under several kernels of OpenBLAS
	$(BIN)/python -m tests.verify.kernels

verify-versions: .venv/installed  ## Derive the equations under other hash seeds, another Python and another SymPy
	$(BIN)/python -m tests.verify.determinism

verify-environments: .venv/installed  ## Test the wheels under every Python found, with the newest and the lowest dependencies
	$(BIN)/python -m pip install --group environments
	$(BIN)/python -m tests.verify.environments --page $(PARALLEL)

regenerate-equations: .venv/installed  ## Derive the equations again, write generated/, the index of equations and the list of symbols
	$(BIN)/python -m derive
	$(BIN)/python -m derive.pages.index
	$(BIN)/python -m derive.pages.glossary

lint: .venv/installed  ## Check style and spelling
	$(BIN)/ruff check src derive tests benchmarks notebooks docs
	$(BIN)/ruff check --preview --select PLW1514 src derive tests benchmarks notebooks docs  # text files have an encoding
	$(BIN)/ruff format --check src derive tests benchmarks notebooks docs
	$(BIN)/codespell README.md CHANGELOG.md Makefile src derive templates benchmarks notebooks docs  # tests misspell on purpose
	$(BIN)/python -m tests.rooms

notebooks: .venv/installed  ## Run the audit's notebooks and render them into docs/notebooks/
	$(BIN)/python -m derive.pages.notebooks
	$(BIN)/python -m derive.pages.index

lab: .venv/installed  ## Open the audit's notebooks in JupyterLab, to change a cell and run it again
	$(BIN)/python -m pip install --group lab
	PYTHONPATH="$(CURDIR)" $(BIN)/python -m jupyter lab notebooks

drawings: .venv/installed  ## Draw axes, hinges, gimbal and swashplate from the derivation into docs/figures/
	$(BIN)/python -m derive.pages.drawings

figures: .venv/installed  ## Make every analytical figure of the paper, with its numbers, in figures/
	$(BIN)/python -m benchmarks.paper_figures --out figures

validation: .venv/installed  ## Write docs/validation.md and its figures
	$(BIN)/python -m benchmarks.validation

audit: .venv/installed  ## Judge every equation of the paper against the derivation; writes docs/audit.md
	$(BIN)/python -m derive.audit

gallery: .venv/installed  ## Draw the pictures that the code of the pages draws: docs/gallery, docs/pictures, docs/damping.png
	$(BIN)/python -m benchmarks.gallery

examples: .venv/installed  ## Run the examples, draw their pictures and write their notebooks and page
	$(BIN)/python -m benchmarks.examples

docs: .venv/docs-installed  ## Build the documentation site, docs/_build/html/index.html
	$(BIN)/python -m sphinx -W --keep-going -q -b html docs docs/_build/html

glossary: .venv/installed  ## Write docs/symbols.md, every symbol of the derivation
	$(BIN)/python -m derive.pages.glossary

decks: .venv/installed  ## Write docs/decks.md, every field of a deck
	$(BIN)/proprotor describe --markdown > docs/decks.md

types: .venv/installed  ## Check the types
	$(BIN)/python -m mypy

coverage: .venv/installed  ## Run the tests and tell which share of the branches of src and derive they take
	$(BIN)/python -m coverage erase
	$(BIN)/python -m pytest --ignore=tests/verify --ignore=tests/browser $(PARALLEL) --cov --cov-report=
	$(BIN)/python -m tests.branch_coverage

audit-dependencies: .venv/installed  ## Find dependencies that are undeclared, unused or at odds with each other
	$(BIN)/python -m deptry src generated derive
	$(BIN)/python -m pip check

audit-vulnerabilities: .venv/installed  ## Look up known vulnerabilities of what is installed; needs the package index's advisories
	$(BIN)/python -m pip_audit --strict --skip-editable

mutate: .venv/installed  ## Change every term of the equations, one at a time, and tell which change no test sees
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.mutation --processes 2 --report docs/mutation.md

fuzz: .venv/installed  ## Read 100,000 damaged decks and files of supports, airfoils and Nastran
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.fuzz --inputs 100000 --processes 2

peers: .venv/installed  ## Compare with Kane's method, lambdify and JAX; writes benchmarks/peers.md
	$(BIN)/python -m pip install --group peers
	$(BIN)/python -m benchmarks.peers.run

golden: .venv/installed  ## Accept the modes of every combination of switches as they are, and tell what moved
	$(BIN)/python -m tests.accept_golden

clean:  ## Remove all that make has made
	rm -rf .venv .venv-verify .hypothesis .mypy_cache .pytest_cache .ruff_cache build dist damping.png figures docs/_build docs/reference/api

help:  ## List the targets
	@sed -n 's/^\([a-z-]*\):[^#]*## /\1\t/p' Makefile | expand -t 24

.PHONY: demo test test-all test-browser test-languages test-clang verify verify-kernels verify-versions verify-environments regenerate-equations lint audit notebooks lab drawings figures validation gallery examples docs glossary decks types coverage audit-dependencies audit-vulnerabilities mutate fuzz peers golden clean help

.venv/installed: pyproject.toml generated/pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "Python 3.11 or newer is needed: make PYTHON=...")'
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --upgrade pip  # dependency groups need pip 25.1
	$(BIN)/python -m pip install --editable generated --editable . --group dev
	touch $@

.venv/docs-installed: .venv/installed
	$(BIN)/python -m pip install --group docs
	touch $@

.venv/verify-installed: .venv/docs-installed
	$(BIN)/python -m pip install --group verify
	touch $@
