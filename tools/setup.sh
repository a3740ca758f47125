#!/bin/sh
# Installs the packages of tools/packages.txt that are missing: the group `build` and those that are named.
# When nothing is missing it needs neither network nor root.
#
# SPDX-License-Identifier: MIT
set -eu

list=$(dirname "$0")/packages.txt
wanted=$(awk -v groups=" $* " '
    /^\[/ { gsub(/[][]/, "", $1); take = $1 == "build" || index(groups, " " $1 " "); next }
    { sub(/#.*/, "") }
    take && NF { print $1 }' "$list")

if ! command -v dpkg-query >/dev/null 2>&1; then
    echo "setup: this is not a Debian system: install what corresponds to" $wanted | sed 's|/[a-z]*||g' >&2
    exit 1
fi

missing=
for entry in $wanted; do
    package=${entry%/*} program=${entry#*/}
    if [ "$program" != "$entry" ] && command -v "$program" >/dev/null 2>&1; then continue; fi
    case " $missing " in *" $package "*) continue ;; esac
    state=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
    [ "$state" = installed ] || missing="$missing $package"
done
if [ -z "$missing" ]; then
    echo "setup: all packages are installed"
    exit 0
fi

if [ "$(id -u)" = 0 ]; then
    as_root=
elif command -v sudo >/dev/null 2>&1 && sudo -n true 2>/dev/null; then
    as_root="sudo -n"
else
    echo "setup: packages are missing; as root, run:" >&2
    echo "apt-get install$missing"
    exit 1
fi
echo "setup: installing$missing"
$as_root apt-get update -q
# shellcheck disable=SC2086 # a list of words
$as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends $missing
