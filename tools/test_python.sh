#!/bin/sh
# Builds the wheel, installs it into virtual environments with the oldest NumPy that is supported and with the newest, and
# runs pytest in each: build/junit/python*.xml.
#
#     tools/test_python.sh [--optional] [BUILD_FOLDER]
#
# libfacet.a and the program `facet` of BUILD_FOLDER (build/dev) are used if they are there.  --optional: without PyPI,
# the tests are skipped, with status 0.
#
# SPDX-License-Identifier: MIT
set -eu
cd "$(dirname "$0")/.."
root=$PWD

optional=
if [ "${1:-}" = --optional ]; then optional=yes; shift; fi
build=$root/${1:-build/dev}
here=$root/build/python
python=${PYTHON:-python3}

give_up()
{
    if [ "$optional" ]; then echo "test-python: skipped: $1"; exit 0; fi
    echo "test-python: $1" >&2
    exit 1
}

"$python" -c 'import ensurepip, venv' 2>/dev/null || give_up "$python has no venv: apt-get install python3-venv"

# An environment is kept while what it was made from stays the same.
install_environment()
{
    environment=$here/$1
    shift
    wanted="$("$python" -V) $*"
    if [ "$(cat "$environment/wanted" 2>/dev/null)" != "$wanted" ]; then
        rm -rf "$environment"
        "$python" -m venv "$environment"
        "$environment/bin/pip" --disable-pip-version-check install -q "$@" >"$here/pip.log" 2>&1 || {
            tail -n 5 "$here/pip.log" >&2
            give_up "pip cannot install $*: is PyPI reachable?"
        }
        echo "$wanted" >"$environment/wanted"
    fi
}

requirements()
{
    sed -n "/\[newest\]/$1; s/#.*//; /[^ ]/p" python/tests/requirements.txt | tr -d ' '
}

mkdir -p "$here" build/junit
# shellcheck disable=SC2046 # a list of words
install_environment newest 'scikit-build-core>=0.10' 'numpy>=2' $(requirements 's/^/ /')
# shellcheck disable=SC2046
install_environment oldest 'numpy==1.26.*' $(requirements d)

prebuilt=
[ ! -f "$build/libfacet.a" ] || prebuilt=$build/libfacet.a
rm -rf "$here/wheel"
"$here/newest/bin/pip" --disable-pip-version-check wheel -q --no-build-isolation --no-deps -w "$here/wheel" \
    --config-settings=build-dir=build/python/tests --config-settings=cmake.define.FACET_PREBUILT="$prebuilt" \
    --config-settings=cmake.define.FACET_WERROR=ON .

if [ -x "$build/facet" ]; then
    FACET=$build/facet
    export FACET
fi
export PYTHONDONTWRITEBYTECODE=1
status=0
for which in oldest newest; do
    "$here/$which/bin/pip" --disable-pip-version-check install -q --force-reinstall --no-deps "$here"/wheel/*.whl
    echo "test-python: $which NumPy, $("$here/$which/bin/python" -c 'import numpy; print(numpy.__version__)')"
    name=python
    [ "$which" = newest ] || name=python-$which-numpy
    "$here/$which/bin/python" -m pytest -q --junitxml="$root/build/junit/$name.xml" python/tests || status=1
done
exit $status
