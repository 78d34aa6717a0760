# sprung_target(NAME): what every target of this project has in common: C++20, warnings, and includes
# written from the repository's root.
option(SPRUNG_WARNINGS_AS_ERRORS "Treat compiler warnings as errors" OFF)
option(SPRUNG_PRECOMPILED_HEADERS "Read Eigen, fmt and the standard library once for all sources" OFF)
option(SPRUNG_UNITY_BUILD "Compile the sources of a room as one, which is faster" OFF)

function(sprung_target name)
  _sprung_compile_options(${name})
  target_include_directories(${name} PUBLIC
    "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>" "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/sprung>")
  if(SPRUNG_PRECOMPILED_HEADERS)
    target_link_libraries(${name} PRIVATE Eigen3::Eigen fmt::fmt)
    target_precompile_headers(${name} REUSE_FROM sprung_precompiled)
  endif()
endfunction()

# GCC collects its garbage less often where there is memory to spare: an eighth less time, 0.4 GB more at most.
cmake_host_system_information(RESULT memory_mib QUERY TOTAL_PHYSICAL_MEMORY)
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND memory_mib GREATER 7000)
  set(compiler_memory --param=ggc-min-heapsize=1500000)
endif()

function(_sprung_compile_options name)
  target_compile_features(${name} PUBLIC cxx_std_20)
  set_target_properties(${name} PROPERTIES CXX_EXTENSIONS OFF)
  target_compile_options(${name} PRIVATE
    -fPIC -fvisibility=hidden -fvisibility-inlines-hidden  # for the module for Python
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor -Wold-style-cast
    $<$<BOOL:${SPRUNG_WARNINGS_AS_ERRORS}>:-Werror> ${compiler_memory})
endfunction()

# The headers that nearly every source reads, compiled once. Sources name what they include all the same: the preset
# debug builds without this, and without SPRUNG_UNITY_BUILD. The options have to be those of the targets that use it.
if(SPRUNG_PRECOMPILED_HEADERS)
  file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/precompiled.cpp" CONTENT "")
  add_library(sprung_precompiled STATIC "${PROJECT_BINARY_DIR}/precompiled.cpp")
  _sprung_compile_options(sprung_precompiled)
  target_link_libraries(sprung_precompiled PRIVATE Eigen3::Eigen fmt::fmt)
  target_precompile_headers(sprung_precompiled PRIVATE
    <Eigen/Core> <fmt/format.h> <algorithm> <array> <cmath> <complex> <filesystem> <functional> <map> <memory>
    <optional> <set> <span> <stdexcept> <string> <utility> <vector>)
endif()

# sprung_room(sources… [USES rooms…] [LINKS targets…]): a room is a folder and the library made of its sources.
# The room `a/b` is the target `sprung_a_b`. USES names every other room whose headers its files may include; a test
# holds the includes to it. LINKS names libraries of others that stay behind the room's headers. Every room may use
# Eigen and fmt.
function(sprung_room)
  cmake_parse_arguments(arg "" "" "USES;LINKS" ${ARGN})
  file(RELATIVE_PATH folder "${PROJECT_SOURCE_DIR}" "${CMAKE_CURRENT_SOURCE_DIR}")
  sprung_room_target(name "${folder}")
  add_library(${name} STATIC ${arg_UNPARSED_ARGUMENTS})
  sprung_target(${name})
  # All in one, since the templates of Eigen and fmt that they share are what takes the time. So names in anonymous
  # namespaces differ within a room.
  set_target_properties(${name} PROPERTIES UNITY_BUILD ${SPRUNG_UNITY_BUILD} UNITY_BUILD_BATCH_SIZE 0)
  target_link_libraries(${name} PUBLIC Eigen3::Eigen fmt::fmt PRIVATE ${arg_LINKS})
  foreach(room IN LISTS arg_USES)
    sprung_room_target(used "${room}")
    target_link_libraries(${name} PUBLIC ${used})
  endforeach()
endfunction()

# sprung_static_or_shared(RESULT SHARED [NAME…]): for programs with the property STATIC_LIBRARIES the static library beside
# a shared one, with those NAMEs that it needs, where all of them are there; else the shared one. A program is loaded in a
# third of the time without shared libraries. Not so the module for Python, which shares HDF5 with h5py, nor programs with
# other libraries that use the same ones.
function(sprung_static_or_shared result shared)
  get_filename_component(folder "${shared}" DIRECTORY)
  get_filename_component(first "${shared}" NAME_WE)
  foreach(name IN ITEMS ${first} LISTS ARGN)
    set(path "${folder}/${name}.a")
    if(NOT EXISTS "${path}")
      execute_process(COMMAND "${CMAKE_CXX_COMPILER}" -print-file-name=${name}.a
        OUTPUT_VARIABLE path OUTPUT_STRIP_TRAILING_WHITESPACE)
    endif()
    list(APPEND static "${path}")
    if(NOT IS_ABSOLUTE "${path}")
      set(${result} "${shared}" PARENT_SCOPE)
      return()
    endif()
  endforeach()
  set(is_static "$<BOOL:$<TARGET_PROPERTY:STATIC_LIBRARIES>>")
  set(${result} "$<${is_static}:${static}>" "$<$<NOT:${is_static}>:${shared}>" PARENT_SCOPE)
endfunction()

# The name of a room's target.
function(sprung_room_target result folder)
  string(REPLACE "/" "_" name "sprung_${folder}")
  set(${result} ${name} PARENT_SCOPE)
endfunction()
