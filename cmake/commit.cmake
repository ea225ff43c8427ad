# Writes HEADER, in which THALWEG_COMMIT is the commit of the source tree ROOT, with "modified" if files differ from it, or
# empty outside a repository. Run at every build (cmake -DROOT=... -DHEADER=... -P commit.cmake), so that results are not
# ascribed to the commit that was there when the build was configured. The file is only touched if it changes.
cmake_minimum_required(VERSION 3.25)

function(git output)
  execute_process(COMMAND git --no-optional-locks -C ${ROOT} ${ARGN} OUTPUT_VARIABLE said RESULT_VARIABLE failed OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(failed)
    set(said "")
  endif()
  set(${output} "${said}" PARENT_SCOPE)
endfunction()

git(commit rev-parse --short HEAD)
git(folder_in_repository rev-parse --show-prefix)
git(changes status --porcelain --untracked-files=no)
if(folder_in_repository)   # somebody else's repository
  set(commit "")
elseif(commit AND changes)
  string(APPEND commit ", modified")
endif()
file(CONFIGURE OUTPUT ${HEADER} CONTENT "#define THALWEG_COMMIT \"@commit@\"\n" @ONLY)
