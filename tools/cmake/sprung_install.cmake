# What `cmake --install` puts into place, apart from the two programs, whose rooms say so themselves.
include(CMakePackageConfigHelpers)

# Tools, models and designs lie in share/sprung as they do in the sources.
set(share "${CMAKE_INSTALL_DATADIR}/sprung")
foreach(tool compare_frequencies convert_mesh export_csv export_paraview fatigue make_road.py plot_modes
    plot_response plot_results plot_sensitivity report report_peaks ride ride_limits study)
  install(PROGRAMS "tools/${tool}" DESTINATION "${share}/tools")
endforeach()
install(DIRECTORY tools/sprung tools/sprung_tools DESTINATION "${share}/tools" PATTERN __pycache__ EXCLUDE)
install(DIRECTORY dynamics/models DESTINATION "${share}/dynamics")
install(DIRECTORY meshes DESTINATION "${share}")
# What they refer to: the theory of each room, the formats of files.
file(GLOB_RECURSE texts RELATIVE "${PROJECT_SOURCE_DIR}" CONFIGURE_DEPENDS
  dynamics/*.md fem/*.md reduce/*.md tools/*.md)
list(FILTER texts EXCLUDE REGEX "^dynamics/models/")
foreach(text IN LISTS texts ITEMS README.md)
  get_filename_component(folder "${text}" DIRECTORY)
  install(FILES "${text}" DESTINATION "${share}/${folder}")
endforeach()
install(FILES LICENSE DESTINATION "${CMAKE_INSTALL_DOCDIR}")

# The rooms behind find_package(sprung), whose headers are included by the same names as here.
set(rooms tools/support/errors tools/support/dense tools/support/files tools/support/hdf5 reduce/superelement)
foreach(room IN LISTS rooms)
  sprung_room_target(target "${room}")
  install(TARGETS ${target} EXPORT sprung)
  install(DIRECTORY "${room}/" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/sprung/${room}" FILES_MATCHING PATTERN "*.h")
endforeach()
set_target_properties(sprung_reduce_superelement PROPERTIES EXPORT_NAME superelement)
set(package "${CMAKE_INSTALL_LIBDIR}/cmake/sprung")
install(EXPORT sprung NAMESPACE sprung:: FILE sprung-targets.cmake DESTINATION "${package}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/sprung-config-version.cmake" COMPATIBILITY SameMinorVersion)
install(FILES tools/cmake/sprung-config.cmake "${PROJECT_BINARY_DIR}/sprung-config-version.cmake"
  DESTINATION "${package}")
