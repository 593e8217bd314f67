# SPDX-FileCopyrightText: 2026 The cartographer_ext authors
# SPDX-License-Identifier: Apache-2.0
#
# Which swaps a Cartographer tree can take, read off what its headers declare, before anything is compiled.
#
# Cartographer 2.0 and master declare everything. Version 1.0 and forks made from it, as the ROS 2 fork, have a PointCloud that
# is a vector, no RangefinderPoint and no TrajectoryState. The residual of a constraint is the same there, but of no use without
# the optimization problem.

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
  if(NOT reasons)
    return()
  endif()
  if(possible)
    set(advice "Possible here: ${possible}. Select them with -DCARTOGRAPHER_EXT_SWAPS=\"${possible}\" or SWAPS.")
  else()
    set(advice "None of the swaps asked for is possible here.")
  endif()
  message(FATAL_ERROR "cartographer_ext: ${root} declares an older API than Cartographer 2.0 and cannot take:${reasons}\n${advice}")
endfunction()
