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

# -- benchmarks: bench, bench-quick ---------------------------------------------------------------------------------------

# -- figures and movies: figures, movies ----------------------------------------------------------------------------------

# -- robustness: stress ---------------------------------------------------------------------------------------------------
