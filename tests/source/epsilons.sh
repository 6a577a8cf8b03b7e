#!/bin/sh
# No epsilon in world units: every number below 0.01 in shaders/ and in the modules of host/ that handle
# geometry stands in epsilons.txt with the reason why it is none, and every entry there is used. The other
# modules hand times, colours and options around.
#     tests/source/epsilons.sh ROOT
set -eu
here=$(cd "$(dirname "$0")" && pwd)
cd "$1"
find shaders host/accel host/load host/reference host/render host/scene -type f \
    ! -name '*.cmake' ! -name CMakeLists.txt |
    LC_ALL=C sort | LC_ALL=C xargs awk -f "$here/epsilons.awk" "$here/epsilons.txt"
