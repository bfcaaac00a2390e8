#!/bin/sh
# Solves and simulates one of the examples and says what was written where.
set -eu
cd "$(dirname "$0")/.."
tools/build.sh --quiet
model=examples/ski.pleuel
mkdir -p build/demo
echo "\$ pleuel $model"
build/pleuel "$model" | tee build/demo/ski.txt
echo
echo "\$ pleuel sim $model -o ski.csv"
build/pleuel sim "$model" -f -o build/demo/ski.csv
echo
echo "\$ pleuel report $model -o ski.html"
build/pleuel report "$model" -f -o build/demo/ski.html
echo
echo "written:"
echo "  build/demo/ski.txt   the worked solution, as above ($(wc -l <build/demo/ski.txt) lines)"
echo "  build/demo/ski.csv   the motion: $(head -n 1 build/demo/ski.csv | tr ',' '\n' | wc -l) columns, $(wc -l <build/demo/ski.csv) lines"
echo "  build/demo/ski.html  everything in one page ($(($(wc -c <build/demo/ski.html) / 1000)) kB): open it in a browser, it needs no network"
echo "Next:  build/pleuel new pendulum   or   build/pleuel examples"
