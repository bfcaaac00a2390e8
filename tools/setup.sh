#!/bin/sh
# Installs what is missing to build pleuel, and says what and why.  Usage: tools/setup.sh build|test
#
# What counts is whether a thing can be used, not which version a package has: each need is tried (a program is looked
# for, a library is compiled against).  When nothing is missing neither network nor root is needed.
# Ends with 0 when everything of the set can be used, 1 when something is still missing.
set -u
set_name=${1:-build}
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT

# need SET PACKAGE WHY CHECK...      the check is a command that succeeds when the thing can be used
missing= needed= reasons=
need() {
  in_set=$1 package=$2 why=$3
  shift 3
  [ "$in_set" = build ] || [ "$set_name" = test ] || return 0
  "$@" >/dev/null 2>&1 && return 0
  missing="$missing $package"
  [ "$optional" = yes ] || needed="$needed $package"
  reasons="$reasons  $package: $why
"
}

# wish SET PACKAGE WHY CHECK...      the same for what the build can do without
optional=no
wish() {
  optional=yes
  need "$@"
  optional=no
}

# Ends with 1, or with 0 when nothing is missing but what is optional.
give_up() {
  [ -n "$needed" ] && exit 1
  echo "These are optional: pleuel is built without what they are for." >&2
  exit 0
}

# program NAME...    one of them is on the path
program() {
  for p in "$@"; do command -v "$p" && return 0; done
  return 1
}

# library FLAGS INCLUDES...    a program that includes these headers compiles and links
library() {
  flags=$1
  shift
  for h in "$@"; do echo "#include <$h>"; done >"$work/try.c"
  echo 'int main(void) { return 0; }' >>"$work/try.c"
  # shellcheck disable=SC2086
  ${CC:-cc} -I/usr/include/suitesparse -I/usr/include/flint "$work/try.c" -o "$work/try" $flags
}

# Arb is a library of its own before FLINT 3 and part of FLINT since.
arb() { library '-lflint' stdio.h flint/arb.h || library '-lflint-arb -lflint' arb.h; }

# Any LLVM from 14 to 19 with the headers of its C interface; 0.7 GB, so only for the tests.
llvm() {
  for v in 19 18 17 16 15 14; do
    command -v "llvm-config-$v" >/dev/null 2>&1 || continue
    library "-I$("llvm-config-$v" --includedir) -L$("llvm-config-$v" --libdir) -lLLVM-$v" llvm-c/LLJIT.h && return 0
    library "-I$("llvm-config-$v" --includedir) -L$("llvm-config-$v" --libdir) -lLLVM" llvm-c/LLJIT.h && return 0
  done
  return 1
}

# The fuzz run needs the run-time library of a clang.
fuzzer() {
  echo 'int LLVMFuzzerTestOneInput(const char* p, unsigned long n) { return p && n == 1; }' >"$work/fuzz.c"
  clang=$("$(dirname "$0")/find-clang.sh") && "$clang" -fsanitize=fuzzer,address "$work/fuzz.c" -o "$work/fuzz"
}
clang_version() { apt-cache depends clang 2>/dev/null | sed -n 's/.*Depends: clang-\([0-9][0-9]*\)$/\1/p' | head -n 1; }

