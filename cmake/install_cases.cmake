# Copies the cases of the folder FROM to TO (absolute paths). A case has a README.md; its files lie beside it, and what runs have written
# lies in folders below, which have none.
file(GLOB_RECURSE pages RELATIVE ${FROM} ${FROM}/*README.md)
foreach(page IN LISTS pages)
  cmake_path(GET page PARENT_PATH folder)
  file(GLOB files LIST_DIRECTORIES FALSE ${FROM}/${folder}/*)
  file(INSTALL DESTINATION ${TO}/${folder} TYPE FILE FILES ${files} USE_SOURCE_PERMISSIONS)
endforeach()
