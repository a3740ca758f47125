# The common ways to build facet; CMakePresets.json and CMakeLists.txt do the work.
#
# SPDX-License-Identifier: MIT

PRESET ?= dev
JOBS ?= $(shell nproc 2>/dev/null || echo 2)
BUILD = cmake --build --preset
# Seconds for each fuzzing program.
FUZZ_SECONDS ?= 60

.PHONY: help setup setup-check build demo test web test-web bench format check sanitize tsan fuzz coverage clean

help: ## this list
	@sed -n 's/^\([a-z-]*\):.*## /\1|/p' Makefile | while IFS='|' read -r name what; do \
	    printf '  make %-12s %s\n' "$$name" "$$what"; done

setup: ## install the missing packages that building and testing need
	@tools/setup.sh build

setup-check: ## ... and those of the checks
	@tools/setup.sh check

build: setup ## build everything (PRESET=dev)
	cmake --preset $(PRESET)
	$(BUILD) $(PRESET) -j $(JOBS)

demo: setup ## build the program and render the built-in scene to facet.png
	cmake --preset release
	$(BUILD) release -j $(JOBS) --target facet_program
	build/release/facet render
	@echo "the picture: $(CURDIR)/facet.png"

# WEB=no leaves the explorer out.  Where its packages cannot be had, its tests are left out, and what is missing is said.
test: build ## build and run all tests (PRESET=dev)
	ctest --preset $(PRESET) $(CTEST_FLAGS)
	@if [ "$(WEB)" = no ]; then :; \
	elif tools/setup.sh web && tools/web.sh install; then $(MAKE) --no-print-directory test-web; \
	else echo "test: the explorer's tests are skipped: what they need is missing, see above"; fi

web: ## build the explorer, a static page, in build/web
	@tools/setup.sh web
	cmake --preset $(PRESET)
	$(BUILD) $(PRESET) -j $(JOBS) --target wasm glsl
	@tools/web.sh build build/$(PRESET)

test-web: web ## test the explorer in Chromium
	$(BUILD) $(PRESET) -j $(JOBS) --target facet_program
	@tools/web.sh test build/$(PRESET)

bench: setup ## build with -O3 and run the benchmarks
	cmake --preset release
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

fuzz: setup-check ## each fuzzing program for FUZZ_SECONDS=60 from its corpus
	cmake --preset fuzz
	$(BUILD) fuzz -j $(JOBS)
	@tools/fuzz.sh build/fuzz/tests/fuzz $(FUZZ_SECONDS)

coverage: setup-check ## run the tests with gcov and write build/coverage/coverage.html
	cmake --preset coverage
	$(BUILD) coverage -j $(JOBS)
	ctest --preset coverage
	$(BUILD) coverage --target coverage

clean: ## remove build/
	rm -rf build
