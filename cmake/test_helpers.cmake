# thalweg_test(NAME name SOURCES file... LIBRARIES target... [RANKS 1 2 4 8] [QUICK 1 2] [LABELS label...])
#
# One GoogleTest executable, registered once per number of MPI ranks. Ranks may outnumber the cores of the machine. On the
# numbers of ranks after QUICK it takes a second or two, also where the sanitizers make it several times slower than that:
# these have the label quick, and the target quick_tests builds them.
function(thalweg_test)
  cmake_parse_arguments(T "" "NAME" "SOURCES;LIBRARIES;RANKS;QUICK;LABELS" ${ARGN})
  if(NOT T_RANKS)
    set(T_RANKS 1)
  endif()
  add_executable(${T_NAME} ${T_SOURCES})
  set_target_properties(${T_NAME} PROPERTIES UNITY_BUILD OFF)   # each source has its own constants
  target_link_libraries(${T_NAME} PRIVATE thalweg_test_support ${T_LIBRARIES})
  if(NOT CMAKE_CXX_COMPILER_LAUNCHER)
    target_precompile_headers(${T_NAME} REUSE_FROM thalweg_test_support)
  endif()
  if(T_QUICK)
    if(NOT TARGET quick_tests)
      add_custom_target(quick_tests)
    endif()
    add_dependencies(quick_tests ${T_NAME})
  endif()
  foreach(ranks IN LISTS T_RANKS)
    set(labels ${T_LABELS})
    if(ranks IN_LIST T_QUICK)
      list(APPEND labels quick)
    endif()
    add_test(NAME ${T_NAME}.${ranks}
             COMMAND ${MPIEXEC_EXECUTABLE} ${MPIEXEC_NUMPROC_FLAG} ${ranks} $<TARGET_FILE:${T_NAME}>)
    thalweg_mpi_test_properties(${T_NAME}.${ranks} ${ranks})
    set_property(TEST ${T_NAME}.${ranks} PROPERTY LABELS ${labels})
  endforeach()
endfunction()

# Environment under which Open MPI runs more ranks than cores, as root in a container, and gives up its time slice.
# All ranks of a test are on one machine: without a search for faster networks (pml ob1) each run begins 0.2 s sooner.
set(THALWEG_MPI_ENVIRONMENT
    "OMPI_ALLOW_RUN_AS_ROOT=1;OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1;OMPI_MCA_rmaps_base_oversubscribe=1;OMPI_MCA_mpi_yield_when_idle=1;OMPI_MCA_btl_base_warn_component_unused=0;OMPI_MCA_hwloc_base_binding_policy=none;OMPI_MCA_btl_vader_single_copy_mechanism=none;OMPI_MCA_pml=ob1")
# Clang up to 16 and GCC up to 13 take some thread-local blocks of libraries for those of glibc before 2.25, and the search for
# leaks then crashes now and again. Without the option below they leave these blocks alone.
# https://github.com/google/sanitizers/issues/1322
if(THALWEG_SANITIZE)
  list(APPEND THALWEG_MPI_ENVIRONMENT "ASAN_OPTIONS=intercept_tls_get_addr=0"
       "LSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/tests/support/leaks_of_libraries.txt" "UBSAN_OPTIONS=print_stacktrace=1")
endif()
function(thalweg_mpi_test_properties test ranks)
  set(slots ${ranks})
  if(slots GREATER 2)
    set(slots 2)
  endif()
  set_tests_properties(${test} PROPERTIES ENVIRONMENT "${THALWEG_MPI_ENVIRONMENT}" PROCESSORS ${slots} TIMEOUT 600)
endfunction()
