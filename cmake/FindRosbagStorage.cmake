# SPDX-FileCopyrightText: 2026 The cartographer_ext authors
# SPDX-License-Identifier: Apache-2.0
#
# librosbag-storage with the messages we read and write, as packaged by Debian
# (librosbag-storage-dev libsensor-msgs-dev libnav-msgs-dev libtf2-msgs-dev). Its
# own pkg-config and CMake files ask for packages that do not exist there, and its
# headers expect the include roots of ROS 2.
#
# Defines RosbagStorage_FOUND and the target RosbagStorage::RosbagStorage.
include(FindPackageHandleStandardArgs)

find_path(RosbagStorage_INCLUDE_DIR rosbag/bag.h)
set(RosbagStorage_INCLUDE_DIRS ${RosbagStorage_INCLUDE_DIR})
set(_rosbag_required RosbagStorage_INCLUDE_DIR)
foreach(_header sensor_msgs/LaserScan.h sensor_msgs/MultiEchoLaserScan.h sensor_msgs/Imu.h nav_msgs/Odometry.h
                tf2_msgs/TFMessage.h roslz4/lz4s.h)
  string(MAKE_C_IDENTIFIER "RosbagStorage_${_header}" _variable)
  find_path(${_variable} ${_header})
  mark_as_advanced(${_variable})
  list(APPEND _rosbag_required ${_variable})
endforeach()
# Includes are written pluginlib/x.hpp while the files lie in pluginlib/pluginlib/x.hpp.
foreach(_header pluginlib/class_loader.hpp class_loader/class_loader.hpp rcpputils/shared_library.hpp
                rcutils/shared_library.h ament_index_cpp/get_resource.hpp)
  get_filename_component(_package ${_header} DIRECTORY)
  find_path(RosbagStorage_${_package}_DIR ${_header} PATH_SUFFIXES ${_package})
  mark_as_advanced(RosbagStorage_${_package}_DIR)
  list(APPEND _rosbag_required RosbagStorage_${_package}_DIR)
  list(APPEND RosbagStorage_INCLUDE_DIRS "${RosbagStorage_${_package}_DIR}")
endforeach()

set(RosbagStorage_LIBRARIES)
foreach(_library rosbag_storage roscpp_serialization rostime cpp_common roslz4 class_loader rcpputils ament_index_cpp
                 console_bridge tinyxml2 boost_system boost_filesystem)
  find_library(RosbagStorage_${_library}_LIBRARY ${_library})
  mark_as_advanced(RosbagStorage_${_library}_LIBRARY)
  list(APPEND _rosbag_required RosbagStorage_${_library}_LIBRARY)
  list(APPEND RosbagStorage_LIBRARIES "${RosbagStorage_${_library}_LIBRARY}")
endforeach()

list(REMOVE_DUPLICATES RosbagStorage_INCLUDE_DIRS)
find_package_handle_standard_args(RosbagStorage REQUIRED_VARS ${_rosbag_required})
if(RosbagStorage_FOUND AND NOT TARGET RosbagStorage::RosbagStorage)
  add_library(RosbagStorage::RosbagStorage INTERFACE IMPORTED)
  set_target_properties(RosbagStorage::RosbagStorage PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${RosbagStorage_INCLUDE_DIRS}"
    INTERFACE_LINK_LIBRARIES "${RosbagStorage_LIBRARIES}")
endif()
mark_as_advanced(RosbagStorage_INCLUDE_DIR)
