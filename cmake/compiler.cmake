# Compiler settings shared by every target.
#
# Floating point: no re-association and no silent fused multiply-add anywhere, because the run's bits must not depend
# on which translation unit or which rank computes a number. Kernels that want fused operations ask for them by name.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
include(CheckCXXSourceCompiles)
include(GNUInstallDirs)
# FindMPI and FindHDF5 look for the C components, hence LANGUAGES C; all sources are C++.
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 11)
  message(FATAL_ERROR "Thalweg needs GCC 11 or newer, and this is ${CMAKE_CXX_COMPILER_VERSION}; "
                      "choose another with -DCMAKE_CXX_COMPILER=g++-12")
endif()

# What every program that uses the libraries must be compiled with as well: SIMD packs in their headers are as wide as the
# architecture says.
add_library(thalweg_compile_options INTERFACE)
add_library(thalweg::compile_options ALIAS thalweg_compile_options)
set_target_properties(thalweg_compile_options PROPERTIES EXPORT_NAME compile_options)
target_compile_features(thalweg_compile_options INTERFACE cxx_std_20)
# Clang 14 breaks the survey of the fluid with the AVX-512 packs of libstdc++ 12: wrong lanes, seen at the first step.
target_compile_options(thalweg_compile_options INTERFACE
  -march=${THALWEG_ARCHITECTURE} $<$<CXX_COMPILER_ID:Clang>:-mno-avx512f> -ffp-contract=off)
target_include_directories(thalweg_compile_options INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/thalweg>)

# What they are compiled with themselves.
add_library(thalweg_own_options INTERFACE)
target_compile_options(thalweg_own_options INTERFACE
  -fno-math-errno -fno-trapping-math -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
  $<$<CXX_COMPILER_ID:Clang>:-Wno-missing-braces>
  $<$<BOOL:${THALWEG_WARNINGS_AS_ERRORS}>:-Werror>)
if(CMAKE_UNITY_BUILD)   # the sources of one unit see the names of the others, and are headers to GCC
  target_compile_options(thalweg_own_options INTERFACE
    -Wno-shadow $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endif()
# GCC 12 and 13 take the undefined vectors in their own AVX-512 header, which Eigen uses, for variables that somebody has
# forgotten to set: https://gcc.gnu.org/PR105593. Clang and GCC for other architectures still look for such variables.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 14)
  set(CMAKE_REQUIRED_FLAGS -march=${THALWEG_ARCHITECTURE})
  check_cxx_source_compiles("#ifndef __AVX512F__\n#error\n#endif\nint main() {}" THALWEG_HAS_AVX512)
  unset(CMAKE_REQUIRED_FLAGS)
  if(THALWEG_HAS_AVX512)
    target_compile_options(thalweg_own_options INTERFACE -Wno-maybe-uninitialized -Wno-uninitialized)
  endif()
endif()
if(THALWEG_SANITIZE)
  target_compile_options(thalweg_compile_options INTERFACE
    -fsanitize=${THALWEG_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(thalweg_compile_options INTERFACE -fsanitize=${THALWEG_SANITIZE})
endif()

# thalweg_library(name source... ): one of the project's libraries, usable alone as thalweg::name.
function(thalweg_library name)
  add_library(thalweg_${name} STATIC ${ARGN})
  add_library(thalweg::${name} ALIAS thalweg_${name})
  set_target_properties(thalweg_${name} PROPERTIES EXPORT_NAME ${name})
  target_link_libraries(thalweg_${name} PUBLIC thalweg_compile_options PRIVATE $<BUILD_INTERFACE:thalweg_own_options>)
endfunction()

# thalweg_links(source...): files that instantiate passes over links. Batches of links are whole vectors, however short.
function(thalweg_links)
  set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS
    "$<$<CXX_COMPILER_ID:GNU>:-fvect-cost-model=unlimited>")
endfunction()
