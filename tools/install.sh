#!/bin/sh
# Installs into PREFIX (first argument), below $DESTDIR if that is set.
set -eu
cd "$(dirname "$0")/.."
tools/build.sh --quiet
meson configure build --prefix "$1" >/dev/null
DESTDIR=${DESTDIR:-} meson install -C build --no-rebuild >build/install.log 2>&1 || {
  # the prefix is part of generated files: build again, then install
  ninja -C build >build/build.log 2>&1 && DESTDIR=${DESTDIR:-} meson install -C build >build/install.log 2>&1
} || { tail -n 20 build/install.log >&2; exit 1; }
echo "installed below ${DESTDIR:-}$1 (list: build/meson-logs/install-log.txt)"
