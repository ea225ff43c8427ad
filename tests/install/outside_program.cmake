# Installs into a new folder, builds examples/channel against it and runs it; also runs the installed program. Variables: BUILD,
# SOURCE, WORK (folders), COMPILER, LAUNCHER (mpiexec and its option for the number of ranks).
file(REMOVE_RECURSE ${WORK})
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE failed OUTPUT_VARIABLE said ERROR_VARIABLE said)
  if(failed)
    message(FATAL_ERROR "${ARGN}\n${said}")
  endif()
endfunction()
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
run(${CMAKE_COMMAND} -S ${SOURCE}/examples/channel -B ${WORK}/build -DCMAKE_PREFIX_PATH=${WORK}/prefix
    -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_BUILD_TYPE=Release)
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${LAUNCHER} 2 ${WORK}/build/channel)
run(${WORK}/prefix/bin/thalweg defaults)
# The installed program finds the installed Python package, which says what it misses.
execute_process(COMMAND ${WORK}/prefix/bin/thalweg analyze ${WORK} ERROR_VARIABLE said OUTPUT_QUIET)
if(NOT said MATCHES "there is no case.yaml in it")
  message(FATAL_ERROR "thalweg analyze: ${said}")
endif()
# Nothing of the source tree is needed: no file that was installed names it.
file(GLOB configs ${WORK}/prefix/lib*/cmake/thalweg/*.cmake ${WORK}/prefix/lib/*/cmake/thalweg/*.cmake)
foreach(file IN LISTS configs)
  file(READ ${file} text)
  string(FIND "${text}" "${SOURCE}" at)
  if(NOT at EQUAL -1)
    message(FATAL_ERROR "${file} names ${SOURCE}")
  endif()
endforeach()