look() {
  missing= needed= reasons=
  need build gcc            'compiles the C sources'                         program cc gcc
  need build libc6-dev      'headers of the C library'                       library -lm math.h
  need build meson          'describes the build'                            program meson
  need build ninja-build    'runs the build'                                 program ninja
  need build pkg-config     'finds libraries'                                program pkg-config pkgconf
  need build python3        'generates tables at build time'                 program python3
  need build re2c           'generates the lexer of the model language'      program re2c
  need build bison          'generates the parser of the model language'     program bison
  need build libgmp-dev     'exact numbers'                                  library -lgmp gmp.h
  need build libmpfr-dev    'numbers with many digits'                       library -lmpfr stdio.h mpfr.h
  need build libflint-dev   'exact algebra'                                  library -lflint stdio.h flint/fmpz_mpoly.h
  need build libflint-arb-dev 'numbers with proven error bounds'             arb
  need build libsuitesparse-dev 'sparse linear systems (KLU)'                library -lklu klu.h
  wish build libcairo2-dev  'PNG, PDF and GIF pictures (SVG does without)'   library -lcairo cairo/cairo.h cairo/cairo-pdf.h
  need test  libcmocka-dev  'unit tests'                                     library -lcmocka stdarg.h stddef.h setjmp.h stdint.h cmocka.h
  need test  chromium       'shows the HTML reports to the tests'             program chromium chromium-browser
  need test  nodejs         'drives the browser (playwright-core from npm)'   program node nodejs
  need test  npm            'fetches playwright-core, axe-core and vnu-jar for the tests' program npm
  need test  g++            'tries the public header in C++'                 program c++ g++
  need test  llvm-dev       'compiles motions: the plugin, which the build leaves out without it' llvm
  need test  clang          'second opinion on warnings'                     "$(dirname "$0")/find-clang.sh"
  need test  "libclang-rt-$(clang_version)-dev" 'random input for the parser (libFuzzer)' fuzzer
}

# Missing packages that this release of Debian has; Debian 13 has no libflint-arb-dev, because FLINT 3 brings Arb along.
known() {
  for p in $missing; do
    LC_ALL=C apt-cache policy "$p" 2>/dev/null | grep -q 'Candidate: [^(]' && printf ' %s' "$p"
  done
}
tell() {
  echo "To build pleuel${set_name#build}, these packages are missing:" | sed 's/pleueltest/and test pleuel/' >&2
  for p in $(known); do printf '%s' "$reasons" | grep -F "  $p:" >&2; done
}

as_root() {
  if [ "$(id -u)" = 0 ]; then env DEBIAN_FRONTEND=noninteractive "$@"
  else sudo env DEBIAN_FRONTEND=noninteractive "$@"; fi
}
may_be_root() {
  [ "$(id -u)" = 0 ] && return 0
  command -v sudo >/dev/null 2>&1 || return 1
  sudo -n true 2>/dev/null || [ -t 0 ]
}

look
[ -n "$missing" ] || exit 0
if ! command -v apt-get >/dev/null 2>&1; then
  echo "To build pleuel, these are missing (names of Debian packages):" >&2
  printf '%s' "$reasons" >&2
  echo "This is no Debian-like system: please install the same things with its own package manager." >&2
  give_up
fi

# A fresh machine has no package lists yet.
if [ -z "$(known)" ]; then
  if may_be_root; then
    echo "Fetching the package lists ..." >&2
    as_root apt-get update -q >"$work/update.log" 2>&1 || tail -n 3 "$work/update.log" >&2
  else
    echo "Please run, as root:  apt-get update && apt-get install --no-install-recommends$missing" >&2
    give_up
  fi
fi
if [ -z "$(known)" ]; then
  echo "Missing, and the package lists could not be fetched:$missing" >&2
  give_up
fi
tell
if ! may_be_root; then
  echo "Please run, as root:  apt-get install --no-install-recommends$(known)" >&2
  give_up
fi

install_known() {
  packages=$(known)
  [ -n "$packages" ] || return 1
  # shellcheck disable=SC2086
  as_root apt-get install -y -q --no-install-recommends $packages >"$work/apt.log" 2>&1
}
echo "Installing:$(known)" >&2
if ! install_known; then      # lists may be stale: once more with new ones
  as_root apt-get update -q >"$work/update.log" 2>&1
  install_known || tail -n 5 "$work/apt.log" >&2
fi
# The run-time library of clang can be named only when clang is known, so a second round may follow.
look
[ -z "$missing" ] || { install_known; look; }
[ -n "$missing" ] || exit 0
echo "Still missing:$missing" >&2
give_up
