#!/bin/sh
# tools/sweep passes a folder of good and refused files, and fails on each kind of misbehaviour.
#     sweep_test.sh SWEEP WHIT SCENES
set -eu
sweep=$1
whit=$2
scenes=$3
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
mkdir "$out/files"
cp "$scenes/cube.json" "$out/files"
echo 'v 0 0 nonsense' >"$out/files/broken.obj"
"$sweep" "$out/files" "$whit" >"$out/table" || { cat "$out/table"; exit 1; }
grep -q '^2 files: 1 rendered, 1 refused, 0 bad$' "$out/table"

# fake BODY: a whit that misbehaves must fail the sweep.
fake() {
    printf '#!/bin/sh\n%s\n' "$1" >"$out/whit"
    chmod +x "$out/whit"
    if WHIT_SWEEP_LIMIT=1 "$sweep" "$out/files" "$out/whit" >"$out/table"; then
        echo "the sweep passes: $1"
        cat "$out/table"
        exit 1
    fi
}

fake 'kill -SEGV $$'
fake 'exec sleep 20'
fake 'exit 1'
fake 'exit 2'
fake 'echo "whit: error: a" >&2; echo "whit: error: b" >&2; exit 2'
fake 'touch "$4"; echo "whit: error: a" >&2; exit 2'
rm "$out"/files/*
fake 'exit 0'
