#!/bin/sh
# format.sh: lays out the C sources as .clang-format says; needs clang-format 14, the one of Debian 12.
set -e
cd "$(dirname "$0")/.."
for tool in clang-format-14 clang-format; do
  command -v "$tool" >/dev/null && break
  tool=
done
[ -n "$tool" ] || { echo "clang-format is not installed (Debian: apt install clang-format)" >&2; exit 1; }
git ls-files '*.c' '*.h' ':!include' | xargs "$tool" -i
