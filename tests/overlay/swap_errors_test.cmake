# SPDX-FileCopyrightText: 2026 The cartographer_ext authors
# SPDX-License-Identifier: Apache-2.0
#
# cartographer_ext_swap_into must refuse, at configure time and with a message that helps, trees that it does not know.
#   cmake -DSOURCE_DIR=<this project> -DWORK_DIR=<scratch folder> -P swap_errors_test.cmake
set(internal "cartographer/mapping/internal/constraints")

# Configures a tree with two libraries' worth of files and checks how that ends.
#   name, lines of CMake after add_library, regular expression of the message
function(expect_error name commands message)
  set(tree "${WORK_DIR}/${name}")
  file(WRITE "${tree}/CMakeLists.txt" "
cmake_minimum_required(VERSION 3.16)
project(tree LANGUAGES NONE)
set(CMAKE_CXX_COMPILER_ID GNU)
include(\"${SOURCE_DIR}/cmake/CartographerExtSwap.cmake\")
set(CARTOGRAPHER_EXT_ALL_SWAPS constraint_builder)
${commands}
message(FATAL_ERROR \"not refused\")
")
  execute_process(COMMAND "${CMAKE_COMMAND}" -S "${tree}" -B "${tree}/build" RESULT_VARIABLE result
                  OUTPUT_VARIABLE output ERROR_VARIABLE error)
  string(REGEX REPLACE "[ \n]+" " " error "${error}")
  if(result EQUAL 0 OR error MATCHES "not refused" OR NOT error MATCHES "${message}")
    message(SEND_ERROR "${name}: expected a message like '${message}', got: ${error}")
  endif()
endfunction()

function(write_stock tree)
  file(WRITE "${tree}/${internal}/constraint_builder_2d.h" "class ConstraintBuilder2D {};\n")
  file(WRITE "${tree}/${internal}/constraint_builder_2d.cc" "\n")
  file(WRITE "${tree}/${internal}/constraint_builder.h" "Options CreateConstraintBuilderOptions(\n    Dictionary*);\n")
  file(WRITE "${tree}/${internal}/constraint_builder.cc" "\n")
endfunction()

file(REMOVE_RECURSE "${WORK_DIR}")
set(sources "${internal}/constraint_builder_2d.cc ${internal}/constraint_builder.cc")
set(add "add_library(cartographer STATIC ${sources})")

expect_error(no_target "cartographer_ext_swap_into(cartographer)" "there is no target 'cartographer'")

write_stock("${WORK_DIR}/missing")
expect_error(missing "add_library(cartographer STATIC ${internal}/constraint_builder.cc)
cartographer_ext_swap_into(cartographer)" "exactly one source cartographer/mapping/internal/constraints/constraint_builder_2d.cc, found 0")

write_stock("${WORK_DIR}/doubled")
write_stock("${WORK_DIR}/doubled/copy")
expect_error(doubled "add_library(cartographer STATIC ${sources} copy/${internal}/constraint_builder_2d.cc)
cartographer_ext_swap_into(cartographer)" "found 2")

write_stock("${WORK_DIR}/no_header")
file(REMOVE "${WORK_DIR}/no_header/${internal}/constraint_builder.h")
expect_error(no_header "${add}
cartographer_ext_swap_into(cartographer)" "constraint_builder.h is missing")

write_stock("${WORK_DIR}/other_api")
file(WRITE "${WORK_DIR}/other_api/${internal}/constraint_builder_2d.h" "class ConstraintBuilder2DWithPriors {};\n")
expect_error(other_api "${add}
cartographer_ext_swap_into(cartographer)" "does not declare ConstraintBuilder2D")

write_stock("${WORK_DIR}/unknown_swap")
expect_error(unknown_swap "${add}
cartographer_ext_swap_into(cartographer SWAPS constraint_bilder)" "there is no swap 'constraint_bilder'")

write_stock("${WORK_DIR}/twice")
expect_error(twice "${add}
set_target_properties(cartographer PROPERTIES CARTOGRAPHER_EXT_SWAPPED TRUE)
cartographer_ext_swap_into(cartographer)" "cartographer is swapped already")

write_stock("${WORK_DIR}/arguments")
expect_error(arguments "${add}
cartographer_ext_swap_into(cartographer constraint_builder)" "unknown arguments: constraint_builder")

write_stock("${WORK_DIR}/compiler")
expect_error(compiler "${add}
set(CMAKE_CXX_COMPILER_ID MSVC)
cartographer_ext_swap_into(cartographer)" "#include_next")

# A tree from before Cartographer 2.0: PointCloud is a vector, there is no TrajectoryState.
set(spa "cartographer/mapping/internal/optimization/cost_functions/spa_cost_function_2d")
write_stock("${WORK_DIR}/old_api")
file(WRITE "${WORK_DIR}/old_api/cartographer/sensor/point_cloud.h" "typedef std::vector<Eigen::Vector3f> PointCloud;\n")
file(WRITE "${WORK_DIR}/old_api/cartographer/mapping/pose_graph_interface.h" "class PoseGraphInterface {};\n")
file(WRITE "${WORK_DIR}/old_api/${spa}.h"
     "Cost* CreateAutoDiffSpaCostFunction(\n    Pose);\nCost* CreateAnalyticalSpaCostFunction(\n    Pose);\n")
file(WRITE "${WORK_DIR}/old_api/${spa}.cc" "\n")
expect_error(old_api "add_library(cartographer STATIC ${sources} ${spa}.cc)
set(CARTOGRAPHER_EXT_ALL_SWAPS constraint_builder full_information)
cartographer_ext_swap_into(cartographer)" "constraint_builder: needs class sensor::PointCloud .*full_information: needs enum .*None of the swaps")

# A tree with trajectory states and the old PointCloud: what is possible is named.
write_stock("${WORK_DIR}/half_api")
file(COPY "${WORK_DIR}/old_api/cartographer" DESTINATION "${WORK_DIR}/half_api")
file(WRITE "${WORK_DIR}/half_api/cartographer/mapping/pose_graph_interface.h" "  enum class TrajectoryState { ACTIVE };\n")
expect_error(half_api "add_library(cartographer STATIC ${sources} ${spa}.cc)
set(CARTOGRAPHER_EXT_ALL_SWAPS constraint_builder full_information)
cartographer_ext_swap_into(cartographer)" "constraint_builder: needs class sensor::PointCloud .*Possible here: full_information")
