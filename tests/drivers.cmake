# Sets test_drivers: the Vulkan drivers of the tests, lavapipe wherever they run, unless WHIT_TEST_DRIVERS
# says otherwise; empty where lavapipe is not installed.
set(WHIT_TEST_DRIVERS "$ENV{WHIT_TEST_DRIVERS}" CACHE STRING
  "Vulkan drivers of the tests: empty: lavapipe; system: all; else manifests as in VK_DRIVER_FILES")
set(test_drivers "${WHIT_TEST_DRIVERS}")
if(NOT test_drivers)
  file(GLOB test_drivers /usr/share/vulkan/icd.d/lvp_icd*.json /etc/vulkan/icd.d/lvp_icd*.json
    /usr/local/share/vulkan/icd.d/lvp_icd*.json)
  if(test_drivers)
    list(SORT test_drivers)
    list(GET test_drivers 0 test_drivers)
  endif()
endif()
