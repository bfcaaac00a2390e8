#!/bin/sh
# Prints the name of a clang that is installed, the plain one first, then the newest; fails when there is none.
for c in clang clang-21 clang-20 clang-19 clang-18 clang-17 clang-16 clang-15 clang-14; do
  command -v "$c" >/dev/null 2>&1 && { echo "$c"; exit 0; }
done
exit 1
