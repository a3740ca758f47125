# The common ways to build facet; CMakePresets.json and CMakeLists.txt do the work.
#
# SPDX-License-Identifier: MIT

PRESET ?= dev
JOBS ?= $(shell nproc 2>/dev/null || echo 2)
BUILD = cmake --build --preset
# Seconds for all fuzzing programs together, and which of them; none named: all.
FUZZ_SECONDS ?= 600
FUZZ ?=

# Where `make install` puts things, as on GNU systems; DESTDIR comes before all of them.
prefix ?= /usr/local
bindir ?= $(prefix)/bin
libdir ?= $(prefix)/lib
includedir ?= $(prefix)/include
datarootdir ?= $(prefix)/share
mandir ?= $(datarootdir)/man

.PHONY: help setup setup-check build demo install uninstall deb amalgamation test test-c test-python web test-web site test-install bench format check \
    sanitize tsan fuzz coverage clean

help: ## this list
	@sed -n 's/^\([a-z-]*\):.*## /\1|/p' Makefile | while IFS='|' read -r name what; do \
	    printf '  make %-12s %s\n' "$$name" "$$what"; done

# `make demo` alone leaves out what only the tests need, a third of all.
setup: ## install the missing packages that building and testing need
	@tools/setup.sh $(if $(filter-out demo,$(or $(MAKECMDGOALS),help)),test)

setup-check: ## ... and those of the checks
	@tools/setup.sh test check

setup-package:
	@tools/setup.sh package

build: setup ## build everything (PRESET=dev)
	cmake --preset $(PRESET) -DFACET_TESTS=ON
	$(BUILD) $(PRESET) -j $(JOBS)

demo: setup ## build the program and render the built-in scene to facet.png
	cmake --preset release -DFACET_TESTS=OFF
	$(BUILD) release -j $(JOBS) --target facet_program
	build/release/facet render
	@echo "the picture: $(CURDIR)/facet.png"

install: ## install below prefix=/usr/local (also bindir, libdir, includedir, datarootdir, mandir, DESTDIR)
	cmake --preset release -B build/install -DFACET_TESTS=OFF \
	    -DCMAKE_INSTALL_PREFIX=$(prefix) -DCMAKE_INSTALL_BINDIR=$(bindir) \
	    -DCMAKE_INSTALL_LIBDIR=$(libdir) -DCMAKE_INSTALL_INCLUDEDIR=$(includedir) \
	    -DCMAKE_INSTALL_DATAROOTDIR=$(datarootdir) -DCMAKE_INSTALL_MANDIR=$(mandir)
	cmake --build build/install -j $(JOBS)
	DESTDIR=$(DESTDIR) cmake --install build/install

uninstall: ## remove what the last `make install` installed
	sed 's|^|$(DESTDIR)|' build/install/install_manifest.txt | xargs -d '\n' rm -f

deb: setup-package ## Debian packages in build/deb
	@tools/make_deb.sh build/deb

amalgamation: ## libfacet as one file, build/amalgamation/facet.c, and its header
	@tools/make_amalgamation.py build/amalgamation

test-install: deb ## install the packages into a fresh Debian 12 and use them (minutes)
	@tests/packaging/test_install.sh build/deb

# Where what the Python package and the explorer need cannot be had, their tests are left out, and what is missing is said.
test: test-c ## build and run all tests (PRESET=dev)
	@tools/test_python.sh --optional build/$(PRESET)
	@if tools/setup.sh web && tools/web.sh install; then $(MAKE) --no-print-directory test-web; \
	else echo "test: the explorer's tests are skipped: what they need is missing, see above"; fi

test-c: build ## ... without those of the Python package and the explorer
	ctest --preset $(PRESET) $(CTEST_FLAGS)

web: ## build the explorer, a static page, in build/web
	@tools/setup.sh web
	cmake --preset $(PRESET)
	$(BUILD) $(PRESET) -j $(JOBS) --target wasm glsl
	@tools/web.sh build build/$(PRESET)

test-web: web ## test the explorer in Chromium
	$(BUILD) $(PRESET) -j $(JOBS) --target facet_program
	@tools/web.sh test build/$(PRESET)

site: ## the documents as a static site, in build/site
	@tools/setup.sh site
	cmake --preset $(PRESET)
	$(BUILD) $(PRESET) -j $(JOBS) --target facet_program
	@tools/make_site.py build/$(PRESET)/facet build/site

test-python: build ## those of the Python package alone, which need PyPI
	@tools/test_python.sh build/$(PRESET)

bench: setup ## build with -O3 and run the benchmarks
	cmake --preset release -DFACET_TESTS=ON
	$(BUILD) release -j $(JOBS)
	@for program in build/release/bench/*; do \
	    if [ -f "$$program" ] && [ -x "$$program" ]; then echo "== $$program"; "$$program" || exit 1; fi; done

format: ## lay out the C files
	@tools/format.py

check: setup-check ## layout, structure and static analysis
	@tools/format.py --check
	@tools/check_all.sh
	@tools/analyse.sh
	@if command -v npm >/dev/null 2>&1; then tools/web.sh check; fi

sanitize: setup-check ## all tests under AddressSanitizer and UndefinedBehaviorSanitizer
	cmake --preset sanitize
	$(BUILD) sanitize -j $(JOBS)
	ctest --preset sanitize

tsan: setup-check ## the tests with threads under ThreadSanitizer
	cmake --preset tsan
	$(BUILD) tsan -j $(JOBS)
	ctest --preset tsan -L threads

fuzz: setup-check ## the fuzzing programs from their corpora, FUZZ_SECONDS=600 in all (FUZZ="png exr": only these)
	cmake --preset fuzz
	$(BUILD) fuzz -j $(JOBS)
	@tools/fuzz.py build/fuzz/tests/fuzz $(FUZZ_SECONDS) $(FUZZ)

coverage: setup-check ## run the tests with gcov and write build/coverage/coverage.html
	cmake --preset coverage
	$(BUILD) coverage -j $(JOBS)
	ctest --preset coverage
	$(BUILD) coverage --target coverage

clean: ## remove build/
	rm -rf build
