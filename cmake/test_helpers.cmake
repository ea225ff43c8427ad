# thalweg_test(NAME name SOURCES file... LIBRARIES target... [RANKS 1 2 4 8] [QUICK 1 2] [LABELS label...])
#
# The GoogleTest suites in some sources of a module, registered once per number of MPI ranks. Ranks may outnumber the cores of the
# machine. On the numbers of ranks after QUICK they take a second or two, also where the sanitizers make them several times slower
# than that: these have the label quick, and the target quick_tests builds them. With THALWEG_ONLY_QUICK_TESTS there are no others.
#
# All tests of a module are one program, MODULE_tests. It is compiled in a few units of several sources, which takes a third of the
# time: what these instantiate of Eigen and GoogleTest is instantiated once for each unit.
function(thalweg_test)
  cmake_parse_arguments(T "" "NAME" "SOURCES;LIBRARIES;RANKS;QUICK;LABELS" ${ARGN})
  if(THALWEG_ONLY_QUICK_TESTS AND NOT T_QUICK)
    return()
  endif()
  if(NOT T_RANKS)
    set(T_RANKS 1)
  endif()
  cmake_path(GET CMAKE_CURRENT_SOURCE_DIR FILENAME module)
  set(program ${module}_tests)
  if(NOT TARGET ${program})
    add_executable(${program})
    target_link_libraries(${program} PRIVATE thalweg_test_support)
    if(NOT CMAKE_CXX_COMPILER_LAUNCHER)
      target_precompile_headers(${program} REUSE_FROM thalweg_test_support)
    endif()
  endif()
  target_sources(${program} PRIVATE ${T_SOURCES})
  target_link_libraries(${program} PRIVATE ${T_LIBRARIES})
  if(T_QUICK)
    if(NOT TARGET quick_tests)
      add_custom_target(quick_tests)
    endif()
    add_dependencies(quick_tests ${program})
  endif()
  thalweg_suites_of(${T_NAME} filter ${T_SOURCES})
  foreach(ranks IN LISTS T_RANKS)
    set(labels ${T_LABELS})
    if(ranks IN_LIST T_QUICK)
      list(APPEND labels quick)
    endif()
    add_test(NAME ${T_NAME}.${ranks}
             COMMAND ${MPIEXEC_EXECUTABLE} ${MPIEXEC_NUMPROC_FLAG} ${ranks} $<TARGET_FILE:${program}> --gtest_filter=${filter})
    thalweg_mpi_test_properties(${T_NAME}.${ranks} ${ranks})
    set_property(TEST ${T_NAME}.${ranks} PROPERTY LABELS ${labels})
    set_property(TEST ${T_NAME}.${ranks} APPEND PROPERTY ENVIRONMENT THALWEG_TEST_RANKS=${ranks})  # main() compares
  endforeach()
endfunction()

# Sets FILTER to GoogleTest's filter for the suites in the sources of the test NAME. A suite belongs to one test; a source has one at
# least. CMake runs again when one of the sources has changed.
function(thalweg_suites_of name filter)
  foreach(source IN LISTS ARGN)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${source})
    file(READ ${source} text)
    string(REGEX MATCHALL "\nTEST(_F|_P)?\\([A-Za-z0-9_]+" beginnings "${text}")
    list(TRANSFORM beginnings REPLACE ".*\\(" "")
    if(NOT beginnings)
      message(FATAL_ERROR "${name}: there is no test in ${source}")
    endif()
    list(APPEND suites ${beginnings})
  endforeach()
  list(REMOVE_DUPLICATES suites)
  get_property(others DIRECTORY PROPERTY thalweg_suites)
  foreach(suite IN LISTS suites)
    if(suite IN_LIST others)
      message(FATAL_ERROR "${name}: another test of this folder also has a suite ${suite}")
    endif()
    list(APPEND patterns ${suite}.* */${suite}.*)
  endforeach()
  set_property(DIRECTORY APPEND PROPERTY thalweg_suites ${suites})
  list(JOIN patterns : patterns)
  set(${filter} ${patterns} PARENT_SCOPE)
endfunction()

