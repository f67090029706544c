# The system libraries that Daguerre stands on. A missing one is an error that names the package.
find_package(TBB REQUIRED)
find_package(HWY 1.0.3 REQUIRED)

# Embree 4 where the system has it, else 3.13. Only core/geometry/embree.h sees the difference.
find_package(embree 4 QUIET)
if(NOT embree_FOUND)
    find_package(embree 3.13 REQUIRED)
endif()
string(REGEX MATCH "^[0-9]+" DG_EMBREE_MAJOR "${embree_VERSION}")
message(STATUS "Embree ${embree_VERSION}, TBB ${TBB_VERSION}, Highway ${HWY_VERSION}")
add_library(dg_embree INTERFACE)
target_link_libraries(dg_embree INTERFACE embree)
target_compile_definitions(dg_embree INTERFACE DG_EMBREE_MAJOR=${DG_EMBREE_MAJOR})
