#!/bin/sh
# Installs the packages of a folder into a fresh Debian 12 and uses them:  tests/packaging/test_install.sh FOLDER
# The fresh system is a folder made by debootstrap, which needs root and a mirror; where there is none, the packages are
# unpacked into a folder instead, and what is said at the end tells which of both was tried.
#
# SPDX-License-Identifier: MIT
set -eu
debs=$(cd "$1" && pwd)
here=$(cd "$(dirname "$0")" && pwd)
root=$(mktemp -d "${TMPDIR:-/tmp}/facet-install-XXXXXX")
trap 'rm -rf --one-file-system "$root"' EXIT
mirror=$(apt-get indextargets --format '$(SITE)' 2>/dev/null | grep -m 1 '/debian$' || echo http://deb.debian.org/debian)
: "${mirror:=http://deb.debian.org/debian}"

# What is done with the installed packages; $1 runs a command in the system, $2 is a folder there.
use()
{
    in=$1 folder=$2
    $in facet --version
    $in facet albedo 'ggx alpha=.3' --average
    $in facet render --size 64x36 --spp 4 --quiet -o "$folder/demo.png"
    $in facet info "$folder/demo.png"
}

is_fresh=false
if [ "$(id -u)" = 0 ] && command -v debootstrap >/dev/null; then
    if debootstrap --variant=minbase bookworm "$root" "$mirror" >"$root.log" 2>&1; then
        is_fresh=true
    else
        tail -n 3 "$root.log"
    fi
    rm -f "$root.log"
fi
if $is_fresh; then
    mkdir "$root/debs"
    cp "$debs"/libfacet0_*.deb "$debs"/libfacet-dev_*.deb "$debs"/facet_*.deb "$root/debs"
    cp "$here/consumer/consumer.c" "$root/tmp"
    printf 'APT::Install-Recommends "false";\nAPT::Sandbox::User "root";\n' >"$root/etc/apt/apt.conf.d/99test"
    for conf in /etc/apt/apt.conf.d/*proxy* /etc/apt/apt.conf.d/*registry*; do
        if [ -f "$conf" ]; then cp "$conf" "$root/etc/apt/apt.conf.d/"; fi
    done
    in="chroot $root env DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8"
    $in apt-get -q update
    $in sh -c 'apt-get -q -y install /debs/*.deb'
    use "$in" /tmp
    $in apt-get -q -y install gcc libc6-dev pkg-config
    $in sh -ec 'cc -x c -Wall -Werror /tmp/consumer.c $(pkg-config --cflags --libs facet) -o /tmp/consumer; /tmp/consumer'
    $in sh -ec 'test -f /usr/share/bash-completion/completions/facet'
    $in apt-get -q -y purge facet libfacet-dev libfacet0
    if $in sh -c 'ls /usr/bin/facet /usr/lib/*/libfacet* /usr/include/facet 2>/dev/null'; then
        echo "install: files are left after the packages were removed" >&2
        exit 1
    fi
    echo "install: the packages install, work and go on a fresh Debian 12"
else
    for deb in "$debs"/libfacet0_*.deb "$debs"/libfacet-dev_*.deb "$debs"/facet_*.deb; do dpkg -x "$deb" "$root"; done
    library=$(dirname "$(find "$root" -name libfacet.so.0)")
    mkdir -p "$root/tmp"
    use "env PATH=$root/usr/bin:$PATH LD_LIBRARY_PATH=$library" "$root/tmp"
    flags=$(PKG_CONFIG_PATH=$library/pkgconfig pkg-config --define-variable=prefix="$root/usr" --cflags --libs facet)
    # shellcheck disable=SC2086 # a list of words
    cc "$here/consumer/consumer.c" $flags -o "$root/tmp/consumer"
    LD_LIBRARY_PATH=$library "$root/tmp/consumer"
    echo "install: the packages work where they are unpacked; not tried on a fresh Debian (root, debootstrap, a mirror)"
fi
