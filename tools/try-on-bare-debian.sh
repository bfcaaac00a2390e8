#!/bin/sh
# Makes a bare Debian in a folder and runs the README's two commands in it, with network and then without.
# For developers, as root.  Usage: tools/try-on-bare-debian.sh SUITE MIRROR FOLDER
#   SUITE   bookworm, trixie      MIRROR  address of a Debian mirror      FOLDER  where the tree goes; kept and used again
set -eu
suite=$1 mirror=$2 folder=$3
cd "$(dirname "$0")/.."
[ -x "$folder/usr/bin/make" ] || debootstrap --variant=minbase --include=make "$suite" "$folder" "$mirror"
rm -rf "$folder/tmp/bare checkout"
git clone -q . "$folder/tmp/bare checkout"
cp /etc/resolv.conf "$folder/etc/resolv.conf" 2>/dev/null || true
mountpoint -q "$folder/proc" || mount -t proc proc "$folder/proc"
mountpoint -q "$folder/dev" || mount --bind /dev "$folder/dev"
trap 'umount "$folder/proc" "$folder/dev"' EXIT
inside() { "$@" chroot "$folder" sh -c 'cd "/tmp/bare checkout" && git config --global --add safe.directory "*" 2>/dev/null; make demo && make test'; }
echo "== $suite, with network"
inside env LC_ALL=C.UTF-8
echo "== $suite, without network"
rm -rf "$folder/tmp/bare checkout/build" "$folder/tmp/bare checkout/build-test"
inside env LC_ALL=C.UTF-8 unshare --net
