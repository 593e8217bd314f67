# SPDX-FileCopyrightText: 2026 The cartographer_ext authors
# SPDX-License-Identifier: Apache-2.0
#
# Injection: configure an unedited Cartographer tree with
#   cmake -DCMAKE_PROJECT_cartographer_INCLUDE=<this file> <tree>
# and its library is built with our classes in front. CMake reads this file in the project named cartographer only, so the
# variable may be given to a whole workspace. CARTOGRAPHER_EXT_SWAPS selects single swaps (default: all);
# CARTOGRAPHER_EXT_UPSTREAM_TESTS=ON builds Cartographer's own tests, too (default: they are not part of `all`).
if(CMAKE_VERSION VERSION_LESS 3.19)
  message(FATAL_ERROR "cartographer_ext: injection needs CMake 3.19 or newer; older ones: add_subdirectory and "
                      "cartographer_ext_swap_into, see the documentation")
endif()
include("${CMAKE_CURRENT_LIST_DIR}/CartographerExtSwap.cmake")
set(cartographer_ext_arguments cartographer)
if(CARTOGRAPHER_EXT_SWAPS)
  list(APPEND cartographer_ext_arguments SWAPS ${CARTOGRAPHER_EXT_SWAPS})
endif()
cmake_language(DEFER CALL cartographer_ext_swap_into ${cartographer_ext_arguments})
option(CARTOGRAPHER_EXT_UPSTREAM_TESTS "Build the tests of the Cartographer tree" OFF)
if(NOT CARTOGRAPHER_EXT_UPSTREAM_TESTS)
  cmake_language(DEFER CALL cartographer_ext_exclude_tests)
endif()
