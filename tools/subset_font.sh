#!/bin/sh
# Makes src/report/assets/math.woff2 from the STIX Math font of the Debian package fonts-stix: letters, Greek, digits and the
# operators that formulas use, with the table that lets brackets and roots grow.  Needs fonts-stix, python3-fonttools and
# python3-brotli; the build does not, since the result is kept.  The name is changed, as the font's licence asks of a
# changed version.
set -eu
cd "$(dirname "$0")/.."
font=${1:-/usr/share/fonts/opentype/stix-word/STIXMath-Regular.otf}
out=src/report/assets/math.woff2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
letters=U+0020-007E,U+00A0,U+00A8,U+00AC,U+00AF,U+00B0,U+00B1,U+00B7,U+00D7,U+00C4,U+00D6,U+00DC,U+00DF,U+00E4,U+00F6,U+00FC
greek=U+0391-03A9,U+03B1-03C9,U+03D1,U+03D5,U+03D6,U+03F0,U+03F1,U+03F5
italic=U+1D434-1D467,U+210E,U+1D6E2-1D71B
# Double arrows stay out: with them Chromium finds the table unsound and lets no bracket grow.
signs=U+02C6,U+02D9,U+2013,U+2016,U+2020,U+2026,U+2032,U+2033,U+2061,U+2062,U+20D7,U+2190-2194,U+2202,U+2206,U+2207
more=U+2208,U+2211,U+2212,U+221A,U+221D,U+221E,U+222B,U+2248,U+2260,U+2264,U+2265,U+226A,U+226B,U+22C5,U+23B0,U+27E8,U+27E9
/usr/bin/python3 -m fontTools.subset "$font" --output-file="$work/math.otf" --layout-features=ssty --drop-tables+=GPOS,GDEF,FFTM \
  --no-hinting --desubroutinize --name-IDs='0,1,2,4,6,13,14' --unicodes="$letters,$greek,$italic,$signs,$more"
/usr/bin/python3 - "$work/math.otf" "$out" <<'END'
import sys
from fontTools.ttLib import TTFont
f = TTFont(sys.argv[1], recalcTimestamp=False)
for record in f["name"].names:
    if record.nameID in (1, 4): f["name"].setName("Pleuel Math", record.nameID, record.platformID, record.platEncID, record.langID)
    if record.nameID == 6: f["name"].setName("PleuelMath-Regular", 6, record.platformID, record.platEncID, record.langID)
if "CFF " in f:
    top = f["CFF "].cff
    top.fontNames = ["PleuelMath-Regular"]
    top[0].FamilyName, top[0].FullName = "Pleuel Math", "Pleuel Math"
f.flavor = "woff2"
f.save(sys.argv[2])
END
echo "$out: $(wc -c <"$out") bytes"
