# Thin: each target is a line or two over pip, cmake and pytest. Everything lands in .venv, build and out.
PYTHON ?= python3
BIN := .venv/bin
# The environment's own cmake, ninja and compilers' helpers come first.
export PATH := $(CURDIR)/$(BIN):$(PATH)

.PHONY: demo test build unit sanitize blender lint format bench houdini-package clean

# The main job on the best device present: a rock falls into a fountain.
demo: build
	fontana run scenes/fountain_rock.json --backend auto --out out/demo
	@echo "(fontana is .venv/bin/fontana here; '. .venv/bin/activate' makes it a word of this shell)"

# Everything: style, the tests on every backend, and the tests in C and C++ under sanitizers.
test: lint unit sanitize

build: .venv/ready
	pip install --quiet '.[opencl]'

unit: .venv/ready
	pip install --quiet --config-settings=cmake.define.FONTANA_WERROR=ON '.[cuda,opencl,test]'
	python -m pytest -q

sanitize: .venv/ready
	cmake --preset asan --log-level=WARNING && cmake --build --preset asan -j 2 && ctest --preset asan
	cmake --preset tsan --log-level=WARNING && cmake --build --preset tsan -j 2 && ctest --preset tsan

# Blender as a Python module, for the tests marked "blender": 375 MB to download, 1 GB on disk.
blender: .venv/ready
	test -x .venv/blender/bin/python || $(PYTHON) -m venv .venv/blender
	.venv/blender/bin/pip install --quiet 'bpy==5.0.*'

lint: .venv/ready
	pip install --quiet 'ruff==0.17.6' 'clang-format==23.1.5'
	ruff check . && ruff format --check .
	git ls-files '*.c' '*.h' '*.cpp' ':!third_party' | xargs clang-format --dry-run --Werror

format: .venv/ready
	pip install --quiet 'ruff==0.17.6' 'clang-format==23.1.5'
	ruff check --fix . && ruff format .
	git ls-files '*.c' '*.h' '*.cpp' ':!third_party' | xargs clang-format -i

# The thesis's Tables 1 and 2 anew.
bench: build
	fontana bench thesis --out benchmarks/results/local

# The Houdini package, a folder and a zip in out/houdini.
houdini-package: build
	python tools/make_houdini_package.py

.venv/ready:
	$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "Fontana needs Python 3.11 or later")'
	$(PYTHON) -m venv .venv
	pip install --quiet --upgrade pip cmake ninja
	touch $@

clean:
	rm -rf build out .venv
