#!/bin/sh
# Models that were made for other programs look right at the first look, without any option: all below the folder
# $WHIT_MODELS load, are framed, are neither burnt nor black, and show their shape in clay (tools/appearance.h).
#     first_look_test.sh WHIT SCENES CONTACT_SHEET
. "$(dirname "$0")/common.sh"
WHIT=$3
[ -n "${WHIT_MODELS:-}" ] || { echo "SKIPPED: WHIT_MODELS names no folder of models"; exit 77; }
expect 0 "models in $WHIT_MODELS" "$WHIT_MODELS" -o "$OUT/sheet.png" --size 320x240 --aa 4 --check yes
grep -v ' right ' "$OUT/stdout"
finish
