# The depth report's page and its chart library, Chart.js from the package libjs-chart.js, as a C++ source. A script for
# `cmake -P`: PAGE, LIBRARY (may be empty), TEMPLATE, OUTPUT.
file(READ "${PAGE}" REPORT_PAGE)
set(CHART_LIBRARY "")
if(LIBRARY)
  file(READ "${LIBRARY}" CHART_LIBRARY)
endif()
set(DELIMITER halfplane_asset)
configure_file("${TEMPLATE}" "${OUTPUT}" @ONLY)
