#!/bin/sh
# No epsilon in world units: every number below 0.01 in host/ and shaders/ stands in epsilons.txt with
# the reason why it is none, and every entry there is used:
#     tests/source/epsilons.sh ROOT
set -eu
here=$(cd "$(dirname "$0")" && pwd)
cd "$1"
find host shaders -name '*.c' -o -name '*.h' -o -name '*.cpp' -o -name '*.glsl' -o -name '*.comp' |
    LC_ALL=C sort | LC_ALL=C xargs awk -f "$here/epsilons.awk" "$here/epsilons.txt"
