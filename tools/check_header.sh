#!/bin/sh
# The public header compiles alone, in C99 and newer and in C++, without a warning.
set -eu
cd "$(dirname "$0")/.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
printf '#include "pleuel.h"\n#include "pleuel.h"\nint main(void) { return 0; }\n' >"$work/try.c"
cp "$work/try.c" "$work/try.cc"
for std in c99 c11 c17; do
  ${CC:-cc} -std=$std -Wall -Wextra -Wpedantic -Werror -Iinclude -c "$work/try.c" -o "$work/try.o"
done
if command -v c++ >/dev/null 2>&1; then
  for std in c++11 c++17; do
    c++ -std=$std -Wall -Wextra -Wpedantic -Werror -Iinclude -c "$work/try.cc" -o "$work/try.o"
  done
else
  echo "the C++ half needs g++"
  exit 77
fi
