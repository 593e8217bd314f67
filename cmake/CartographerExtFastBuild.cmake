# SPDX-FileCopyrightText: 2026 The cartographer_ext authors
# SPDX-License-Identifier: Apache-2.0
#
# Precompiled headers and unity builds of our own targets. Most of the time of a plain build goes into reading the headers of
# Eigen, Abseil, Protobuf and GoogleTest again for each source. Only the build of this project uses them: what is compiled
# into a real Cartographer tree is compiled source by source.
#
# Unity builds compile several sources of a target as one. Which ones is decided while CMake runs: sources whose unnamed
# namespaces declare the same name are kept apart, and a source that defines a macro is compiled on its own. So nothing has
# to be listed by hand; where an edit makes two sources of a batch collide ("redefinition of"), running CMake again keeps
# them apart.

# On in the presets. Who edits with a compiler cache is better off without unity builds: then a source that did not change is
# not compiled again.
option(CARTOGRAPHER_EXT_PRECOMPILED_HEADERS "Precompile the headers of the libraries that most sources include" OFF)
option(CARTOGRAPHER_EXT_UNITY_BUILD "Compile several sources of a target as one" OFF)
set(CARTOGRAPHER_EXT_UNITY_BATCH_SIZE 8 CACHE STRING "Sources that a unity build compiles as one")

# Only headers of libraries and, for tests, generated ones: ours depend on the overlay.
set(CARTOGRAPHER_EXT_LIBRARY_HEADERS
    <algorithm> <array> <atomic> <chrono> <cmath> <cstdint> <cstdlib> <cstring> <deque> <fstream> <functional> <iomanip>
    <iostream> <iterator> <limits> <map> <memory> <mutex> <numeric> <random> <set> <sstream> <string> <thread> <tuple>
    <unordered_map> <unordered_set> <utility> <vector>
    <Eigen/Cholesky> <Eigen/Core> <Eigen/Eigenvalues> <Eigen/Geometry> <Eigen/LU>
    <absl/container/flat_hash_map.h> <absl/container/flat_hash_set.h> <absl/memory/memory.h> <absl/status/status.h>
    <absl/status/statusor.h> <absl/strings/numbers.h> <absl/strings/str_cat.h> <absl/strings/str_format.h>
    <absl/strings/str_join.h> <absl/strings/str_split.h> <absl/synchronization/mutex.h> <absl/time/time.h>
    <absl/types/optional.h> <absl/types/span.h> <absl/types/variant.h>
    <ceres/ceres.h> <glog/logging.h>
    <google/protobuf/generated_message_reflection.h> <google/protobuf/generated_message_util.h> <google/protobuf/map.h>
    <google/protobuf/message.h> <google/protobuf/repeated_field.h> <google/protobuf/unknown_field_set.h>)

# cartographer_ext_add_precompiled_headers(<target> [TESTS] [HEADERS headers...] [LINK libs...])
# The target whose precompiled headers others use: those above and `headers` of `libs`.
function(cartographer_ext_add_precompiled_headers target)
  cmake_parse_arguments(ARG "TESTS" "" "HEADERS;LINK" ${ARGN})
  if(NOT CARTOGRAPHER_EXT_PRECOMPILED_HEADERS)
    return()
  endif()
  set(source "${CMAKE_BINARY_DIR}/cartographer_ext_fast_build/${target}.cc")
  if(NOT EXISTS "${source}")
    file(WRITE "${source}" "// Generated: a target needs a source.\n")
  endif()
  add_library(${target} STATIC EXCLUDE_FROM_ALL "${source}")
  target_link_libraries(${target} PRIVATE Eigen3::Eigen Ceres::ceres absl::strings protobuf::libprotobuf PkgConfig::GLOG
                        ${ARG_LINK})
  target_precompile_headers(${target} PRIVATE ${CARTOGRAPHER_EXT_LIBRARY_HEADERS} ${ARG_HEADERS})
  if(ARG_TESTS)
    cartographer_ext_optimise_less(${target})
  endif()
endfunction()

