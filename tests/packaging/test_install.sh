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

packages="libfacet0 libfacet-dev facet facet-mpi python3-facet"

# Copies the packages' files to a folder.
take()
{
    for package in $packages; do cp "$debs/$package"_*.deb "$1"; done
}

# What is done with the installed packages; $1 runs a command in the system, $2 is a folder there.
use()
{
    in=$1 folder=$2
    $in facet --version
    $in facet albedo 'ggx alpha=.3' --average
    $in facet render --size 64x36 --spp 4 --quiet -o "$folder/demo.png"
    $in facet info "$folder/demo.png"
    $in python3 "$folder/evaluate.py"
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
    take "$root/debs"
    cp "$here/consumer/consumer.c" "$here/evaluate.py" "$root/tmp"
    printf 'APT::Install-Recommends "false";\nAPT::Sandbox::User "root";\n' >"$root/etc/apt/apt.conf.d/99test"
    for conf in /etc/apt/apt.conf.d/*proxy* /etc/apt/apt.conf.d/*registry*; do
        if [ -f "$conf" ]; then cp "$conf" "$root/etc/apt/apt.conf.d/"; fi
    done
    in="chroot $root env DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8"
    $in apt-get -q update
    $in sh -c 'apt-get -q -y install /debs/*.deb'
    use "$in" /tmp
    $in apt-get -q -y install gcc libc6-dev pkg-config mpich
    # A program finds what is installed with it by /proc, which is there for this command alone.
    # shellcheck disable=SC2086 # a list of words
    unshare --mount sh -ec "mount -t proc proc '$root/proc'; exec \"\$@\"" sh $in \
        mpirun -n 2 facet render --size 64x36 --spp 4 --quiet -o /tmp/ranks.png
    $in facet compare /tmp/demo.png /tmp/ranks.png --max 0
    $in sh -ec 'cc -x c -Wall -Werror /tmp/consumer.c $(pkg-config --cflags --libs facet) -o /tmp/consumer; /tmp/consumer'
    $in sh -ec 'test -f /usr/share/bash-completion/completions/facet'
    # shellcheck disable=SC2086 # a list of words
    $in apt-get -q -y purge $packages
    if $in sh -c 'ls -d /usr/bin/facet /usr/lib/*/libfacet* /usr/include/facet /usr/lib/python3/dist-packages/facet* 2>/dev/null'; then
        echo "install: files are left after the packages were removed" >&2
        exit 1
    fi
    echo "install: the packages install, work and go on a fresh Debian 12"
else
    mkdir -p "$root/debs" "$root/tmp"
    take "$root/debs"
    for deb in "$root"/debs/*.deb; do dpkg -x "$deb" "$root"; done
    library=$(dirname "$(find "$root" -name libfacet.so.0)")
    cp "$here/evaluate.py" "$root/tmp"
    use "env PATH=$root/usr/bin:$PATH LD_LIBRARY_PATH=$library PYTHONPATH=$root/usr/lib/python3/dist-packages" "$root/tmp"
    flags=$(PKG_CONFIG_PATH=$library/pkgconfig pkg-config --define-variable=prefix="$root/usr" --cflags --libs facet)
    # shellcheck disable=SC2086 # a list of words
    cc "$here/consumer/consumer.c" $flags -o "$root/tmp/consumer"
    LD_LIBRARY_PATH=$library "$root/tmp/consumer"
    echo "install: the packages work where they are unpacked; not tried on a fresh Debian (root, debootstrap, a mirror)"
fi
