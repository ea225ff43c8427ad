# Third-party libraries, all from the distribution's packages; the minimum versions are those of Debian 12. What newer ones have been
# tried is in docs/installing.md.
set(MPI_CXX_SKIP_MPICXX ON)
find_package(MPI 3.1 REQUIRED COMPONENTS C CXX)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
set(HDF5_PREFER_PARALLEL ON)
find_package(HDF5 1.10 REQUIRED COMPONENTS C)
if(NOT HDF5_IS_PARALLEL)
  message(FATAL_ERROR "Thalweg needs a parallel HDF5: install libhdf5-openmpi-dev")
endif()
find_package(SUNDIALS REQUIRED COMPONENTS cvode nvecserial sunlinsolband sunmatrixband)
if(SUNDIALS_VERSION VERSION_LESS 6.4)   # as an argument of find_package this would exclude version 7
  message(FATAL_ERROR "Thalweg needs SUNDIALS 6.4 or newer, and this is ${SUNDIALS_VERSION}")
endif()
find_package(yaml-cpp 0.7 REQUIRED)
find_package(fmt 9.0 REQUIRED)
find_package(CLI11 2.1 REQUIRED)
find_package(VTK 9.1 REQUIRED COMPONENTS CommonCore IOCore)

# The first Python on the path that has what is needed, else the first: it says what it lacks when it is used. /usr/bin is looked at
# last where it is not on the path.
function(thalweg_has_modules result python)
  execute_process(COMMAND ${python} -c "import ${THALWEG_PYTHON_MODULES}" RESULT_VARIABLE lacking OUTPUT_QUIET ERROR_QUIET)
  if(lacking)
    set(${result} FALSE PARENT_SCOPE)
  endif()
endfunction()
foreach(THALWEG_PYTHON_MODULES "h5py, numpy, yaml, matplotlib, vtkmodules" "h5py, numpy, yaml" "sys")
  find_program(THALWEG_PYTHON python3 VALIDATOR thalweg_has_modules
               DOC "Python with numpy, h5py and PyYAML, of thalweg analyze; of the tests too, with matplotlib and VTK")
endforeach()
if(NOT THALWEG_PYTHON AND THALWEG_BUILD_TESTS)
  message(FATAL_ERROR "The tests need Python 3: install it, name it with -DTHALWEG_PYTHON=..., or leave them out with "
                      "-DTHALWEG_BUILD_TESTS=OFF")
endif()

if(THALWEG_BUILD_TESTS)
  find_package(GTest 1.12 REQUIRED)
endif()
if(THALWEG_BUILD_BENCHMARKS)
  find_package(benchmark 1.7 REQUIRED)
endif()
