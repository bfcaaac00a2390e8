#!/bin/sh
# Times the program on the examples, as whole processes: best of several runs, in milliseconds.
set -eu
cd "$(dirname "$0")/.."
tools/build.sh --quiet
bench/bench.py build/pleuel
