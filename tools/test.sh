#!/bin/sh
# Everything that can be tested, on a fresh checkout too.  The last line is `N passed, N failed, N skipped`.
#
#   1  gcc, warnings are errors: every test
#   2  AddressSanitizer and UBSan: every test that starts the library or the program
#   3  clang, warnings are errors, and the parser on random input for some seconds
#   4  the house: public header alone, layers, examples of the manual, installation
# Seconds of the fuzz run: FUZZ_SECONDS (10).
set -u
cd "$(dirname "$0")/.." || exit 1
results=build-test/results.txt
mkdir -p build-test
: >"$results"

say() { printf '%s\n' "$*"; }
# record passed|failed|skipped NAME REASON
record() {
  printf '%s\t%s\t%s\n' "$1" "$2" "${3:-}" >>"$results"
  [ "$1" = passed ] || say "  $1: $2${3:+  ($3)}"
}
# part NAME COMMAND...    one test: passed, failed, or skipped when it ends with 77
part() {
  name=$1
  shift
  "$@" >build-test/part.log 2>&1
  code=$?
  case $code in
    0) record passed "$name" ;;
    77) record skipped "$name" "$(tail -n 1 build-test/part.log)" ;;
    *) record failed "$name" "ends with $code"; tail -n 30 build-test/part.log | sed 's/^/    /' ;;
  esac
  return $code
}
configure() { # DIR OPTIONS...
  dir=$1
  shift
  [ -f "$dir/build.ninja" ] || meson setup "$dir" "$@" >"build-test/configure.log" 2>&1 || { cat build-test/configure.log; return 1; }
}
build() { ninja -C "$1" >build-test/ninja.log 2>&1 || { grep -E 'error|warning|FAILED|undefined' build-test/ninja.log || tail -n 30 build-test/ninja.log; return 1; }; }
meson_tests() { # DIR PREFIX MULTIPLIER ARGUMENTS...
  dir=$1 prefix=$2 factor=$3
  shift 3
  meson test -C "$dir" --no-rebuild --print-errorlogs -t "$factor" "$@" >"$dir/test.log" 2>&1
  tools/count_results.py "$dir/meson-logs/testlog.json" "$prefix" >>"$results" || record failed "$prefix" "no results"
  awk -F '\t' -v p="$prefix" 'index($2, p) == 1 && $1 != "passed" { print "  " $1 ": " $2 ($3 == "" ? "" : "  (" $3 ")") }' "$results"
  grep -q '	' "$results"
}

start=$(date +%s)
stage() { say "[$(($(date +%s) - start)) s] $*"; }

tools/setup.sh test || say "(what needs the missing packages is skipped)"

stage "gcc, warnings are errors"
if part "gcc/configure" configure build-test/gcc -Dwerror=true; then
  # a warning is a failure, but no reason to skip the tests
  meson configure build-test/gcc -Dwerror=true
  part "gcc/no warnings" build build-test/gcc || meson configure build-test/gcc -Dwerror=false
  if part "gcc/build" build build-test/gcc; then
    stage "tests"
    meson_tests build-test/gcc gcc 2
  fi
fi

stage "AddressSanitizer and UBSan"
if part "sanitize/configure" configure build-test/sanitize -Db_sanitize=address,undefined -Db_lundef=false \
     --buildtype=debugoptimized && part "sanitize/build" build build-test/sanitize; then
  export UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1 ASAN_OPTIONS=detect_leaks=1
  meson_tests build-test/sanitize sanitize 6 --no-suite house
  unset UBSAN_OPTIONS ASAN_OPTIONS
fi

stage "clang, warnings are errors"
if clang=$(tools/find-clang.sh); then
  export CC="$clang"
  if [ -e build-test/clang/build.ninja ] || part "clang/can build libFuzzer programs" tools/try-fuzzer.sh; then
    fuzz=true
  else
    fuzz=false
  fi
  if [ "$fuzz" = true ]; then
    part "clang/configure" configure build-test/clang -Dwerror=true -Db_lundef=false -Dfuzz=true -Db_sanitize=address,undefined
  else
    part "clang/configure" configure build-test/clang -Dwerror=true -Db_lundef=false
  fi && { meson configure build-test/clang -Dwerror=true
          part "clang/no warnings" build build-test/clang || meson configure build-test/clang -Dwerror=false
          part "clang/build" build build-test/clang; } && {
    if [ "$fuzz" = true ]; then
      stage "parser on random input"
      part "fuzz/parser" tools/fuzz.sh build-test/clang "${FUZZ_SECONDS:-10}"
    else
      record skipped "fuzz/parser" "this clang has no libFuzzer run-time library"
    fi
  }
  unset CC
else
  record skipped "clang/build" "no clang installed"
  record skipped "fuzz/parser" "no clang installed"
fi

stage "the house"
part "house/layers" tools/check_layers.py build-test/gcc
part "house/habits" tools/check_house.py build-test/gcc
part "house/style" tools/check_style.py
part "house/references" tools/check_references.py
part "house/header" tools/check_header.sh
part "house/manual" tools/check_manual.py build-test/gcc/pleuel
part "house/install" tools/check_install.sh
part "house/words" tools/check_words.sh
part "house/sentences" tools/check_sentences.py
part "house/state" tools/check_state.py
part "house/glossary" tools/check_glossary.py

stage "done"
passed=$(grep -c '^passed' "$results")
failed=$(grep -c '^failed' "$results")
skipped=$(grep -c '^skipped' "$results")
say "$passed passed, $failed failed, $skipped skipped"
[ "$failed" = 0 ] && [ "$passed" -gt 0 ]