# Tests spend their time in the libraries; -O3 in their own sources costs a quarter of their compilation and gains nothing.
# Their precompiled headers must have the same flag.
function(cartographer_ext_optimise_less target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# What keeps a source from being compiled together with others: the names that its unnamed namespaces declare at the start
# of a line, or ALONE for one that defines a macro or is not there yet.
function(cartographer_ext_unity_names source result)
  set(${result} ALONE PARENT_SCOPE)
  if(NOT EXISTS "${source}")
    return()
  endif()
  file(READ "${source}" text)
  if(text MATCHES "#define ")
    return()
  endif()
  string(REGEX REPLACE "[][;]" "{" text "${text}")
  set(names)
  # Names that using-declarations bring in: sources of one batch may differ in what they mean by them.
  string(REGEX MATCHALL "\nusing [A-Za-z0-9_:]+{" lines "${text}")
  foreach(line IN LISTS lines)
    string(REGEX REPLACE "\nusing (.*){" "\\1" declared "${line}")
    string(REGEX MATCH "[A-Za-z0-9_]+$" name "${declared}")
    list(APPEND names "using ${name}=${declared}")
  endforeach()
  # Functions of the enclosing namespace.
  string(REGEX MATCHALL "\n[A-Za-z_][^\n(={]*[ *&][A-Za-z0-9_]+\\(" lines "${text}")
  foreach(line IN LISTS lines)
    string(REGEX REPLACE ".*[ *&]([A-Za-z0-9_]+)\\($" "\\1" name "${line}")
    list(APPEND names "${name}")
  endforeach()
  string(FIND "${text}" "\nnamespace {\n" begin)
  while(NOT begin EQUAL -1)
    string(SUBSTRING "${text}" ${begin} -1 text)
    string(FIND "${text}" "\n}  // namespace\n" end)
    string(SUBSTRING "${text}" 0 ${end} unnamed)
    string(SUBSTRING "${text}" 1 -1 text)
    string(REGEX MATCHALL "\n[A-Za-z_][^\n]*" lines "${unnamed}")
    foreach(line IN LISTS lines)
      # Of GoogleTest's macros the names of suite and test count, not the macro's.
      if(line MATCHES "^\n(TEST|TEST_F|TEST_P|TYPED_TEST)\\(([A-Za-z0-9_]+), *([A-Za-z0-9_]+)")
        list(APPEND names "${CMAKE_MATCH_2}_${CMAKE_MATCH_3}_Test")
        continue()
      endif()
      if(line MATCHES "^\n(using ::|using std::|TEST|TYPED_TEST|INSTANTIATE_)")
        continue()
      endif()
      string(REGEX REPLACE "[ :]*[({=].*" "" declared "${line}")
      string(REGEX MATCH "[A-Za-z0-9_]+$" name "${declared}")
      string(REGEX MATCHALL "[A-Za-z0-9_]+ ?[({=]" more "${line}")
      list(TRANSFORM more REPLACE " ?[({=]" "")
      list(APPEND names ${name} ${more})
    endforeach()
    string(FIND "${text}" "\nnamespace {\n" begin)
  endwhile()
  list(REMOVE_ITEM names namespace void)
  list(REMOVE_DUPLICATES names)
  set(${result} "${names}" PARENT_SCOPE)
endfunction()

# Whether a source with `names` can join a batch that has `others`: it declares none of them again, and its
# using-declarations ("using <name>=<qualified name>") mean the same.
function(cartographer_ext_unity_names_agree names others result)
  set(${result} FALSE PARENT_SCOPE)
  foreach(name IN LISTS names)
    if(name MATCHES "^using ([^=]+)=")
      set(same "${others}")
      list(FILTER same INCLUDE REGEX "^using ${CMAKE_MATCH_1}=")
      list(REMOVE_ITEM same "${name}")
      if(same)
        return()
      endif()
    elseif(name IN_LIST others)
      return()
    endif()
  endforeach()
  set(${result} TRUE PARENT_SCOPE)
endfunction()

# Puts each source of the target into the first batch that has room and none of its names.
function(cartographer_ext_unity_batches target batch_size)
  get_target_property(sources ${target} SOURCES)
  get_target_property(source_dir ${target} SOURCE_DIR)
  list(FILTER sources INCLUDE REGEX "\\.cc$")
  list(FILTER sources EXCLUDE REGEX "\\.pb\\.cc$")
  set(last 0)
  set(names_0)
  set(size_0 0)
  foreach(source IN LISTS sources)
    get_filename_component(path "${source}" ABSOLUTE BASE_DIR "${source_dir}")
    cartographer_ext_unity_names("${path}" names)
    if(names STREQUAL "ALONE")
      continue()
    endif()
    set(chosen)
    foreach(batch RANGE ${last})
      cartographer_ext_unity_names_agree("${names}" "${names_${batch}}" agree)
      if(agree AND size_${batch} LESS batch_size)
        set(chosen ${batch})
        break()
      endif()
    endforeach()
    if(NOT DEFINED chosen)
      math(EXPR last "${last} + 1")
      set(chosen ${last})
      set(names_${last})
      set(size_${last} 0)
    endif()
    list(APPEND names_${chosen} ${names})
    math(EXPR size_${chosen} "${size_${chosen}} + 1")
    set_source_files_properties("${source}" TARGET_DIRECTORY ${target} PROPERTIES UNITY_GROUP batch_${chosen})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()

# The sources generated from protos, a dozen as one. Each has two names that others have, too.
function(cartographer_ext_unity_protos target)
  get_target_property(sources ${target} SOURCES)
  list(FILTER sources INCLUDE REGEX "\\.pb\\.cc$")
  set(batch 0)
  while(sources)
    list(SUBLIST sources 0 12 some)
    list(REMOVE_ITEM sources ${some})
    set(text "// Generated: sources generated from protos.\n#include \"google/protobuf/generated_message_reflection.h\"\n")
    foreach(source IN LISTS some)
      string(MAKE_C_IDENTIFIER "${source}" suffix)
      string(APPEND text "#define schemas schemas${suffix}\n"
             "#define file_default_instances file_default_instances${suffix}\n"
             "#include \"${source}\"\n#undef schemas\n#undef file_default_instances\n")
    endforeach()
    set(combined "${CMAKE_BINARY_DIR}/cartographer_ext_fast_build/${target}_protos_${batch}.cc")
    file(CONFIGURE OUTPUT "${combined}" CONTENT "${text}" @ONLY)
    target_sources(${target} PRIVATE "${combined}")
    set_source_files_properties(${some} TARGET_DIRECTORY ${target} PROPERTIES HEADER_FILE_ONLY ON)
    math(EXPR batch "${batch} + 1")
  endwhile()
endfunction()

# cartographer_ext_build_fast(<target> [TESTS] [NO_UNITY] [NO_PRECOMPILED_HEADERS] [BATCH_SIZE n])
# To be called when the target has all of its sources.
function(cartographer_ext_build_fast target)
  cmake_parse_arguments(ARG "TESTS;NO_UNITY;NO_PRECOMPILED_HEADERS" "BATCH_SIZE" "" ${ARGN})
  if(NOT DEFINED ARG_BATCH_SIZE)
    set(ARG_BATCH_SIZE ${CARTOGRAPHER_EXT_UNITY_BATCH_SIZE})
  endif()
  if(CARTOGRAPHER_EXT_UNITY_BUILD AND NOT ARG_NO_UNITY)
    cartographer_ext_unity_batches(${target} ${ARG_BATCH_SIZE})
    cartographer_ext_unity_protos(${target})
  endif()
  if(ARG_TESTS)
    cartographer_ext_optimise_less(${target})
  endif()
  if(NOT CARTOGRAPHER_EXT_PRECOMPILED_HEADERS OR ARG_NO_PRECOMPILED_HEADERS)
    return()
  endif()
  set(owner cartographer_ext_precompiled_headers)
  if(ARG_TESTS)
    set(owner cartographer_ext_precompiled_test_headers)
  endif()
  # Executables would be compiled with -fPIE, which does not go with headers compiled with -fPIC.
  get_target_property(type ${target} TYPE)
  if(type STREQUAL "EXECUTABLE")
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
    target_compile_options(${target} PRIVATE -fPIC)
  endif()
  target_compile_definitions(${target} PRIVATE $<TARGET_PROPERTY:${owner},COMPILE_DEFINITIONS>)
  target_precompile_headers(${target} REUSE_FROM ${owner})
endfunction()
