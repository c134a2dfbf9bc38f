# The two commands of the README are `make demo` and `make test`; both set up everything they need.
PYTHON ?= python3
BIN := .venv/bin
PAGE := tests/page
# a process a core: threads of their own would only wait for each other
ONE := OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 RAYON_NUM_THREADS=1

# what can differ between processors, besides the examples: elements and films
NUMERICS := tests/surface/element tests/surface/form_finding/test_last_bits.py tests/surface/form_finding/test_rings.py \
	tests/surface/from_mesh/test_last_bits.py tests/projection/test_star_measures.py tests/base/test_sparse.py

.PHONY: demo test slowest slow kernels lint types page bench docs api clean

demo: .venv/ready
	$(BIN)/lamella run examples/01_unduloid.toml
	@echo "open $(CURDIR)/out/01_unduloid/report.html in a browser"

test: .venv/ready
	$(ONE) $(BIN)/python -m pytest -m "not slow" -n auto --dist loadfile

# the same, and docs/slowest-tests.md
slowest: .venv/ready
	$(ONE) PYTHONPATH=tests $(BIN)/python -m pytest -p slowest -m "not slow" -n auto --dist loadfile

slow: .venv/ready
	$(ONE) $(BIN)/python -m pytest -m slow -n auto

kernels: .venv/ready
	$(BIN)/python tests/examples/kernels.py
	$(BIN)/python tests/examples/kernels.py --pytest -m "not slow" -n auto --dist loadfile $(NUMERICS)

lint: .venv/ready
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

types: .venv/ready
	$(BIN)/mypy

# linter and types of the viewer's JavaScript, where there are npm and a registry; users need neither
page:
	@$(MAKE) --no-print-directory $(PAGE)/node_modules/ready || echo "no npm, or no registry: checks of the viewer's JavaScript are left out"
	@test ! -f $(PAGE)/node_modules/ready || npm --prefix $(PAGE) run --silent check

$(PAGE)/node_modules/ready: $(PAGE)/package.json $(PAGE)/package-lock.json
	npm --prefix $(PAGE) ci --ignore-scripts --no-audit --no-fund --silent
	touch $@

bench: .venv/ready
	@$(MAKE) --no-print-directory .venv-bench/ready || echo "programs to compare with could not be installed: left out"
	$(BIN)/python benchmarks/page.py

docs: .venv/ready
	$(ONE) $(BIN)/python docs/build.py

api: .venv/ready
	$(BIN)/python docs/build_api.py

clean:
	rm -rf .venv .venv-bench out build dist

# pinned versions, then the program itself with the pinned build tool, which compiles the remesher's kernel
.venv/ready: pins.txt pyproject.toml hatch_build.py src/lamella/surface/remesh/kernel.c
	$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "lamella needs Python 3.11 or newer; say which with: make demo PYTHON=python3.12")'
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -r pins.txt
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-build-isolation --no-deps --editable .
	touch $@

# programs to compare with, in an environment of their own: ours does not depend on them
.venv-bench/ready: pins-bench.txt
	$(PYTHON) -m venv .venv-bench
	.venv-bench/bin/python -m pip install --quiet --disable-pip-version-check -r pins-bench.txt
	touch $@
