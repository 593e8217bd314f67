# SPDX-FileCopyrightText: 2026 The cartographer_ext authors
# SPDX-License-Identifier: Apache-2.0
#
# A source that asks for CARTOGRAPHER_EXT_SWAP_X without the generated header gets the answer "not selected" in silence, so
# every source that asks must include the header.
#   cmake -DSOURCE_DIR=<this project> -P swaps_header_test.cmake
set(files)
foreach(folder cartographer_ext tests)
  file(GLOB_RECURSE found "${SOURCE_DIR}/${folder}/*.cc" "${SOURCE_DIR}/${folder}/*.h")
  list(APPEND files ${found})
endforeach()
set(asking 0)
foreach(file IN LISTS files)
  file(STRINGS "${file}" lines REGEX "CARTOGRAPHER_EXT_SWAP_[A-Z]|\"cartographer_ext/swaps.h\"")
  if(NOT lines)
    continue()
  endif()
  math(EXPR asking "${asking} + 1")
  list(GET lines 0 first)
  if(NOT first STREQUAL "#include \"cartographer_ext/swaps.h\"")
    message(SEND_ERROR "${file}: include \"cartographer_ext/swaps.h\" before '${first}'")
  endif()
endforeach()
if(asking EQUAL 0)
  message(SEND_ERROR "no source asks for a swap: is this the project? ${SOURCE_DIR}")
endif()
