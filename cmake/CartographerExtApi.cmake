# SPDX-FileCopyrightText: 2026 The cartographer_ext authors
# SPDX-License-Identifier: Apache-2.0
#
# Which swaps a Cartographer tree can take, read off what its headers declare, before anything is compiled.
#
# Cartographer 2.0, master and the ROS 2 fork since its release 2.0.9000 declare everything. Version 1.0 and forks made from it,
# as the ROS 2 fork up to release 1.0.9001, have a PointCloud that is a vector, no RangefinderPoint and no TrajectoryState. The
# residual of a constraint is the same there, but of no use without the optimization problem.

# What a swap needs, as "file below the tree|regular expression|its name". CMake lists are split at semicolons, so that the
# expressions have none.
set(CARTOGRAPHER_EXT_POINT_CLOUD
    "cartographer/sensor/point_cloud.h|class PointCloud|class sensor::PointCloud"
    "cartographer/sensor/rangefinder_point.h|struct RangefinderPoint|struct sensor::RangefinderPoint")
set(CARTOGRAPHER_EXT_TRAJECTORY_STATE
    "cartographer/mapping/pose_graph_interface.h|enum class TrajectoryState|enum PoseGraphInterface::TrajectoryState")
set(CARTOGRAPHER_EXT_API_OF_constraint_builder ${CARTOGRAPHER_EXT_POINT_CLOUD} ${CARTOGRAPHER_EXT_TRAJECTORY_STATE})
set(CARTOGRAPHER_EXT_API_OF_ceres_scan_matcher ${CARTOGRAPHER_EXT_POINT_CLOUD})
set(CARTOGRAPHER_EXT_API_OF_optimization_problem ${CARTOGRAPHER_EXT_TRAJECTORY_STATE}
    "cartographer/mapping/internal/optimization/optimization_problem_2d.h|TrajectoryState>|OptimizationProblem2D::Solve with trajectory states")
set(CARTOGRAPHER_EXT_API_OF_local_trajectory_builder ${CARTOGRAPHER_EXT_POINT_CLOUD}
    "cartographer/mapping/proto/local_trajectory_builder_options_2d.proto|message LocalTrajectoryBuilderOptions2D|its options message")
set(CARTOGRAPHER_EXT_API_OF_full_information ${CARTOGRAPHER_EXT_TRAJECTORY_STATE})

# The declarations that `swap` needs and the tree below `root` lacks, as one text.
function(cartographer_ext_missing_api swap root result)
  set(missing)
  foreach(requirement IN LISTS CARTOGRAPHER_EXT_API_OF_${swap})
    string(REPLACE "|" ";" parts "${requirement}")
    list(GET parts 0 path)
    list(GET parts 1 declaration)
    list(GET parts 2 name)
    set(text "")
    if(EXISTS "${root}/${path}")
      file(READ "${root}/${path}" text)
    endif()
    if(NOT text MATCHES "${declaration}")
      list(APPEND missing "${name} (${path})")
    endif()
  endforeach()
  string(REPLACE ";" ", " missing "${missing}")
  set(${result} "${missing}" PARENT_SCOPE)
endfunction()

# What the tree below `root` is, by its package.xml and by what it declares. The releases of the ROS 2 fork have versions of
# their own, such as 2.0.9004 for the fourth one that follows upstream 2.0.0.
function(cartographer_ext_name_tree root result)
  set(version "")
  if(EXISTS "${root}/package.xml")
    file(STRINGS "${root}/package.xml" version REGEX "<version>" LIMIT_COUNT 1)
    string(REGEX REPLACE ".*<version>([0-9.]*)</version>.*" "\\1" version "${version}")
  endif()
  if(version MATCHES "^[0-9]+\\.[0-9]+\\.9[0-9][0-9][0-9]$")
    set(name "the ROS 2 fork, release ${version}")
  elseif(version)
    set(name "Cartographer, package version ${version}")
  else()
    set(name "a Cartographer without package.xml")
  endif()
  set(${result} "${name}" PARENT_SCOPE)
endfunction()

# Ends configuring: what the tree is, the reason for each swap that it cannot take, and which swaps remain.
function(cartographer_ext_refuse root why reasons possible)
  if(possible)
    set(advice "Possible here: ${possible}. Select them with -DCARTOGRAPHER_EXT_SWAPS=\"${possible}\" or SWAPS.")
  else()
    set(advice "None of the swaps asked for is possible here.")
  endif()
  cartographer_ext_name_tree("${root}" name)
  message(FATAL_ERROR "cartographer_ext: ${root} is ${name}, which ${why}:${reasons}\n${advice}")
endfunction()

# An error that says for each of `swaps` whether the tree can take it, unless it can take all of them.
function(cartographer_ext_check_api root swaps)
  set(possible)
  set(reasons)
  foreach(swap IN LISTS swaps)
    cartographer_ext_missing_api(${swap} "${root}" missing)
    if(missing)
      string(APPEND reasons "\n  ${swap}: needs ${missing}")
    else()
      list(APPEND possible ${swap})
    endif()
  endforeach()
  if(reasons)
    cartographer_ext_refuse("${root}" "declares an older API than Cartographer 2.0 and cannot take" "${reasons}" "${possible}")
  endif()
endfunction()
