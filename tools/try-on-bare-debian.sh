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
mounted=
attach() { # POINT ARGUMENTS-OF-MOUNT...
  point=$folder/$1
  shift
  mountpoint -q "$point" && return
  mount "$@" "$point"
  mounted="$mounted $point"
}
attach proc -t proc proc
attach dev --bind /dev
trap '[ -z "$mounted" ] || umount $mounted' EXIT
inside() { "$@" chroot "$folder" sh -c 'cd "/tmp/bare checkout" && make demo && make test'; }
echo "== $suite, with network"
inside env LC_ALL=C.UTF-8
echo "== $suite, without network"
rm -rf "$folder/tmp/bare checkout/build" "$folder/tmp/bare checkout/build-test"
inside env LC_ALL=C.UTF-8 unshare --net