# thalweg_long_test(NAME name FILTER pattern): tests of this folder's program whose names begin with DISABLED_, which take minutes:
# ctest -L validation.
function(thalweg_long_test)
  cmake_parse_arguments(T "" "NAME;FILTER" "" ${ARGN})
  if(THALWEG_ONLY_QUICK_TESTS)
    return()
  endif()
  cmake_path(GET CMAKE_CURRENT_SOURCE_DIR FILENAME module)
  add_test(NAME ${T_NAME} COMMAND $<TARGET_FILE:${module}_tests> --gtest_also_run_disabled_tests --gtest_filter=${T_FILTER})
  thalweg_mpi_test_properties(${T_NAME} 1)
  set_tests_properties(${T_NAME} PROPERTIES LABELS validation TIMEOUT 1800)
endfunction()

# thalweg_extended_copy(module [DEPENDS file...]): the library thalweg_MODULE_extended, a copy of the module in which extend.py of this
# folder has made the changes that a user may make; EXTENDED_COPY is set to its include directory.
function(thalweg_extended_copy module)
  cmake_parse_arguments(T "" "" "DEPENDS" ${ARGN})
  get_target_property(copies thalweg_${module} SOURCES)
  file(GLOB_RECURSE originals CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${module}/*.hpp ${PROJECT_SOURCE_DIR}/${module}/*.cpp)
  set(copy ${CMAKE_CURRENT_BINARY_DIR}/copy)
  list(TRANSFORM copies PREPEND ${copy}/${module}/)
  # Named, so that what includes them is compiled again in the same build.
  set(headers ${originals})
  list(FILTER headers INCLUDE REGEX "\\.hpp$")
  list(TRANSFORM headers REPLACE "^${PROJECT_SOURCE_DIR}/" "${copy}/")
  add_custom_command(OUTPUT ${copies}
                     BYPRODUCTS ${headers}
                     COMMAND ${THALWEG_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/extend.py ${PROJECT_SOURCE_DIR} ${copy}
                     DEPENDS extend.py ${PROJECT_SOURCE_DIR}/tests/support/extended_copy.py ${T_DEPENDS} ${originals})
  set(library thalweg_${module}_extended)
  add_library(${library} STATIC ${copies})
  target_include_directories(${library} BEFORE PUBLIC ${copy})
  target_link_libraries(${library} PUBLIC thalweg::core PRIVATE thalweg_own_options)
  set(EXTENDED_COPY ${copy} PARENT_SCOPE)
endfunction()

# Environment under which Open MPI 4 and 5 run more ranks than cores, as root in a container.
# All ranks of a test are on one machine: without a search for faster networks (pml ob1) each run begins 0.2 s sooner.
# (Without a daemon, ess_singleton_isolated, a run without mpirun would begin another 0.2 s sooner, but all such runs then have the
# same job number, and remove each other's session folder.)
set(THALWEG_MPI_ENVIRONMENT
    "OMPI_ALLOW_RUN_AS_ROOT=1;OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1;OMPI_MCA_rmaps_base_oversubscribe=1;OMPI_MCA_btl_base_warn_component_unused=0;OMPI_MCA_hwloc_base_binding_policy=none;OMPI_MCA_btl_vader_single_copy_mechanism=none;OMPI_MCA_pml=ob1"
    "PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe;PRTE_MCA_hwloc_default_binding_policy=none;OMPI_MCA_smsc=^cma")
# Clang up to 16 and GCC up to 13 take some thread-local blocks of libraries for those of glibc before 2.25, and the search for
# leaks then crashes now and again. Without the option below they leave these blocks alone.
# https://github.com/google/sanitizers/issues/1322
if(THALWEG_SANITIZE)
  list(APPEND THALWEG_MPI_ENVIRONMENT "ASAN_OPTIONS=intercept_tls_get_addr=0"
       "LSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/tests/support/leaks_of_libraries.txt" "UBSAN_OPTIONS=print_stacktrace=1")
endif()
# Ranks that wait give up their time slice, but for two, which have a core each and would give it to other work of the machine:
# Linux 6.18 lets even the lowest priority go first, and the test then takes ten times as long. (Where there is one core, Open MPI
# sees to it.)
function(thalweg_mpi_test_properties test ranks)
  set(environment "${THALWEG_MPI_ENVIRONMENT}")
  if(NOT ranks EQUAL 2)
    list(APPEND environment OMPI_MCA_mpi_yield_when_idle=1)
  endif()
  set(slots ${ranks})
  if(slots GREATER 2)
    set(slots 2)
  endif()
  set_tests_properties(${test} PROPERTIES ENVIRONMENT "${environment}" PROCESSORS ${slots} TIMEOUT 600)
endfunction()
