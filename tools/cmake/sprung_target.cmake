# sprung_target(NAME): what every target of this project has in common: C++20, warnings, and includes
# written from the repository's root.
option(SPRUNG_WARNINGS_AS_ERRORS "Treat compiler warnings as errors" OFF)
option(SPRUNG_UNITY "Compile each room in a few large pieces, which takes a third of the time" OFF)

function(sprung_target name)
  target_compile_features(${name} PUBLIC cxx_std_20)
  set_target_properties(${name} PROPERTIES CXX_EXTENSIONS OFF)
  target_include_directories(${name} PUBLIC "${PROJECT_SOURCE_DIR}")
  target_compile_options(${name} PRIVATE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor -Wold-style-cast
    $<$<BOOL:${SPRUNG_WARNINGS_AS_ERRORS}>:-Werror>)
endfunction()

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
  set_target_properties(${name} PROPERTIES UNITY_BUILD ${SPRUNG_UNITY} UNITY_BUILD_BATCH_SIZE 12)
  target_link_libraries(${name} PUBLIC Eigen3::Eigen fmt::fmt PRIVATE ${arg_LINKS})
  foreach(room IN LISTS arg_USES)
    sprung_room_target(used "${room}")
    target_link_libraries(${name} PUBLIC ${used})
  endforeach()
endfunction()

# The name of a room's target.
function(sprung_room_target result folder)
  string(REPLACE "/" "_" name "sprung_${folder}")
  set(${result} ${name} PARENT_SCOPE)
endfunction()
