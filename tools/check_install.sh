#!/bin/sh
# Installs into a folder with a blank in its name and builds programs against what was installed: C and
# C++, through pkg-config and through CMake, shared and static.
# Usage: tools/check_install.sh [BUILD]
set -eu
cd "$(dirname "$0")/.."
build=${1:-build-test/gcc}
folder=$(mktemp -d "${TMPDIR:-/tmp}/pleuel install XXXXXX")
trap 'rm -rf "$folder"' EXIT
meson install -C "$build" --no-rebuild --destdir "$folder" >/dev/null
prefix=$(find "$folder" -path '*/bin/pleuel' -type f | head -n 1)
prefix=${prefix%/bin/pleuel}
[ -n "$prefix" ] || { echo "no bin/pleuel was installed"; exit 1; }
for f in include/pleuel.h share/man/man1/pleuel.1 share/man/man1/pleuel-sim.1 share/man/man5/pleuel.5 \
         share/man/de/man1/pleuel.1 share/man/de/man1/pleuel-sim.1 share/man/de/man5/pleuel.5 \
         share/bash-completion/completions/pleuel share/zsh/site-functions/_pleuel share/fish/vendor_completions.d/pleuel.fish \
         share/doc/pleuel/examples/ski.pleuel share/doc/pleuel/LICENSE share/doc/pleuel/NOTICE; do
  [ -e "$prefix/$f" ] || [ -e "$prefix/$f.gz" ] || { echo "$f was not installed"; exit 1; }
done

# the program runs from where it was installed
"$prefix/bin/pleuel" check "$prefix/share/doc/pleuel/examples/ski.pleuel" >/dev/null

# the shared library says which version of the interface it has
library=$(find "$prefix" -name 'libpleuel.so.*' | head -n 1)
[ -n "$library" ] || { echo "no libpleuel.so was installed"; exit 1; }
LC_ALL=C readelf -d "$library" | grep -q 'SONAME.*libpleuel\.so\.0' || { echo "no soname"; exit 1; }

# programs of somebody else
cat >"$folder/embed.c" <<'C'
#include <pleuel.h>
#include <stdio.h>
#include <string.h>
int main(void) {
  static const char text[] = "param m = 1, g = 10\ncoord z\nmass m at (z)\naxes z up\ngravity g along -z\ninit z = 1, z' = 0\nsimulate 0..1\n";
  pleuel *ctx = pleuel_open(NULL);
  pleuel_model *model = NULL;
  const char *words = NULL;
  pleuel_status s = pleuel_load_text(ctx, &model, text, strlen(text), NULL);
  if (s == PLEUEL_OK) s = pleuel_solve_text(model, &words, NULL);
  printf("%s %s\n", pleuel_version(), pleuel_status_name(s));
  pleuel_close(ctx);
  return s;
}
C
cp "$folder/embed.c" "$folder/embed.cc"
pc=$(find "$prefix" -name pleuel.pc | head -n 1)
[ -n "$pc" ] || { echo "no pleuel.pc was installed"; exit 1; }
export PKG_CONFIG_PATH="${pc%/*}"
export LD_LIBRARY_PATH="${library%/*}"

# link NAME COMPILER SOURCE
link() {
  name=$1 compiler=$2 source=$3
  eval "set -- $(pkg-config --cflags --libs pleuel)"    # blanks come quoted
  "$compiler" -Wall -Wextra -Werror "$folder/$source" -o "$folder/$name" "$@"
  "$folder/$name"
}
link shared-c "${CC:-cc}" embed.c
reason=
if command -v c++ >/dev/null 2>&1; then link shared-cxx c++ embed.cc; else reason="the C++ half needs g++"; fi

# the archive: what it needs comes from the .pc file, itself by name
archive=$(find "$prefix" -name libpleuel.a | head -n 1)
[ -n "$archive" ] || { echo "no libpleuel.a was installed"; exit 1; }
eval "set -- $(pkg-config --static --libs-only-l --libs-only-other pleuel | sed 's/-lpleuel//')"
"${CC:-cc}" "$folder/embed.c" -I"$prefix/include" -o "$folder/archive" "$archive" "$@"
"$folder/archive"

if command -v cmake >/dev/null 2>&1; then
  mkdir "$folder/project"
  cp "$folder/embed.c" "$folder/embed.cc" "$folder/project"
  languages="C CXX" programs="c cc"
  command -v c++ >/dev/null 2>&1 || { languages=C programs=c; }
  {
    echo 'cmake_minimum_required(VERSION 3.13)'
    echo "project(embed $languages)"
    echo 'find_package(pleuel 0.1 REQUIRED)'
    for p in $programs; do
      for kind in pleuel pleuel_static; do
        echo "add_executable(embed_${p}_$kind embed.$p)"
        echo "target_link_libraries(embed_${p}_$kind pleuel::$kind)"
      done
    done
  } >"$folder/project/CMakeLists.txt"
  cmake -S "$folder/project" -B "$folder/project/build" -DCMAKE_PREFIX_PATH="$prefix" >"$folder/cmake.log" 2>&1 \
    && cmake --build "$folder/project/build" >>"$folder/cmake.log" 2>&1 || { cat "$folder/cmake.log"; exit 1; }
  for p in $programs; do
    for kind in pleuel pleuel_static; do "$folder/project/build/embed_${p}_$kind"; done
  done
else
  reason="the CMake half needs cmake"
fi

# nothing but the interface is exported
others=$(nm -D --defined-only "$library" | awk '$2 != "A" { print $3 }' | sed 's/@.*//' | grep -v '^pleuel_' || true)
[ -z "$others" ] || { echo "exported, but no interface: $others"; exit 1; }
[ -z "$reason" ] || { echo "$reason"; exit 77; }
