#!/bin/sh
# tools/sweep passes for a folder of good and refused files, and fails for each kind of misbehaviour of whit.
. "$(dirname "$0")/common.sh"
mkdir "$OUT/files"
cp "$CUBE" "$OUT/files"
echo 'v 0 0 nonsense' >"$OUT/files/broken.obj"
printf 'OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n' >"$OUT/files/triangle.OFF"

sweep() {
    WHIT_SWEEP_LIMIT=$1 "$SCENES/../tools/sweep" "$OUT/files" "$2" >"$OUT/stdout" 2>"$OUT/stderr"
}
check "two good files and a broken one" sweep 10 "$WHIT"
check "are counted" grep -q '^3 files: 2 rendered, 1 refused, 0 bad$' "$OUT/stdout"

# fake BODY [SECONDS]: a script with this body, in the place of whit, fails the sweep.
fake() {
    printf '#!/bin/sh\n%s\n' "$1" >"$OUT/whit"
    chmod +x "$OUT/whit"
    sweep "${2:-10}" "$OUT/whit"
    check "fails: $1" test $? -ne 0
}
fake 'kill -SEGV $$'
fake 'exec sleep 20' 0.1
fake 'exit 1'
fake 'exit 2'
fake 'echo "whit: error: a" >&2; echo "whit: error: b" >&2; exit 2'
fake 'touch "$4"; echo "whit: error: a" >&2; exit 2'
rm "$OUT"/files/*
fake 'exit 0'
finish
