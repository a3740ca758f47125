#!/bin/sh
# Builds the Debian packages from the tracked files:  tools/make_deb.sh FOLDER
# They end up in FOLDER, beside the tree that they were built from; lintian looks at them if it is installed.
#
# SPDX-License-Identifier: MIT
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
mkdir -p "$1"
folder=$(cd "$1" && pwd)
for program in dpkg-buildpackage dh; do
    command -v $program >/dev/null || { echo "deb: $program was not found: apt-get install dpkg-dev debhelper fakeroot" >&2; exit 1; }
done
version=$(sed -n 's/^facet (\(.*\)).*/\1/p' "$root/packaging/debian/changelog" | head -n 1)
tree=$folder/facet-$version
rm -rf "$tree" "$folder"/*.deb "$folder"/*.changes "$folder"/*.buildinfo
mkdir "$tree"
(cd "$root" && git ls-files -z --cached --others --exclude-standard | tar --null -T - --ignore-failed-read -cf -) 2>/dev/null | tar -C "$tree" -xf -
cp -r "$root/packaging/debian" "$tree/debian"
(cd "$tree" && dpkg-buildpackage -b -us -uc)
rm -rf "$tree"
if command -v lintian >/dev/null; then
    lintian --fail-on error "$folder"/*.changes
else
    echo "deb: not looked at by lintian: apt-get install lintian"
fi
ls -l "$folder"/*.deb
