# rodloop: `make` lists the targets. A fresh machine needs Python >= 3.11 and make, nothing else.
#
#   make run                     in an environment of its own, .venv
#   make run PYTHON=python3.13   made by another Python
#   make run VENV=/tmp/venv      in another place
#   make run PY=python           with an interpreter that has everything installed already

# The first Python that is new enough.
PYTHON ?= $(firstword $(shell for p in python3 python3.14 python3.13 python3.12 python3.11 python; do \
            $$p -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && echo $$p; done) python3)
VENV ?= .venv
OUT ?= out

ifdef PY
RUN_READY :=
DEV_READY :=
else
PY := $(VENV)/bin/python
RUN_READY := $(VENV)/.ready-run
DEV_READY := $(VENV)/.ready-dev
endif

.DEFAULT_GOAL := help
.DELETE_ON_ERROR:
MAKEFLAGS += --no-print-directory

.PHONY: help
help: ## show this list
	@awk -F ':.*## ' '/^[a-z-]+:.*## / {printf "  make %-12s %s\n", $$1, $$2}' $(MAKEFILE_LIST)

# -- environment ----------------------------------------------------------------------------------------------------------

.PHONY: venv
venv: $(RUN_READY) ## create .venv and install rodloop in it (done by the other targets when needed)

$(VENV)/bin/python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' \
	    || { echo "rodloop needs Python >= 3.11; say where it is: make PYTHON=/path/to/python3" >&2; exit 1; }
	@$(PYTHON) -m venv $(VENV) \
	    || { rm -rf $(VENV); echo "no virtual environment could be made (on Debian: apt install python3-venv)" >&2; exit 1; }

$(VENV)/.ready-run: pyproject.toml | $(VENV)/bin/python
	@echo "installing rodloop in $(VENV) ..."
	@$(VENV)/bin/python -m pip install --quiet --disable-pip-version-check -e .
	@touch $@

$(VENV)/.ready-dev: pyproject.toml | $(VENV)/bin/python
	@echo "installing rodloop and its development tools in $(VENV) ..."
	@$(VENV)/bin/python -m pip install --quiet --disable-pip-version-check -e '.[dev]'
	@touch $@ $(VENV)/.ready-run

# -- use ------------------------------------------------------------------------------------------------------------------

.PHONY: run
run: $(RUN_READY) ## simulate configs/quickstart.yaml and draw it
	@mkdir -p $(OUT)
	@$(PY) -m rodloop_cli run configs/quickstart.yaml -o $(OUT)/quickstart.nc --force
	@$(PY) -m rodloop_cli plot $(OUT)/quickstart.nc -o $(OUT)/quickstart.png
	@echo "result: $(OUT)/quickstart.nc"
	@echo "figure: $(OUT)/quickstart.png"

# -- development ----------------------------------------------------------------------------------------------------------

# One thread a process: the matrices are small, and parallel tests and timings would fight over the cores.
test check: export OMP_NUM_THREADS := 1
test check: export OPENBLAS_NUM_THREADS := 1
test check: export MKL_NUM_THREADS := 1

.PHONY: test
test: $(DEV_READY) ## run the tests (ARGS="-k crossing" passes options to pytest)
	@$(PY) -m pytest -q $(ARGS)

.PHONY: check
check: $(DEV_READY) ## lint, types and architecture; silent but for what is wrong
	@$(PY) -m ruff check --quiet
	@$(PY) -m mypy --no-error-summary
	@report=$$($(PY) -c 'from importlinter.cli import lint_imports_command as lint; lint()') || { echo "$$report"; exit 1; }

.PHONY: clean
clean: ## remove caches, builds and the quickstart's files (not .venv)
	@rm -rf build dist .mypy_cache .pytest_cache .ruff_cache .import_linter_cache .hypothesis .coverage htmlcov
	@find rodloop_cli tests scripts -name __pycache__ -type d -prune -exec rm -rf {} +
	@rm -f $(OUT)/quickstart.nc $(OUT)/quickstart.png
	@rmdir $(OUT) 2>/dev/null || true

# -- benchmarks -----------------------------------------------------------------------------------------------------------

# The peers need packages of their own; they stay out of .venv.
PEERS := .venv-peers

$(PEERS)/.ready: pyproject.toml scripts/benchmarks/peers/requirements-peers.txt
	@$(PYTHON) -m venv $(PEERS)
	@echo "installing the peers in $(PEERS) ..."
	@$(PEERS)/bin/python -m pip install --quiet --disable-pip-version-check -e . \
	    -r scripts/benchmarks/peers/requirements-peers.txt
	@touch $@

bench bench-quick bench-growth bench-tolerance: export OMP_NUM_THREADS := 1
bench bench-quick bench-growth bench-tolerance: export OPENBLAS_NUM_THREADS := 1

.PHONY: bench bench-quick bench-growth bench-tolerance
bench: $(PEERS)/.ready ## error against wall time, rodloop and its peers; writes docs/performance.md
	@$(PEERS)/bin/python -m scripts.benchmarks.bench --json $(OUT)/bench.json
	@$(PEERS)/bin/python -m scripts.benchmarks.report $(OUT)/bench.json

bench-quick: $(PEERS)/.ready ## the same with fewer settings and cases, under two minutes
	@$(PEERS)/bin/python -m scripts.benchmarks.bench --quick --json $(OUT)/bench-quick.json

bench-growth: $(RUN_READY) ## time and memory against cells, rows, time span, segments
	@$(PY) -m scripts.benchmarks.growth

bench-tolerance: $(RUN_READY) ## what the tolerance delivers, on reference and random cases
	@$(PY) -m scripts.benchmarks.tolerance

# -- figures and movies: figures, movies ----------------------------------------------------------------------------------

figures movies reproduction: export OMP_NUM_THREADS := 1

.PHONY: figures
figures: $(RUN_READY) ## draw every figure of the paper from our own runs to out/paper (one: make figures/fig11)
	@$(PY) -m scripts.paper

figures/%: $(RUN_READY)
	@$(PY) -m scripts.paper $*

.PHONY: movies
movies: $(RUN_READY) ## the paper's movies S1 to S3 to out/paper
	@$(PY) -m scripts.paper movies

.PHONY: reproduction
reproduction: $(RUN_READY) ## the paper's numbers beside ours: docs/reproduction.md (a few minutes)
	@$(PY) -m scripts.paper.reproduction

# -- robustness: stress, cf-check -----------------------------------------------------------------------------------------

stress: export OMP_NUM_THREADS := 1
stress: export OPENBLAS_NUM_THREADS := 1

.PHONY: stress
stress: $(DEV_READY) ## random cases, maps over the parameters, long runs, strikes (ARGS=--quick: a minute)
	@$(PY) -m scripts.stress all $(ARGS)
	@$(PY) -m pytest -q -m slow tests/faults -s

.venv-cf/bin/compliance-checker:
	@$(PYTHON) -m venv .venv-cf
	@.venv-cf/bin/python -m pip install --quiet --disable-pip-version-check compliance-checker setuptools

.PHONY: cf-check
cf-check: $(DEV_READY) | .venv-cf/bin/compliance-checker ## CF compliance of run, sweep, modes and critical files
	@$(PY) scripts/cf_check.py $(CURDIR)/.venv-cf/bin/compliance-checker
