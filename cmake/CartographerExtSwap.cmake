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
# Swaps (default: those in CARTOGRAPHER_EXT_ALL_SWAPS):
#   constraint_builder        ConstraintBuilder2D and its options
#   ceres_scan_matcher        CeresScanMatcher2D and its options
#   optimization_problem      OptimizationProblem2D and its options
#   local_trajectory_builder  LocalTrajectoryBuilder2D and its options; CollatedTrajectoryBuilder, for readings that come twice
#   full_information          the SPA residual, for loops with a full information matrix (no block of its own; the matrix
#                             comes from constraint_builder by way of optimization_problem, without which it has no effect)
#
# Works on the bundled host and on a real tree, in two ways:
#   superproject   add_subdirectory(<tree>), then this function (CMake 3.16 or newer)
#   injection      configure the tree itself with -DCMAKE_PROJECT_cartographer_INCLUDE=<here>/inject.cmake (3.19 or newer)
#
# A stock file that is missing, listed twice, or does not declare what we front is an error at configure time; a changed
# signature is an error at compile time (static assertions in the drop-in sources).

include_guard(GLOBAL)
# Injected into a project that asks for the policies of CMake 3.2; functions keep those of the place that defines them.
cmake_policy(VERSION 3.16)

get_filename_component(CARTOGRAPHER_EXT_ROOT "${CMAKE_CURRENT_LIST_DIR}/.." ABSOLUTE)
include("${CMAKE_CURRENT_LIST_DIR}/CartographerExtApi.cmake")
include("${CMAKE_CURRENT_LIST_DIR}/CartographerExtTry.cmake")
set(CARTOGRAPHER_EXT_ALL_SWAPS constraint_builder ceres_scan_matcher optimization_problem local_trajectory_builder
    full_information)

# Modules whose sources need no host; they are compiled once, with those of their subfolders but dropin/ (which need it) and
# offline/ (which only the workbench uses), as objects and become part of the target.
set(CARTOGRAPHER_EXT_CORE_MODULES common options uncertainty optimization loop_closure scan_matching front_end)

# The modules whose dropin/ folders hold the class behind a swap and what it uses; full_information needs none.
set(CARTOGRAPHER_EXT_MODULES_OF_constraint_builder loop_closure scan_matching)
set(CARTOGRAPHER_EXT_MODULES_OF_ceres_scan_matcher scan_matching)
set(CARTOGRAPHER_EXT_MODULES_OF_optimization_problem optimization)
set(CARTOGRAPHER_EXT_MODULES_OF_local_trajectory_builder front_end scan_matching)

# What a swap renames, as "stock source|name|declaring header", below cartographer/mapping/internal/.
function(cartographer_ext_swap_renames swap result)
  if(swap STREQUAL "constraint_builder")
    set(renames
        "constraints/constraint_builder_2d.cc|ConstraintBuilder2D|constraints/constraint_builder_2d.h"
        "constraints/constraint_builder.cc|CreateConstraintBuilderOptions|constraints/constraint_builder.h")
  elseif(swap STREQUAL "ceres_scan_matcher")
    set(renames
        "2d/scan_matching/ceres_scan_matcher_2d.cc|CeresScanMatcher2D|2d/scan_matching/ceres_scan_matcher_2d.h"
        "2d/scan_matching/ceres_scan_matcher_2d.cc|CreateCeresScanMatcherOptions2D|2d/scan_matching/ceres_scan_matcher_2d.h")
  elseif(swap STREQUAL "optimization_problem")
    set(renames
        "optimization/optimization_problem_2d.cc|OptimizationProblem2D|optimization/optimization_problem_2d.h"
        "optimization/optimization_problem_options.cc|CreateOptimizationProblemOptions|optimization/optimization_problem_options.h")
  elseif(swap STREQUAL "local_trajectory_builder")
    set(renames
        "2d/local_trajectory_builder_2d.cc|LocalTrajectoryBuilder2D|2d/local_trajectory_builder_2d.h"
        "2d/local_trajectory_builder_options_2d.cc|CreateLocalTrajectoryBuilderOptions2D|2d/local_trajectory_builder_options_2d.h"
        "collated_trajectory_builder.cc|CollatedTrajectoryBuilder|collated_trajectory_builder.h")
  elseif(swap STREQUAL "full_information")
    set(spa "optimization/cost_functions/spa_cost_function_2d")
    set(renames "${spa}.cc|CreateAutoDiffSpaCostFunction|${spa}.h" "${spa}.cc|CreateAnalyticalSpaCostFunction|${spa}.h")
  endif()
  if(NOT swap IN_LIST CARTOGRAPHER_EXT_ALL_SWAPS)
    message(FATAL_ERROR "cartographer_ext: there is no swap '${swap}', there are: ${CARTOGRAPHER_EXT_ALL_SWAPS}")
  endif()
  set(${result} "${renames}" PARENT_SCOPE)
