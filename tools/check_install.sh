#!/bin/sh
# Installs into a folder and builds a program against what was installed, through pkg-config.
set -eu
cd "$(dirname "$0")/.."
folder=$(mktemp -d)      # not inside of this checkout: pkg-config cannot do with blanks in a path
trap 'rm -rf "$folder"' EXIT
meson install -C build-test/gcc --no-rebuild --destdir "$folder" >/dev/null
prefix=$(find "$folder" -path '*/bin/pleuel' -type f | head -n 1)
prefix=${prefix%/bin/pleuel}
[ -n "$prefix" ] || { echo "no bin/pleuel was installed"; exit 1; }
for f in include/pleuel.h share/man/man1/pleuel.1 share/man/man1/pleuel-sim.1 share/man/man5/pleuel.5 \
         share/man/de/man1/pleuel.1 share/man/de/man1/pleuel-sim.1 share/man/de/man5/pleuel.5 \
         share/bash-completion/completions/pleuel share/zsh/site-functions/_pleuel share/fish/vendor_completions.d/pleuel.fish \
         share/doc/pleuel/examples/ski.pleuel; do
  [ -e "$prefix/$f" ] || [ -e "$prefix/$f.gz" ] || { echo "$f was not installed"; exit 1; }
done

# the program runs from where it was installed
"$prefix/bin/pleuel" check "$prefix/share/doc/pleuel/examples/ski.pleuel" >/dev/null

# a program of somebody else, with nothing but pkg-config
pc=$(find "$prefix" -name pleuel.pc | head -n 1)
[ -n "$pc" ] || { echo "no pleuel.pc was installed"; exit 1; }
cat >"$folder/embed.c" <<'C'
#include <pleuel.h>
#include <string.h>
int main(void) {
  static const char text[] = "param m = 1, g = 10\ncoord z\nmass m at (z)\naxes z up\ngravity g along -z\ninit z = 1, z' = 0\nsimulate 0..1\n";
  pleuel *ctx = pleuel_open(NULL);
  pleuel_model *model = NULL;
  pleuel_sim_summary how;
  pleuel_status s = pleuel_load_text(ctx, &model, text, strlen(text), NULL);
  if (s == PLEUEL_OK) s = pleuel_simulate(model, &how, NULL);
  printf("%s %s %g\n", pleuel_version(), pleuel_status_name(s), how.t_end);
  pleuel_close(ctx);
  return s;
}
C
export PKG_CONFIG_PATH="${pc%/*}" PKG_CONFIG_SYSROOT_DIR="$folder"
# shellcheck disable=SC2046
${CC:-cc} -Wall -Wextra -Werror "$folder/embed.c" -o "$folder/embed" $(pkg-config --cflags --libs pleuel)
library=$(find "$prefix" -name 'libpleuel.so.*' | head -n 1)
LD_LIBRARY_PATH=${library%/*} "$folder/embed"

# nothing but the interface is exported
others=$(nm -D --defined-only "$library" | awk '$2 != "A" { print $3 }' | sed 's/@.*//' | grep -v '^pleuel_' || true)
[ -z "$others" ] || { echo "exported, but no interface: $others"; exit 1; }
