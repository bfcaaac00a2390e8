#!/bin/sh
# Feeds the parser random input, starting from the examples and the wrong models.  Usage: tools/fuzz.sh BUILD SECONDS
set -eu
build=$1 seconds=$2
harness=$build/src/lang/parse_fuzz
[ -x "$harness" ] || { echo "$harness was not built"; exit 1; }
seeds=build-test/fuzz-seeds
rm -rf "$seeds" && mkdir -p "$seeds" build-test/fuzz-found
cp examples/*.pleuel "$seeds/"
[ ! -d tests/wrong ] || cp tests/wrong/*.pleuel "$seeds/"
"$harness" -max_total_time="$seconds" -max_len=4096 -timeout=10 -rss_limit_mb=2048 -print_final_stats=1 \
  -artifact_prefix=build-test/fuzz-found/ "$seeds" 2>&1 | tail -n 40
