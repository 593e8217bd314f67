# SPDX-FileCopyrightText: 2026 The cartographer_ext authors
# SPDX-License-Identifier: Apache-2.0
#
# What `cmake --install` and `cpack` put where. Two components:
#   tools  the commands with their Lua files and worlds; `cpack -G DEB` makes a Debian package of them
#   cores  headers and static libraries of the cores that need no Cartographer, for find_package(cartographer_ext)
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# In the order in which a linker wants them.
set(CARTOGRAPHER_EXT_INSTALLED_CORES io loop_closure scan_matching offline_optimization optimization uncertainty common proto)

function(cartographer_ext_install_tools)
  file(GLOB mains "${PROJECT_SOURCE_DIR}/cartographer_ext/tools/*_main.cc")
  foreach(main IN LISTS mains)
    get_filename_component(stem "${main}" NAME_WE)
    string(REGEX REPLACE "_main$" "" stem "${stem}")
    install(TARGETS cartographer_ext_${stem} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT tools)
  endforeach()
  # Not beside Cartographer's own files, which have the names of our stock ones.
  install(DIRECTORY configuration_files DESTINATION ${CMAKE_INSTALL_DATADIR}/cartographer_ext COMPONENT tools)
  install(FILES README.md BENCHMARK.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/cartographer-ext-tools
          COMPONENT tools)
  install(FILES packaging/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/cartographer-ext-tools COMPONENT tools)
  install(DIRECTORY docs third_party_notes DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/cartographer-ext-tools COMPONENT tools)
endfunction()

function(cartographer_ext_install_cores)
  set(module_folders ${CARTOGRAPHER_EXT_INSTALLED_CORES})
  list(REMOVE_ITEM module_folders proto offline_optimization)
  foreach(module IN LISTS CARTOGRAPHER_EXT_INSTALLED_CORES)
    install(TARGETS cartographer_ext_${module} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT cores)
  endforeach()
  foreach(folder IN LISTS module_folders)
    install(DIRECTORY cartographer_ext/${folder} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/cartographer_ext COMPONENT cores
            FILES_MATCHING PATTERN "*.h" PATTERN dropin EXCLUDE PATTERN "pbstream_*" EXCLUDE)
  endforeach()
  install(DIRECTORY "${CMAKE_BINARY_DIR}/cartographer_ext_proto/cartographer_ext" DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
          COMPONENT cores FILES_MATCHING PATTERN "*.h")
  get_target_property(definitions cartographer_ext_io INTERFACE_COMPILE_DEFINITIONS)
  set(RosbagStorage_FOUND OFF)
  if("CARTOGRAPHER_EXT_HAS_ROSBAG" IN_LIST definitions)
    set(RosbagStorage_FOUND ON)
  endif()
  set(folder ${CMAKE_INSTALL_LIBDIR}/cmake/cartographer_ext)
  configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/cartographer_extConfig.cmake.in"
    "${PROJECT_BINARY_DIR}/cartographer_extConfig.cmake" INSTALL_DESTINATION ${folder}
    PATH_VARS CMAKE_INSTALL_INCLUDEDIR CMAKE_INSTALL_LIBDIR)
  write_basic_package_version_file("${PROJECT_BINARY_DIR}/cartographer_extConfigVersion.cmake"
                                   COMPATIBILITY SameMinorVersion)
  install(FILES "${PROJECT_BINARY_DIR}/cartographer_extConfig.cmake"
                "${PROJECT_BINARY_DIR}/cartographer_extConfigVersion.cmake" cmake/FindRosbagStorage.cmake
          DESTINATION ${folder} COMPONENT cores)
endfunction()

cartographer_ext_install_cores()
if(CARTOGRAPHER_EXT_BUILD_TOOLS)
  cartographer_ext_install_tools()
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME cartographer-ext)
# A role at a host that cannot exist (RFC 2606): Debian refuses a maintainer without an address.
set(CPACK_PACKAGE_CONTACT "The cartographer_ext authors <authors@cartographer-ext.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Loop closure, scan matching and back ends for 2D SLAM: command line tools")
set(CPACK_COMPONENT_TOOLS_DESCRIPTION "\
Maps recordings of a planar laser (CARMEN logs, ROS 1 bags, ROS 2
recordings), judges finished maps with and without ground truth, repairs,
exports and compares them, simulates robots, and optimises pose graphs.
Reads and writes the files of Cartographer; needs neither ROS nor
Cartographer.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL tools)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
# The libraries that the programs are linked with.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
include(CPack)
