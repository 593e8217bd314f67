# SPDX-FileCopyrightText: 2026 The cartographer_ext authors
# SPDX-License-Identifier: Apache-2.0
#
# Helpers shared by the CMake files of the project.

# Sanitizers for every target, so that libraries and tests agree.
function(cartographer_ext_sanitize_all)
  if(CARTOGRAPHER_EXT_SANITIZE)
    add_compile_options(-fsanitize=${CARTOGRAPHER_EXT_SANITIZE} -fno-omit-frame-pointer
                        -fno-sanitize-recover=all)
    add_link_options(-fsanitize=${CARTOGRAPHER_EXT_SANITIZE})
    if(CARTOGRAPHER_EXT_SANITIZE MATCHES "thread")
      # The sanitizer cannot see through the synchronization of the uninstrumented Abseil; this tells it what it does.
      add_library(cartographer_ext_uninstrumented_libraries OBJECT tests/thread_sanitizer/uninstrumented_libraries.cc)
      link_libraries($<TARGET_OBJECTS:cartographer_ext_uninstrumented_libraries>)
      foreach(symbol _ZN4absl7debian35Mutex4LockEv _ZN4absl7debian35Mutex6UnlockEv
              _ZN4absl7debian35Mutex5AwaitERKNS0_9ConditionE _ZN4absl7debian35Mutex8LockWhenERKNS0_9ConditionE
              _ZN4absl7debian35Mutex16AwaitWithTimeoutERKNS0_9ConditionENS0_8DurationE
              _ZN4absl7debian312Notification6NotifyEv
              _ZNK4absl7debian312Notification19WaitForNotificationEv
              _ZNK4absl7debian312Notification30WaitForNotificationWithTimeoutENS0_8DurationE
              _ZN4absl7debian315BlockingCounter14DecrementCountEv _ZN4absl7debian315BlockingCounter4WaitEv)
        add_link_options(-Wl,--wrap=${symbol})
      endforeach()
    endif()
  endif()
endfunction()

# Our warnings on one of our targets.
function(cartographer_ext_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wno-unused-parameter -Wno-sign-compare
                         $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  if(CARTOGRAPHER_EXT_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()

# A real Cartographer tree, compiled as it compiles on its own.
function(cartographer_ext_add_cartographer_tree tree)
  unset(CMAKE_CXX_STANDARD)
  set(CMAKE_CXX_STANDARD_REQUIRED OFF)
  set(CMAKE_POSITION_INDEPENDENT_CODE OFF)
  set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/cartographer/bin")
  add_subdirectory("${tree}" "${CMAKE_BINARY_DIR}/cartographer" EXCLUDE_FROM_ALL)
endfunction()

# cartographer_ext_module(<name> [SUBFOLDERS names...] LINK libs...)
# One static library `cartographer_ext_<name>` from the sources of the current folder and the named subfolders; that of a core
# module from those of all of its subfolders but dropin/ and offline/.
function(cartographer_ext_module name)
  cmake_parse_arguments(ARG "" "" "SUBFOLDERS;LINK" ${ARGN})
  if(name IN_LIST CARTOGRAPHER_EXT_CORE_MODULES)
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/*.cc")
    list(FILTER sources EXCLUDE REGEX "/(dropin|offline)/")
  else()
    list(TRANSFORM ARG_SUBFOLDERS REPLACE "(.+)" "${CMAKE_CURRENT_SOURCE_DIR}/\\1/*.cc" OUTPUT_VARIABLE globs)
    file(GLOB sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/*.cc" ${globs})
  endif()
  set(target cartographer_ext_${name})
  if(sources AND name IN_LIST CARTOGRAPHER_EXT_CORE_MODULES)
    # The same objects become part of the host where it is swapped.
    cartographer_ext_add_core_objects(${name})
    add_library(${target} STATIC $<TARGET_OBJECTS:cartographer_ext_${name}_objects>)
    target_include_directories(${target} PUBLIC "${PROJECT_SOURCE_DIR}" "${PROJECT_BINARY_DIR}")
    target_link_libraries(${target} PUBLIC ${ARG_LINK})
  elseif(sources)
    add_library(${target} STATIC ${sources})
    target_include_directories(${target} PUBLIC "${PROJECT_SOURCE_DIR}" "${PROJECT_BINARY_DIR}")
    target_link_libraries(${target} PUBLIC ${ARG_LINK})
    cartographer_ext_warnings(${target})
    cartographer_ext_build_fast(${target})
  else()
    add_library(${target} INTERFACE)
    target_include_directories(${target} INTERFACE "${PROJECT_SOURCE_DIR}" "${PROJECT_BINARY_DIR}")
    target_link_libraries(${target} INTERFACE ${ARG_LINK})
  endif()
endfunction()

# cartographer_ext_tests([EXCLUDE regex] [INCLUDE regex] LINK libs...)
# One test program from all *_test.cc of the current folder, and one test of CTest per source: the program started with
# --test_source=<source> runs what that source defines.
function(cartographer_ext_tests)
  cmake_parse_arguments(ARG "" "EXCLUDE;INCLUDE" "LINK" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/*_test.cc")
  if(ARG_EXCLUDE)
    list(FILTER sources EXCLUDE REGEX "${ARG_EXCLUDE}")
  endif()
  if(ARG_INCLUDE)
    list(FILTER sources INCLUDE REGEX "${ARG_INCLUDE}")
  endif()
  if(NOT sources)
    return()
  endif()
  file(RELATIVE_PATH folder "${PROJECT_SOURCE_DIR}/tests" "${CMAKE_CURRENT_SOURCE_DIR}")
  string(REPLACE "/" "_" prefix "${folder}")
  set(target "${prefix}_tests")
  if(TARGET ${target})
    string(MD5 hash "${sources}")
    string(SUBSTRING "${hash}" 0 6 hash)
    set(target "${prefix}_tests_${hash}")
  endif()
  add_executable(${target} ${sources})
  set_target_properties(${target} PROPERTIES RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/tests")
  target_include_directories(${target} PRIVATE "${PROJECT_SOURCE_DIR}" "${PROJECT_BINARY_DIR}")
  target_link_libraries(${target} PRIVATE ${ARG_LINK} cartographer_ext_test_main)
  cartographer_ext_warnings(${target})
  # GCC 12 guesses the target of virtual calls in Ceres and then warns about the guess.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE -Wno-array-bounds -Wno-stringop-overflow)
  endif()
  cartographer_ext_build_fast(${target} TESTS)
  foreach(source IN LISTS sources)
    get_filename_component(stem "${source}" NAME_WE)
    add_test(NAME ${prefix}/${stem} COMMAND ${target} --test_source=${stem}.cc WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}")
    # The suppressions are for commands that a test starts; tests have them built in.
    set_tests_properties(${prefix}/${stem} PROPERTIES TIMEOUT 600
      ENVIRONMENT "LSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/tests/lsan_suppressions.txt:print_suppressions=0")
  endforeach()
endfunction()
