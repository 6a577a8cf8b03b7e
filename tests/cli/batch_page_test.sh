#!/bin/sh
# Runs each command of docs/batch.md (the third argument) in turn, as a user would type it, and its Makefile. Commands
# that need a cluster are in slurm_test.sh. This test is long.
. "$(dirname "$0")/common.sh"
PAGE=$(cd "$(dirname "$3")" && pwd)/$(basename "$3")
needs parallel
needs make
mkdir "$OUT/here" && cd "$OUT/here" && ln -s "$SCENES" scenes || exit 1
PATH=$(dirname "$WHIT"):$PATH
export PATH

sed -n '/^```make$/,/^```$/p' "$PAGE" | grep -v '^```' >Makefile
sed -n 's/^    //p' "$PAGE" | grep -v -e '^sbatch' -e '^tools/slurm' >commands
check "there are ten commands or more" test "$(grep -c . commands)" -ge 10
while read -r line; do
    check "$line" sh -c "$line" >said 2>&1 </dev/null
    cat said >>"$OUT/stderr"
    grep -E "^(ok|FAILED)" said
    grep -q "^FAILED" said && FAILED=1
done <commands

# The merged pictures are those of one run.
run render scenes/room.json -o one.exr --size 1024x1024 -q
check "tiles" cmp one.exr room.exr
run render scenes/room.json -o one.exr --aa 16 -q
expect 0 "runs of samples" compare one.exr smooth.exr --metric differing --tolerance 0
run render scenes/room.json -o one.exr -q
check "tiles by GNU parallel" cmp one.exr parallel.exr
check "tiles by make" cmp one.exr all.exr
run render scenes/cube.json -o one.png --shadows none -q
check "lines" cmp one.png bright.png
check "views of sixteen cameras" test "$(ls view.*.png ids.*.exr | wc -l)" -eq 32
run render scenes/swarm.json -o one.png --frame 149 -q
check "frames" cmp one.png swarm.0149.png
finish
