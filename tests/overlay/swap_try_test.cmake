# SPDX-FileCopyrightText: 2026 The cartographer_ext authors
# SPDX-License-Identifier: Apache-2.0
#
# A tree whose declarations are all there, but one with another signature, is refused when it is configured, by the function's
# name and with the swaps that remain; the unchanged tree is taken, named, and not compiled again.
#   cmake -DSOURCE_DIR=<this project> -DWORK_DIR=<scratch folder> -P swap_try_test.cmake
file(REMOVE_RECURSE "${WORK_DIR}")
# The bundled host under another path is any other tree.
file(COPY "${SOURCE_DIR}/cartographer_ext/host/" DESTINATION "${WORK_DIR}/tree")
file(WRITE "${WORK_DIR}/tree/package.xml" "<package format=\"3\">\n  <version>2.0.9004</version>\n</package>\n")
file(WRITE "${WORK_DIR}/CMakeLists.txt" "
cmake_minimum_required(VERSION 3.21)
project(robot LANGUAGES C CXX)
set(CMAKE_CXX_STANDARD 17)
add_subdirectory(tree)
include(\"${SOURCE_DIR}/cmake/CartographerExtSwap.cmake\")
cartographer_ext_swap_into(cartographer SWAPS ceres_scan_matcher full_information)
")

# Configures the tree, in a build folder that is kept, and checks its exit and output.
function(expect result_wanted)
  execute_process(COMMAND "${CMAKE_COMMAND}" -S "${WORK_DIR}" -B "${WORK_DIR}/build" RESULT_VARIABLE result
                  OUTPUT_VARIABLE output ERROR_VARIABLE output)
  string(REGEX REPLACE "[ \n]+" " " output "${output}")
  if(NOT result STREQUAL result_wanted)
    message(SEND_ERROR "exit ${result}, not ${result_wanted}: ${output}")
  endif()
  foreach(message IN LISTS ARGN)
    if(NOT output MATCHES "${message}")
      message(SEND_ERROR "expected '${message}', got: ${output}")
    endif()
  endforeach()
  set(output "${output}" PARENT_SCOPE)
endfunction()

expect(0 "compiling each swap against the headers of" "tree is the ROS 2 fork, release 2.0.9004"
       "swapped into cartographer: ceres_scan_matcher.full_information")
expect(0 "swapped into cartographer")
if(output MATCHES "compiling each swap")
  message(SEND_ERROR "the unchanged tree was compiled again: ${output}")
endif()

set(header "${WORK_DIR}/tree/cartographer/mapping/internal/optimization/cost_functions/spa_cost_function_2d.h")
file(READ "${header}" text)
string(REPLACE "Constraint::Pose& pose)" "Constraint::Pose& pose, double scale = 1.)" changed "${text}")
if(changed STREQUAL text)
  message(FATAL_ERROR "nothing was changed in ${header}")
endif()
file(WRITE "${header}" "${changed}")
expect(1 "is the ROS 2 fork, release 2.0.9004, which declares other functions"
       "full_information: StockCreateAutoDiffSpaCostFunction has changed" "Possible here: ceres_scan_matcher\\.")

# What cannot be compiled while configuring is left to the build.
file(WRITE "${header}" "${text}\n#include \"generated_when_built.h\"\n")
expect(0 "own headers do not compile while it is configured" "swapped into cartographer")
