# Compiler settings shared by every target.
#
# Floating point: no re-association and no silent fused multiply-add anywhere, because the run's bits must not depend
# on which translation unit or which rank computes a number. Kernels that want fused operations ask for them by name.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
# FindMPI and FindHDF5 look for the C components, hence LANGUAGES C; all sources are C++.
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG")

add_library(thalweg_compile_options INTERFACE)
target_compile_options(thalweg_compile_options INTERFACE
  -march=${THALWEG_ARCHITECTURE} -ffp-contract=off -fno-math-errno -fno-trapping-math
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion)
target_include_directories(thalweg_compile_options INTERFACE ${CMAKE_SOURCE_DIR})
if(THALWEG_SANITIZE)
  target_compile_options(thalweg_compile_options INTERFACE -fsanitize=${THALWEG_SANITIZE} -fno-omit-frame-pointer)
  target_link_options(thalweg_compile_options INTERFACE -fsanitize=${THALWEG_SANITIZE})
endif()

# thalweg_library(name source... ): a library of the house, usable alone as thalweg::name.
function(thalweg_library name)
  add_library(thalweg_${name} STATIC ${ARGN})
  add_library(thalweg::${name} ALIAS thalweg_${name})
  target_link_libraries(thalweg_${name} PUBLIC thalweg_compile_options)
endfunction()