endfunction()

# The protos of cartographer_ext as objects, with the include directory of their headers.
function(cartographer_ext_add_proto_objects)
  if(TARGET cartographer_ext_proto_objects)
    return()
  endif()
  find_package(Protobuf REQUIRED)
  set(protoc "${PROTOBUF_PROTOC_EXECUTABLE}")
  if(TARGET protobuf::protoc)
    set(protoc protobuf::protoc)
  endif()
  set(proto_path -I "${CARTOGRAPHER_EXT_ROOT}/proto")
  if(PROTOBUF_INCLUDE_DIR)
    list(APPEND proto_path -I "${PROTOBUF_INCLUDE_DIR}")
  endif()
  set(generated "${CMAKE_BINARY_DIR}/cartographer_ext_proto")
  file(GLOB protos CONFIGURE_DEPENDS "${CARTOGRAPHER_EXT_ROOT}/proto/cartographer_ext/*.proto")
  file(MAKE_DIRECTORY "${generated}/cartographer_ext")
  set(sources)
  foreach(proto IN LISTS protos)
    get_filename_component(stem "${proto}" NAME_WE)
    set(outputs "${generated}/cartographer_ext/${stem}.pb.cc" "${generated}/cartographer_ext/${stem}.pb.h")
    add_custom_command(
      OUTPUT ${outputs}
      COMMAND ${protoc} --cpp_out "${generated}" ${proto_path} "${proto}"
      DEPENDS ${protos}
      COMMENT "Generating cartographer_ext/${stem}.pb.h"
      VERBATIM)
    list(APPEND sources ${outputs})
  endforeach()
  add_library(cartographer_ext_proto_objects OBJECT ${sources})
  set_target_properties(cartographer_ext_proto_objects PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_include_directories(cartographer_ext_proto_objects SYSTEM PUBLIC "${generated}" ${PROTOBUF_INCLUDE_DIRS})
  if(COMMAND cartographer_ext_build_fast AND NOT CARTOGRAPHER_SOURCE_DIR)
    cartographer_ext_build_fast(cartographer_ext_proto_objects)
  endif()
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
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS "${CARTOGRAPHER_EXT_ROOT}/cartographer_ext/${module}/*.cc")
  list(FILTER sources EXCLUDE REGEX "/(dropin|offline)/")
  if(NOT sources)
    return()
  endif()
  cartographer_ext_add_proto_objects()
  foreach(package_target Eigen3|Eigen3::Eigen Ceres|Ceres::ceres absl|absl::statusor)
    string(REPLACE "|" ";" package_target "${package_target}")
    list(GET package_target 0 package)
    list(GET package_target 1 imported)
    if(NOT TARGET ${imported})
      find_package(${package} REQUIRED)
    endif()
  endforeach()
  add_library(cartographer_ext_${module}_objects OBJECT ${sources})
  set_target_properties(cartographer_ext_${module}_objects PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_include_directories(cartographer_ext_${module}_objects PUBLIC "${CARTOGRAPHER_EXT_ROOT}")
  target_link_libraries(cartographer_ext_${module}_objects PUBLIC
    Eigen3::Eigen Ceres::ceres absl::strings absl::status absl::statusor absl::optional absl::variant absl::time
    absl::synchronization absl::span)
  target_include_directories(cartographer_ext_${module}_objects SYSTEM PUBLIC
    $<TARGET_PROPERTY:cartographer_ext_proto_objects,INTERFACE_INCLUDE_DIRECTORIES>)
  add_dependencies(cartographer_ext_${module}_objects cartographer_ext_proto_objects)
  if(module STREQUAL "front_end")
    find_path(CARTOGRAPHER_EXT_NANOFLANN_INCLUDE_DIR nanoflann.hpp)
    if(NOT CARTOGRAPHER_EXT_NANOFLANN_INCLUDE_DIR)
      message(FATAL_ERROR "cartographer_ext: nanoflann not found (Debian: libnanoflann-dev)")
    endif()
    target_include_directories(cartographer_ext_front_end_objects SYSTEM PRIVATE
                               "${CARTOGRAPHER_EXT_NANOFLANN_INCLUDE_DIR}")
  endif()
  if(module STREQUAL "optimization")
    cartographer_ext_find_camd()
    target_include_directories(cartographer_ext_${module}_objects SYSTEM PRIVATE "${CARTOGRAPHER_EXT_CAMD_INCLUDE_DIR}")
  endif()
  if(COMMAND cartographer_ext_warnings)
    cartographer_ext_warnings(cartographer_ext_${module}_objects)
  endif()
  if(COMMAND cartographer_ext_build_fast AND NOT CARTOGRAPHER_SOURCE_DIR)
    cartographer_ext_build_fast(cartographer_ext_${module}_objects)
  endif()
endfunction()

# Gives the one source of `target` that is cartographer/mapping/internal/<suffix>, with an absolute path, and the form in
# which the target lists it.
function(cartographer_ext_find_stock_source target suffix result listed_result)
  get_target_property(sources ${target} SOURCES)
  get_target_property(source_dir ${target} SOURCE_DIR)
  set(found)
  set(listed)
  foreach(source IN LISTS sources)
    get_filename_component(absolute "${source}" ABSOLUTE BASE_DIR "${source_dir}")
    string(FIND "${absolute}" "/cartographer/mapping/internal/${suffix}" position REVERSE)
    if(position EQUAL -1)
      continue()
    endif()
    string(SUBSTRING "${absolute}" ${position} -1 rest)
    if(rest STREQUAL "/cartographer/mapping/internal/${suffix}")
      list(APPEND found "${absolute}")
      list(APPEND listed "${source}")
    endif()
  endforeach()
  list(LENGTH found count)
  if(NOT count EQUAL 1)
    message(FATAL_ERROR "cartographer_ext: target ${target} should have exactly one source "
                        "cartographer/mapping/internal/${suffix}, found ${count}: ${found}. This is not a Cartographer "
                        "tree that we know; leave the swap out with SWAPS, or report the version.")
  endif()
  set(${result} "${found}" PARENT_SCOPE)
  set(${listed_result} "${listed}" PARENT_SCOPE)
endfunction()

# The folder that holds the cartographer/ of the sources of `target`, by the first stock source of the first swap.
function(cartographer_ext_tree_of target swaps result)
  list(GET swaps 0 swap)
  cartographer_ext_swap_renames(${swap} renames)
  list(GET renames 0 rename)
  string(REGEX REPLACE "\\|.*" "" suffix "${rename}")
  cartographer_ext_find_stock_source(${target} "${suffix}" source listed)
  string(REGEX REPLACE "/cartographer/mapping/internal/${suffix}$" "" root "${source}")
  set(${result} "${root}" PARENT_SCOPE)
endfunction()

# Fails unless the header beside the stock source declares what we front.
function(cartographer_ext_check_declaration swap source suffix name header)
  string(REGEX REPLACE "/cartographer/mapping/internal/${suffix}$" "" root "${source}")
  set(path "${root}/cartographer/mapping/internal/${header}")
  if(NOT EXISTS "${path}")
    message(FATAL_ERROR "cartographer_ext: ${path} is missing; leave the swap '${swap}' out with SWAPS")
  endif()
  file(READ "${path}" text)
  string(REGEX MATCHALL "(class ${name}[ \n]|[ :\n]${name}\\()" declarations "${text}")
  if(NOT declarations)
    message(FATAL_ERROR "cartographer_ext: ${path} does not declare ${name}; this version of Cartographer has another "
                        "API, leave the swap '${swap}' out with SWAPS")
  endif()
endfunction()

# Replaces the stock sources of one swap by generated ones that include them with their names out of the way, and adds ours.
# (A generated source works from any directory and CMake version; source properties need 3.18 for that.)
function(cartographer_ext_apply_swap target swap)
  cartographer_ext_swap_renames(${swap} renames)
  set(suffixes)
  foreach(rename IN LISTS renames)
    string(REPLACE "|" ";" parts "${rename}")
    list(GET parts 0 suffix)
    list(GET parts 1 name)
    list(GET parts 2 header)
    string(MAKE_C_IDENTIFIER "${suffix}" key)
    if(NOT DEFINED source_${key})
      cartographer_ext_find_stock_source(${target} "${suffix}" source_${key} listed_${key})
      list(APPEND suffixes "${suffix}")
    endif()
    cartographer_ext_check_declaration(${swap} "${source_${key}}" "${suffix}" ${name} "${header}")
    string(APPEND defines_${key} "#define ${name} Stock${name}\n")
  endforeach()
  get_target_property(sources ${target} SOURCES)
  foreach(suffix IN LISTS suffixes)
    string(MAKE_C_IDENTIFIER "${suffix}" key)
    get_filename_component(file_name "${suffix}" NAME)
    set(STOCK_DEFINES "${defines_${key}}")
    set(STOCK_SOURCE "${source_${key}}")
    set(generated "${CMAKE_BINARY_DIR}/cartographer_ext_stock/${target}/stock_${file_name}")
    configure_file("${CARTOGRAPHER_EXT_ROOT}/cmake/stock_source.cc.in" "${generated}" @ONLY)
    list(REMOVE_ITEM sources "${listed_${key}}")
    list(APPEND sources "${generated}")
  endforeach()
  set(dropin_globs "${CARTOGRAPHER_EXT_ROOT}/cartographer_ext/overlay/dropin/${swap}/*.cc")
  foreach(module IN LISTS CARTOGRAPHER_EXT_MODULES_OF_${swap})
    list(APPEND dropin_globs "${CARTOGRAPHER_EXT_ROOT}/cartographer_ext/${module}/dropin/*.cc")
  endforeach()
  file(GLOB dropin CONFIGURE_DEPENDS ${dropin_globs})
  # Two swaps may share a module.
  list(APPEND sources ${dropin})
  list(REMOVE_DUPLICATES sources)
  set_target_properties(${target} PROPERTIES SOURCES "${sources}")
endfunction()

function(cartographer_ext_version result)
  file(STRINGS "${CARTOGRAPHER_EXT_ROOT}/CMakeLists.txt" project_line REGEX "^project\\(cartographer_ext VERSION ")
  string(REGEX REPLACE ".* VERSION ([0-9.]+).*" "\\1" version "${project_line}")
  set(${result} "${version}" PARENT_SCOPE)
endfunction()

# Tells sources which swaps are selected, in a header: as definitions on the command line they would compile all of the
# target, and all that links it, again whenever the selection changes.
function(cartographer_ext_write_swaps_header target swaps)
  cartographer_ext_version(CARTOGRAPHER_EXT_SWAPPED_VERSION)
  set(SWAP_DEFINES)
  foreach(swap IN LISTS swaps)
    string(TOUPPER "${swap}" upper)
    string(APPEND SWAP_DEFINES "#define CARTOGRAPHER_EXT_SWAP_${upper} 1\n")
  endforeach()
  set(generated "${CMAKE_BINARY_DIR}/cartographer_ext_stock/${target}/include")
  configure_file("${CARTOGRAPHER_EXT_ROOT}/cmake/swaps.h.in" "${generated}/cartographer_ext/swaps.h" @ONLY)
  target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${generated}>)
