# Third-party libraries, all from the distribution's packages; the minimum versions are those of Debian 12.
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

# Debian's own interpreter where there is one, since scripts/setup installs the packages for that.
find_program(THALWEG_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH
             DOC "Python with numpy, h5py and PyYAML, of thalweg analyze; of the tests too, with matplotlib and VTK")
find_program(THALWEG_PYTHON python3)
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
