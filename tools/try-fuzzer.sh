#!/bin/sh
# Can the clang that is installed build libFuzzer programs?  77 (skipped) when not.
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
echo 'int LLVMFuzzerTestOneInput(const char* p, unsigned long n) { return p && n == 1; }' >"$work/fuzz.c"
clang=$("$(dirname "$0")/find-clang.sh") || { echo "no clang installed"; exit 77; }
"$clang" -fsanitize=fuzzer,address "$work/fuzz.c" -o "$work/fuzz" 2>/dev/null || { echo "$clang lacks the libFuzzer run-time library"; exit 77; }