endfunction()

# Lua files that a robot's own file includes. Installed beside Cartographer's, so that one configuration directory has both; the
# runnable configurations and the stock files of this project stay behind, because Cartographer has its own.
function(cartographer_ext_install_lua_files)
  set(files)
  foreach(pattern cartographer_ext front_end_ loop_closure_)
    file(GLOB found CONFIGURE_DEPENDS "${CARTOGRAPHER_EXT_ROOT}/configuration_files/${pattern}*.lua")
    list(APPEND files ${found})
  endforeach()
  install(FILES ${files} DESTINATION share/cartographer/configuration_files)
endfunction()

# Headers of the cores that need no Cartographer, and find_package(cartographer_ext) for programs that use them. Not in our own
# build, which installs the same as a component of its own.
function(cartographer_ext_install_cores_of_swap)
  if(CMAKE_PROJECT_NAME STREQUAL "cartographer_ext")
    return()
  endif()
  foreach(module IN LISTS CARTOGRAPHER_EXT_CORE_MODULES)
    install(DIRECTORY "${CARTOGRAPHER_EXT_ROOT}/cartographer_ext/${module}" DESTINATION include/cartographer_ext
            FILES_MATCHING PATTERN "*.h" PATTERN dropin EXCLUDE PATTERN offline EXCLUDE)
  endforeach()
  install(DIRECTORY "${CMAKE_BINARY_DIR}/cartographer_ext_proto/cartographer_ext" DESTINATION include FILES_MATCHING PATTERN "*.h")
  set(generated "${CMAKE_BINARY_DIR}/cartographer_ext_stock")
  configure_file("${CARTOGRAPHER_EXT_ROOT}/cmake/cartographer_extInCartographerConfig.cmake.in"
                 "${generated}/cartographer_extConfig.cmake" COPYONLY)
  include(CMakePackageConfigHelpers)
  cartographer_ext_version(version)
  write_basic_package_version_file("${generated}/cartographer_extConfigVersion.cmake" VERSION ${version} COMPATIBILITY SameMinorVersion)
  install(FILES "${generated}/cartographer_extConfig.cmake" "${generated}/cartographer_extConfigVersion.cmake"
          DESTINATION lib/cmake/cartographer_ext)
