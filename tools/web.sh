#!/bin/sh
# Builds and tests the explorer.
#     tools/web.sh install             the npm packages of web/package-lock.json, where they are not there
#     tools/web.sh check               types and layout of web/
#     tools/web.sh build FOLDER        build/web, from FOLDER/facet.wasm and FOLDER/glsl
#     tools/web.sh test FOLDER         the tests of build/web in Chromium, against FOLDER/facet; build/junit/web.xml
#
# SPDX-License-Identifier: MIT
set -eu
cd "$(dirname "$0")/.."
inputs=build/web-inputs

install()
{
    if ! command -v npm >/dev/null 2>&1; then
        echo "web: npm is missing: apt-get install npm" >&2
        exit 1
    fi
    if [ web/node_modules/.package-lock.json -nt web/package-lock.json ]; then return; fi
    (cd web && npm ci --no-progress --no-audit --no-fund)
    touch web/node_modules/.package-lock.json
}

build()
{
    if [ ! -f "$1/facet.wasm" ] || [ ! -f "$1/glsl/facet.glsl" ]; then
        echo "web: $1 has no facet.wasm and glsl/: cmake --build it --target wasm glsl, which needs" \
            "clang-14 lld-14 wasi-libc libclang-rt-14-dev-wasm32 python3" >&2
        exit 1
    fi
    rm -rf $inputs
    mkdir -p $inputs/glsl
    cp "$1"/*.wasm $inputs/
    cp "$1"/glsl/*.glsl $inputs/glsl/
    cp -r web/public/. $inputs/
    (cd web && FACET_INPUTS=$inputs FACET_PAGE=build/web npm run --silent build)
    echo "web: the page is build/web/index.html; any static server shows it"
}

check()
{
    (cd web && npm run --silent check)
}

test_page()
{
    check
    mkdir -p build/junit
    FACET_PROGRAM=$(realpath "$1")/facet FACET_PAGE=$PWD/build/web FACET_SCREENSHOTS=$PWD/build/web-screenshots \
        FACET_JUNIT=$PWD/build/junit/web.xml \
        node --test --test-reporter=./web/tests/reporter.mjs --test-reporter-destination=stdout web/tests/*.test.mjs
}

case "${1:-}" in
install) install ;;
check)
    install
    check
    ;;
build)
    install
    build "$2"
    ;;
test) test_page "$2" ;;
*) sed -n '2,7s/^# \{0,1\}//p' "$0" && exit 2 ;;
esac
