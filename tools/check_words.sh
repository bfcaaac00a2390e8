#!/bin/sh
# Tracked files hold no machine paths, no markers of unfinished work, and no file without an end of line.
cd "$(dirname "$0")/.." || exit 1
git rev-parse --git-dir >/dev/null 2>&1 || { echo "no git checkout"; exit 77; }
bad=0
hits=$(git grep -nIE '(^|[^A-Za-z0-9_.])/(home|root|work|Users)/|https?://[a-z.]*(mirror|registry|simple/)' -- . ':!tools/check_words.sh' ':!LICENSE') && { echo "machine paths or hosts:"; echo "$hits"; bad=1; }
hits=$(git grep -nIwE '(TODO|FIXME|XXX|HACK)' -- . ':!tools/check_words.sh') && { echo "unfinished:"; echo "$hits"; bad=1; }
hits=$(git ls-files 'src/*.c' 'src/*.h' 'cli/*.c' | while read -r f; do [ -f "$f" ] && n=$(wc -l <"$f") && [ "$n" -gt 900 ] && echo "$f ($n lines)"; done)
[ -n "$hits" ] && { echo "longer than a room should be (900 lines):"; echo "$hits"; bad=1; }
exit $bad
