# SPDX-FileCopyrightText: 2026 The cartographer_ext authors
# SPDX-License-Identifier: Apache-2.0
#
# cartographer_ext_swap_into(<target> [SWAPS name...])
#
# Puts our classes in front of the stock ones of a Cartographer library target whose sources are not edited. For each swap
# the stock source is compiled with its class or function renamed (ConstraintBuilder2D -> StockConstraintBuilder2D), our
# overlay header stands first on the include path under the stock header's path, and our source under the original name is
# added to the target. Without our Lua block our class only forwards to the renamed stock one.
#
# Swaps (default: all of them):
#   optimization_problem   OptimizationProblem2D and its options
#
# Works on the bundled host and on a real tree, in two ways:
#   superproject   add_subdirectory(<tree>), then this function (CMake 3.16 or newer)
#   injection      configure the tree itself with -DCMAKE_PROJECT_cartographer_INCLUDE=<here>/inject.cmake (3.19 or newer)
#
# A stock file that is missing, listed twice, or does not declare what we front is an error at configure time; a changed
# signature is an error at compile time (static assertions in the drop-in sources).

include_guard(GLOBAL)

get_filename_component(CARTOGRAPHER_EXT_ROOT "${CMAKE_CURRENT_LIST_DIR}/.." ABSOLUTE)
set(CARTOGRAPHER_EXT_ALL_SWAPS optimization_problem)

# Modules whose sources need no host; they are compiled once as objects and become part of the target.
set(CARTOGRAPHER_EXT_CORE_MODULES common options optimization loop_closure scan_matching front_end)

# Renames of one swap, as "stock source|old name|declaring header".
function(cartographer_ext_swap_renames swap result)
  if(swap STREQUAL "optimization_problem")
    set(renames
        "mapping/internal/optimization/optimization_problem_2d.cc|OptimizationProblem2D|mapping/internal/optimization/optimization_problem_2d.h"
        "mapping/internal/optimization/optimization_problem_options.cc|CreateOptimizationProblemOptions|mapping/internal/optimization/optimization_problem_options.h")
  elseif(swap STREQUAL "constraint_builder")
    set(renames
        "mapping/internal/constraints/constraint_builder_2d.cc|ConstraintBuilder2D|mapping/internal/constraints/constraint_builder_2d.h"
        "mapping/internal/constraints/constraint_builder.cc|CreateConstraintBuilderOptions|mapping/internal/constraints/constraint_builder.h")
  elseif(swap STREQUAL "ceres_scan_matcher")
    set(renames
        "mapping/internal/2d/scan_matching/ceres_scan_matcher_2d.cc|CeresScanMatcher2D|mapping/internal/2d/scan_matching/ceres_scan_matcher_2d.h"
        "mapping/internal/2d/scan_matching/ceres_scan_matcher_2d.cc|CreateCeresScanMatcherOptions2D|mapping/internal/2d/scan_matching/ceres_scan_matcher_2d.h")
  elseif(swap STREQUAL "local_trajectory_builder")
    set(renames
        "mapping/internal/2d/local_trajectory_builder_2d.cc|LocalTrajectoryBuilder2D|mapping/internal/2d/local_trajectory_builder_2d.h"
        "mapping/internal/2d/local_trajectory_builder_options_2d.cc|CreateLocalTrajectoryBuilderOptions2D|mapping/internal/2d/local_trajectory_builder_options_2d.h")
  else()
    message(FATAL_ERROR "cartographer_ext: unknown swap '${swap}', there are: ${CARTOGRAPHER_EXT_ALL_SWAPS}")
  endif()
  set(${result} "${renames}" PARENT_SCOPE)
endfunction()

