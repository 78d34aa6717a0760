# What find_package(sprung) reads: the target sprung::superelement, with which a program reads and writes superelements.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3 3.4 NO_MODULE)
find_dependency(fmt)
include("${CMAKE_CURRENT_LIST_DIR}/sprung-targets.cmake")
