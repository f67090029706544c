# dependencies.cmake -- the system libraries that Daguerre stands on. All missing ones are named in
# one error, with the packages that bring them.
set(DG_MISSING "")

find_package(TBB QUIET)
if(NOT TARGET TBB::tbb)
    string(APPEND DG_MISSING "\n  oneTBB                     libtbb-dev")
endif()

find_package(HWY 1.0.3 QUIET)
if(NOT TARGET hwy::hwy)
    string(APPEND DG_MISSING "\n  Highway 1.0.3 or newer     libhwy-dev")
endif()

# Embree 4 where the system has it, else 3.13. Only core/geometry/embree_api.h sees the difference.
# Embree's own CMake file stops with an error of its own where oneTBB is missing, so that comes first.
if(TARGET TBB::tbb)
    find_package(embree 4 QUIET)
    if(NOT embree_FOUND)
        find_package(embree 3.13 QUIET)
    endif()
endif()
if(NOT TARGET embree)
    string(APPEND DG_MISSING "\n  Embree 4 or 3.13           libembree-dev")
endif()

if(DG_TESTS)
    find_package(doctest QUIET)
    if(NOT TARGET doctest::doctest)
        string(APPEND DG_MISSING "\n  doctest (for DG_TESTS)     doctest-dev")
    endif()
endif()

if(DG_MISSING)
    message(FATAL_ERROR "Missing libraries, and the Debian/Ubuntu packages that bring them:"
        "${DG_MISSING}\n"
        "Install them with apt, or run script/setup, which does. The wheel needs none of them; "
        "it wants x86-64 Linux with glibc 2.34 or newer, and Python 3.11 or newer.")
endif()

# Vector code is compiled for SSE4.2, AVX2 and AVX-512, and on ARM for NEON: each further instruction set takes time to
# compile. Highway's SSE4 includes AES, which our baseline lacks and our code does not use; without it SSE4 is the
# baseline, and SSSE3 is not compiled. Sets beyond the first AVX-512 add nothing that our code uses. Sizeless vectors
# (SVE, RVV) cannot be members of structs.
target_compile_definitions(hwy::hwy INTERFACE
    "HWY_DISABLED_TARGETS=(HWY_AVX3-1)|HWY_SVE|HWY_SVE2|HWY_SVE_256|HWY_SVE2_128|HWY_RVV")
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    target_compile_definitions(hwy::hwy INTERFACE HWY_DISABLE_PCLMUL_AES)
endif()

# On ARM the vector code is compiled once, for NEON: Highway's choice of a target for each function does not
# reach the constructors that GCC writes for structs of vectors. Highway 1.0.3 has NEON with AES only.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "aarch64|arm64")
    target_compile_definitions(hwy::hwy INTERFACE HWY_COMPILE_ONLY_STATIC)
    if(HWY_VERSION VERSION_LESS 1.0.4)
        target_compile_options(hwy::hwy INTERFACE -march=armv8-a+crypto)
    endif()
endif()

string(REGEX MATCH "^[0-9]+" DG_EMBREE_MAJOR "${embree_VERSION}")
message(STATUS "Embree ${embree_VERSION}, TBB ${TBB_VERSION}, Highway ${HWY_VERSION}")
add_library(dg_embree INTERFACE)
target_link_libraries(dg_embree INTERFACE embree)
target_compile_definitions(dg_embree INTERFACE DG_EMBREE_MAJOR=${DG_EMBREE_MAJOR})