endfunction()

# Takes the tests of the project that calls this out of the target `all` and marks them as disabled in CTest: three of
# Cartographer's own do not compile with GCC 12, and none of them is needed for an installation.
function(cartographer_ext_exclude_tests)
  get_property(targets DIRECTORY PROPERTY BUILDSYSTEM_TARGETS)
  get_property(tests DIRECTORY PROPERTY TESTS)
  foreach(test IN LISTS tests)
    if(test IN_LIST targets)
      set_target_properties(${test} PROPERTIES EXCLUDE_FROM_ALL TRUE)
      set_tests_properties(${test} PROPERTIES DISABLED TRUE)
    endif()
  endforeach()
  list(LENGTH tests count)
  message(STATUS "cartographer_ext: ${count} tests of ${PROJECT_NAME} are not built with `all` "
                 "(-DCARTOGRAPHER_EXT_UPSTREAM_TESTS=ON builds them)")
endfunction()

function(cartographer_ext_swap_into target)
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
  if(CMAKE_VERSION VERSION_LESS 3.16)
    message(FATAL_ERROR "cartographer_ext: CMake 3.16 or newer is needed, this is ${CMAKE_VERSION}")
  endif()
  if(NOT CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
    message(FATAL_ERROR "cartographer_ext: the overlay headers need #include_next (GCC or Clang)")
  endif()
  cartographer_ext_tree_of(${target} "${ARG_SWAPS}" tree)
  if("full_information" IN_LIST ARG_SWAPS AND NOT "optimization_problem" IN_LIST ARG_SWAPS)
    message(STATUS "cartographer_ext: the swap 'full_information' has no effect without the swap 'optimization_problem'")
  endif()
  foreach(swap IN LISTS ARG_SWAPS)
    cartographer_ext_apply_swap(${target} ${swap})
  endforeach()
  cartographer_ext_check_api("${tree}" "${ARG_SWAPS}")
  cartographer_ext_write_swaps_header(${target} "${ARG_SWAPS}")

  # The modules as objects; a library of its own would have to be installed and exported with Cartographer's.
  file(GLOB dropin CONFIGURE_DEPENDS "${CARTOGRAPHER_EXT_ROOT}/cartographer_ext/options/dropin/*.cc")
  target_sources(${target} PRIVATE ${dropin})
  foreach(module IN LISTS CARTOGRAPHER_EXT_CORE_MODULES)
    cartographer_ext_add_core_objects(${module})
    if(TARGET cartographer_ext_${module}_objects)
      target_sources(${target} PRIVATE $<TARGET_OBJECTS:cartographer_ext_${module}_objects>)
      add_dependencies(${target} cartographer_ext_${module}_objects)
    endif()
  endforeach()
  cartographer_ext_add_proto_objects()
  target_sources(${target} PRIVATE $<TARGET_OBJECTS:cartographer_ext_proto_objects>)
  add_dependencies(${target} cartographer_ext_proto_objects)
  target_link_libraries(${target} PUBLIC absl::optional absl::span absl::status absl::statusor absl::variant
    ${CARTOGRAPHER_EXT_CAMD_LIBRARY} ${CARTOGRAPHER_EXT_SUITESPARSECONFIG_LIBRARY})

  # Ours first, and never as a system directory: those are searched after all others.
  target_include_directories(${target} BEFORE PUBLIC
    $<BUILD_INTERFACE:${CARTOGRAPHER_EXT_ROOT}/cartographer_ext/overlay>)
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${CARTOGRAPHER_EXT_ROOT}>
    $<BUILD_INTERFACE:${CMAKE_BINARY_DIR}/cartographer_ext_proto>)
  cartographer_ext_install_lua_files()
  cartographer_ext_install_cores_of_swap()
  cartographer_ext_try_swaps(${target} "${tree}" "${ARG_SWAPS}")
  if(NOT tree STREQUAL "${CARTOGRAPHER_EXT_ROOT}/cartographer_ext/host")
    cartographer_ext_name_tree("${tree}" tree_name)
    message(STATUS "cartographer_ext: ${tree} is ${tree_name}")
  endif()
  message(STATUS "cartographer_ext: swapped into ${target}: ${ARG_SWAPS}")
endfunction()
