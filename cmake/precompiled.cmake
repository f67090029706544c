# precompiled.cmake -- headers that many files include are compiled once: parsing them took half of a build.
# Builds with DG_PRECOMPILED=OFF find files that forget an include (script/test-all makes one).
option(DG_PRECOMPILED "Precompile headers that many files include" ON)
set(DG_HEADERS
    <algorithm> <array> <atomic> <bit> <cmath> <complex> <cstdint> <functional> <limits> <map> <memory> <mutex> <numeric>
    <optional> <random> <span> <sstream> <string> <thread> <utility> <variant> <vector>
    <oneapi/tbb/blocked_range.h> <oneapi/tbb/global_control.h> <oneapi/tbb/parallel_for.h> <oneapi/tbb/task_arena.h>)

if(DG_PRECOMPILED)
    file(WRITE ${CMAKE_BINARY_DIR}/precompiled.cpp "")
    add_library(dg_precompiled OBJECT ${CMAKE_BINARY_DIR}/precompiled.cpp)
    target_link_libraries(dg_precompiled PRIVATE TBB::tbb)
    target_precompile_headers(dg_precompiled PRIVATE ${DG_HEADERS})
endif()

# dg_precompile(TARGET [headers...]): the headers above, and further ones that most files of this target include.
function(dg_precompile target)
    if(NOT DG_PRECOMPILED)
        return()
    elseif(ARGN)
        target_precompile_headers(${target} PRIVATE ${DG_HEADERS} ${ARGN})
    else()
        target_precompile_headers(${target} REUSE_FROM dg_precompiled)
    endif()
endfunction()
