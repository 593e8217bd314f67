# SPDX-FileCopyrightText: 2026 The cartographer_ext authors
# SPDX-License-Identifier: Apache-2.0
#
# The examples against an installation of the cores: configured with find_package, compiled, run.
#   cmake -DSOURCE_DIR=<this project> -DBUILD_DIR=<its build> -DWORK_DIR=<scratch folder> -P installed_test.cmake
file(REMOVE_RECURSE "${WORK_DIR}")
set(output)
macro(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE error)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${ARGN} failed:\n${output}${error}")
  endif()
endmacro()
run("${CMAKE_COMMAND}" --install "${BUILD_DIR}" --prefix "${WORK_DIR}/prefix" --component cores)
set(flags)
if(SANITIZE)
  set(flags "-DCMAKE_CXX_FLAGS=-fsanitize=${SANITIZE}")
endif()
run("${CMAKE_COMMAND}" -S "${SOURCE_DIR}/examples" -B "${WORK_DIR}/build" "-DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix"
    -DCMAKE_BUILD_TYPE=Debug ${flags})
run("${CMAKE_COMMAND}" --build "${WORK_DIR}/build" --parallel 2)
run("${WORK_DIR}/build/search_scan")
if(NOT output MATCHES "found at 12.[23]")
  message(FATAL_ERROR "search_scan said: ${output}")
endif()
run("${WORK_DIR}/build/verify_loop")
# A square with one right loop and one wrong one.
file(WRITE "${WORK_DIR}/square.g2o" "VERTEX_SE2 0 0 0 0
VERTEX_SE2 1 1 0 1.5708
VERTEX_SE2 2 1 1 3.14159
VERTEX_SE2 3 0 1 -1.5708
VERTEX_SE2 4 0.1 0 0
EDGE_SE2 0 1 1 0 1.5708 400 0 0 400 0 400
EDGE_SE2 1 2 1 0 1.5708 400 0 0 400 0 400
EDGE_SE2 2 3 1 0 1.5708 400 0 0 400 0 400
EDGE_SE2 3 4 1 0 1.5708 400 0 0 400 0 400
EDGE_SE2 4 0 0 0 0 400 0 0 400 0 400
EDGE_SE2 2 0 5 5 0 400 0 0 400 0 400
")
run("${WORK_DIR}/build/solve_g2o" "${WORK_DIR}/square.g2o" "${WORK_DIR}/solved.g2o")
if(NOT output MATCHES "5 poses, 1 of 2 loops accepted")
  message(FATAL_ERROR "solve_g2o said: ${output}")
endif()
if(NOT EXISTS "${WORK_DIR}/solved.g2o")
  message(FATAL_ERROR "solve_g2o wrote nothing")
endif()
