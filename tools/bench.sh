#!/bin/sh
# Times the program: on the examples, and beside SymPy, Maxima, SUNDIALS, GSL, heyoka and SciPy where they are installed
# (docs/benchmarks.md).
# Builds in build-bench, optimised and without assertions.
set -eu
cd "$(dirname "$0")/.."
tools/setup.sh build
log=$(mktemp)
trap 'rm -f "$log"' EXIT
[ -f build-bench/build.ninja ] ||
  meson setup build-bench --buildtype=release -Db_ndebug=true -Dtests=false >"$log" 2>&1 || { cat "$log" >&2; exit 1; }
ninja -C build-bench all motion_kernel >"$log" 2>&1 || { cat "$log" >&2; exit 1; }
bench/bench.py build-bench/pleuel
echo
bench/derivation_peers.py build-bench/pleuel
echo
bench/motion_peers.py build-bench/pleuel --svg build-bench/motion.svg
echo
echo 'Energy of 32 pendulums over 1e5 periods in double and long, some fifteen minutes'
tests/cases/energy_test.py build-bench/pleuel 1e5 32
