# sprung_target(NAME): what every target of this project has in common: C++20, warnings, and includes
# written from the repository's root.
option(SPRUNG_WARNINGS_AS_ERRORS "Treat compiler warnings as errors" OFF)

function(sprung_target name)
  target_compile_features(${name} PUBLIC cxx_std_20)
  set_target_properties(${name} PROPERTIES CXX_EXTENSIONS OFF)
  target_include_directories(${name} PUBLIC "${PROJECT_SOURCE_DIR}")
  target_compile_options(${name} PRIVATE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor -Wold-style-cast
    $<$<BOOL:${SPRUNG_WARNINGS_AS_ERRORS}>:-Werror>)
endfunction()
