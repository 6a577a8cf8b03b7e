#!/bin/sh
# The Vulkan loader does not open Mesa's drivers for hardware where the system has none; the environment can choose others.
. "$(dirname "$0")/common.sh"
unset VK_DRIVER_FILES VK_ICD_FILENAMES VK_ADD_DRIVER_FILES VK_LOADER_DRIVERS_SELECT VK_LOADER_DRIVERS_DISABLE RADV_FORCE_FAMILY
export VK_LOADER_DEBUG=driver

# drivers WHAT ARGUMENT...: sets $found to the number of such drivers that the loader finds, $ignored to that of drivers
# that it leaves out.
drivers() {
    expect 0 "$@"
    found=$(grep 'Found ICD manifest' "$OUT/stderr" | grep -c -e intel -e nouveau -e radeon -e virtio)
    ignored=$(grep -c 'ignored because it was disabled' "$OUT/stderr")
}

drivers "a picture" render "$CUBE" --size 16x8 -o "$OUT/cube.pfm"
[ "$found" -gt 0 ] || {
    echo "SKIPPED: no driver for hardware is installed (Debian: mesa-vulkan-drivers)"
    exit 77
}
if [ -e /dev/dri ]; then
    check "with hardware all are opened" test "$ignored" -eq 0
else
    check "without hardware none of $found is opened" test "$ignored" -eq "$found"
fi
drivers "all devices" devices
check "\`whit devices\` opens all" test "$ignored" -eq 0
VK_LOADER_DRIVERS_DISABLE=none.json drivers "the loader's own variable" render "$CUBE" --size 16x8 -o "$OUT/cube.pfm"
check "stays as it is" test "$ignored" -eq 0
RADV_FORCE_FAMILY=navi21 drivers "a driver that does without hardware" scene "$CUBE" --kernels --device llvmpipe --size 16x8
check "is opened" test "$ignored" -eq 0
finish
