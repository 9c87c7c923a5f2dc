# The detector's pass over the bytes in vectors of xsimd, one source an instruction set, chosen at run time. Without
# xsimd 8 (Ubuntu 20.04 has 7) the plain loop does the work.
find_package(xsimd 8 QUIET)
if(NOT xsimd_FOUND)
  message(STATUS "xsimd 8 or later is missing: beacon detection is built without vectors")
  return()
endif()

set(simd_folder ${CMAKE_CURRENT_SOURCE_DIR}/src/sensing/beacon/simd)
target_sources(lodestar_beacon PRIVATE ${simd_folder}/change_base.cpp)
target_compile_definitions(lodestar_beacon PRIVATE LODESTAR_XSIMD)
# Headers only. Not by its target: Debian's links a libxtl that is not there.
target_include_directories(lodestar_beacon SYSTEM PRIVATE ${xsimd_INCLUDE_DIRS})
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  target_sources(lodestar_beacon PRIVATE ${simd_folder}/change_avx2.cpp ${simd_folder}/change_avx512.cpp)
  target_compile_definitions(lodestar_beacon PRIVATE LODESTAR_XSIMD_X86)
  set_source_files_properties(${simd_folder}/change_avx2.cpp PROPERTIES COMPILE_OPTIONS "-mavx2")
  set_source_files_properties(${simd_folder}/change_avx512.cpp PROPERTIES COMPILE_OPTIONS
    "-mavx512f;-mavx512cd;-mavx512dq;-mavx512bw;-mprefer-vector-width=512;-Wno-maybe-uninitialized")  # GCC 12's own headers
endif()
