#!/bin/sh
# A third of all scenes under GPU-assisted validation, others with each commit (WHIT_TEST_OFFSET):
#     sh validated_turns.sh PICTURE_CHECK SCENE...
set -u
check=$1
shift
turn=${WHIT_TEST_OFFSET:-0} status=0 done=0
for scene in "$@"; do
    turn=$((turn + 1))
    [ $((turn % 3)) -eq 0 ] || continue
    "$check" "$scene" validated || status=1
    done=$((done + 1))
done
[ "$done" -gt 0 ] || exit 1
exit "$status"