# The protos of cartographer_ext as objects, with the include directory of their headers.
function(cartographer_ext_add_proto_objects)
  if(TARGET cartographer_ext_proto_objects)
    return()
  endif()
  find_package(Protobuf REQUIRED)
  set(generated "${CMAKE_BINARY_DIR}/cartographer_ext_proto")
  file(GLOB protos CONFIGURE_DEPENDS "${CARTOGRAPHER_EXT_ROOT}/proto/cartographer_ext/*.proto")
  file(MAKE_DIRECTORY "${generated}/cartographer_ext")
  set(sources)
  foreach(proto IN LISTS protos)
    get_filename_component(stem "${proto}" NAME_WE)
    set(outputs "${generated}/cartographer_ext/${stem}.pb.cc" "${generated}/cartographer_ext/${stem}.pb.h")
    add_custom_command(
      OUTPUT ${outputs}
      COMMAND ${PROTOBUF_PROTOC_EXECUTABLE} --cpp_out "${generated}" -I "${CARTOGRAPHER_EXT_ROOT}/proto"
              -I "${PROTOBUF_INCLUDE_DIR}" "${proto}"
      DEPENDS ${protos}
      COMMENT "Generating cartographer_ext/${stem}.pb.h"
      VERBATIM)
    list(APPEND sources ${outputs})
  endforeach()
  add_library(cartographer_ext_proto_objects OBJECT ${sources})
  set_target_properties(cartographer_ext_proto_objects PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_include_directories(cartographer_ext_proto_objects SYSTEM PUBLIC "${generated}" ${PROTOBUF_INCLUDE_DIRS})
endfunction()

# CAMD, the fill-reducing order of the incremental solver (BSD licence; see third_party_notes/suitesparse.md).
function(cartographer_ext_find_camd)
  find_path(CARTOGRAPHER_EXT_CAMD_INCLUDE_DIR camd.h PATH_SUFFIXES suitesparse)
  find_library(CARTOGRAPHER_EXT_CAMD_LIBRARY camd)
  find_library(CARTOGRAPHER_EXT_SUITESPARSECONFIG_LIBRARY suitesparseconfig)
  if(NOT CARTOGRAPHER_EXT_CAMD_INCLUDE_DIR OR NOT CARTOGRAPHER_EXT_CAMD_LIBRARY
     OR NOT CARTOGRAPHER_EXT_SUITESPARSECONFIG_LIBRARY)
    message(FATAL_ERROR "cartographer_ext: CAMD of SuiteSparse not found (Debian: libsuitesparse-dev)")
  endif()
endfunction()

# One module's host-free sources as objects: cartographer_ext_<module>_objects.
function(cartographer_ext_add_core_objects module)
  if(TARGET cartographer_ext_${module}_objects)
    return()
  endif()
  file(GLOB sources CONFIGURE_DEPENDS "${CARTOGRAPHER_EXT_ROOT}/cartographer_ext/${module}/*.cc")
  if(NOT sources)
    return()
  endif()
  cartographer_ext_add_proto_objects()
  find_package(Eigen3 REQUIRED)
  find_package(Ceres REQUIRED)
  find_package(absl REQUIRED)
  add_library(cartographer_ext_${module}_objects OBJECT ${sources})
  set_target_properties(cartographer_ext_${module}_objects PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_include_directories(cartographer_ext_${module}_objects PUBLIC "${CARTOGRAPHER_EXT_ROOT}")
  target_link_libraries(cartographer_ext_${module}_objects PUBLIC
    Eigen3::Eigen Ceres::ceres absl::strings absl::status absl::statusor absl::optional absl::variant absl::time
    absl::synchronization absl::span)
  target_include_directories(cartographer_ext_${module}_objects SYSTEM PUBLIC
    $<TARGET_PROPERTY:cartographer_ext_proto_objects,INTERFACE_INCLUDE_DIRECTORIES>)
  add_dependencies(cartographer_ext_${module}_objects cartographer_ext_proto_objects)
  if(module STREQUAL "optimization")
    cartographer_ext_find_camd()
    target_include_directories(cartographer_ext_${module}_objects SYSTEM PRIVATE "${CARTOGRAPHER_EXT_CAMD_INCLUDE_DIR}")
  endif()
  if(COMMAND cartographer_ext_warnings)
    cartographer_ext_warnings(cartographer_ext_${module}_objects)
  endif()
endfunction()

# Gives the one source of `target` that ends in cartographer/<suffix>.
function(cartographer_ext_find_stock_source target suffix result)
  get_target_property(sources ${target} SOURCES)
  get_target_property(source_dir ${target} SOURCE_DIR)
  set(found)
  foreach(source IN LISTS sources)
    if(source MATCHES "cartographer/([^|]*)$" AND source MATCHES "/cartographer/${suffix}$"
       AND NOT source MATCHES "/cartographer_ext/overlay/")
      if(NOT IS_ABSOLUTE "${source}")
        set(source "${source_dir}/${source}")
      endif()
      list(APPEND found "${source}")
    endif()
  endforeach()
  list(LENGTH found count)
  if(NOT count EQUAL 1)
    message(FATAL_ERROR "cartographer_ext: target ${target} should have exactly one source cartographer/${suffix}, "
                        "found ${count}: ${found}. This is not a Cartographer tree that we know; leave the swap out "
                        "with SWAPS, or report the version.")
  endif()
  set(${result} "${found}" PARENT_SCOPE)
endfunction()

function(cartographer_ext_swap_into target)
  cmake_policy(PUSH)
  cmake_policy(VERSION 3.16)
  cmake_parse_arguments(ARG "" "" "SWAPS" ${ARGN})
  if(ARG_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "cartographer_ext_swap_into: unknown arguments: ${ARG_UNPARSED_ARGUMENTS}")
  endif()
  if(NOT DEFINED ARG_SWAPS)
    set(ARG_SWAPS ${CARTOGRAPHER_EXT_ALL_SWAPS})
  endif()
  if(NOT TARGET ${target})
    message(FATAL_ERROR "cartographer_ext_swap_into: there is no target '${target}'")
  endif()
  get_target_property(already ${target} CARTOGRAPHER_EXT_SWAPPED)
  if(already)
    message(FATAL_ERROR "cartographer_ext_swap_into: ${target} is swapped already")
  endif()
  set_target_properties(${target} PROPERTIES CARTOGRAPHER_EXT_SWAPPED TRUE)
  if(NOT CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
    message(FATAL_ERROR "cartographer_ext: the overlay headers need #include_next (GCC or Clang)")
  endif()

  set(definitions_of)
  foreach(swap IN LISTS ARG_SWAPS)
    cartographer_ext_swap_renames(${swap} renames)
    foreach(rename IN LISTS renames)
      string(REPLACE "|" ";" parts "${rename}")
      list(GET parts 0 suffix)
      list(GET parts 1 name)
      list(GET parts 2 header)
      cartographer_ext_find_stock_source(${target} "${suffix}" source)
      string(REGEX REPLACE "/cartographer/${suffix}$" "" root "${source}")
      if(NOT EXISTS "${root}/cartographer/${header}")
        message(FATAL_ERROR "cartographer_ext: ${root}/cartographer/${header} is missing")
      endif()
      file(READ "${root}/cartographer/${header}" text)
      string(REGEX MATCHALL "(class ${name}[ \n]|[ :]${name}\\()" declarations "${text}")
      if(NOT declarations)
        message(FATAL_ERROR "cartographer_ext: ${root}/cartographer/${header} does not declare ${name}; this version of "
                            "Cartographer has another API, leave the swap '${swap}' out with SWAPS")
      endif()
      string(MAKE_C_IDENTIFIER "${suffix}" key)
      list(APPEND renamed_sources "${source}")
      set(definitions_${key} ${definitions_${key}} "${name}=Stock${name}")
      set_source_files_properties("${source}" TARGET_DIRECTORY ${target} PROPERTIES
        COMPILE_DEFINITIONS "CARTOGRAPHER_EXT_COMPILING_STOCK;${definitions_${key}}")
    endforeach()
    file(GLOB dropin CONFIGURE_DEPENDS
         "${CARTOGRAPHER_EXT_ROOT}/cartographer_ext/overlay/dropin/${swap}/*.cc")
    target_sources(${target} PRIVATE ${dropin})
    target_compile_definitions(${target} PUBLIC
      $<BUILD_INTERFACE:CARTOGRAPHER_EXT_SWAP_$<UPPER_CASE:${swap}>=1>)
  endforeach()

  # Sources that talk to the host API, of the modules themselves.
  foreach(module IN LISTS CARTOGRAPHER_EXT_CORE_MODULES)
    file(GLOB dropin CONFIGURE_DEPENDS "${CARTOGRAPHER_EXT_ROOT}/cartographer_ext/${module}/dropin/*.cc")
    target_sources(${target} PRIVATE ${dropin})
    cartographer_ext_add_core_objects(${module})
    if(TARGET cartographer_ext_${module}_objects)
      target_sources(${target} PRIVATE $<TARGET_OBJECTS:cartographer_ext_${module}_objects>)
      add_dependencies(${target} cartographer_ext_${module}_objects)
    endif()
  endforeach()
  target_link_libraries(${target} PUBLIC
    ${CARTOGRAPHER_EXT_CAMD_LIBRARY} ${CARTOGRAPHER_EXT_SUITESPARSECONFIG_LIBRARY})
  cartographer_ext_add_proto_objects()
  target_sources(${target} PRIVATE $<TARGET_OBJECTS:cartographer_ext_proto_objects>)
  add_dependencies(${target} cartographer_ext_proto_objects)

  # Ours first, and never as a system directory: those are searched after all others.
  target_include_directories(${target} BEFORE PUBLIC
    $<BUILD_INTERFACE:${CARTOGRAPHER_EXT_ROOT}/cartographer_ext/overlay>)
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${CARTOGRAPHER_EXT_ROOT}>
    $<BUILD_INTERFACE:${CMAKE_BINARY_DIR}/cartographer_ext_proto>)
  message(STATUS "cartographer_ext: swapped into ${target}: ${ARG_SWAPS}")
  cmake_policy(POP)
endfunction()
