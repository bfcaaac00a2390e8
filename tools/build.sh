#!/bin/sh
# Builds the program: build/pleuel.  Set-up first, so that this works on a fresh machine.
set -eu
cd "$(dirname "$0")/.."
tools/setup.sh build
[ -f build/build.ninja ] || meson setup build --buildtype=release -Dtests=false >build.log 2>&1 || { cat build.log >&2; exit 1; }
rm -f build.log
ninja -C build >build/build.log 2>&1 || { cat build/build.log >&2; exit 1; }
[ "${1:-}" = --quiet ] || echo "built: build/pleuel"
