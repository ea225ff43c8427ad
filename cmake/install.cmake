# cmake --install: the program with its Python package and cases, and the libraries as thalweg::core, lbm, bodies, dem, beds, model_fluid, coupling, continuum,
# analysis, loop and io for find_package(thalweg). Included when all of them are there.
include(CMakePackageConfigHelpers)

set(thalweg_config_folder ${CMAKE_INSTALL_LIBDIR}/cmake/thalweg)
set(thalweg_data_folder ${CMAKE_INSTALL_DATADIR}/thalweg)

install(TARGETS thalweg RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY python DESTINATION ${thalweg_data_folder} PATTERN "__pycache__" EXCLUDE
        PATTERN "build" EXCLUDE PATTERN "*.egg-info" EXCLUDE)   # of pip
install(CODE "set(FROM \"${PROJECT_SOURCE_DIR}/cases\")
set(TO \"\${CMAKE_INSTALL_PREFIX}/${thalweg_data_folder}/cases\")
include(\"${PROJECT_SOURCE_DIR}/cmake/install_cases.cmake\")")
install(PROGRAMS scripts/paraview_view.py scripts/compare_checkpoints.py DESTINATION ${thalweg_data_folder}/scripts)
install(FILES scripts/mpi_environment DESTINATION ${thalweg_data_folder}/scripts)   # to be sourced
install(PROGRAMS scripts/cluster/slurm.sh scripts/cluster/pbs.sh scripts/cluster/turn.sh
        DESTINATION ${thalweg_data_folder}/scripts/cluster)

# Completion for shells and the manual page come from the help of the program, part of which Python prints.
set(thalweg_help_folder ${PROJECT_BINARY_DIR}/help)
install(CODE "execute_process(COMMAND \"${THALWEG_PYTHON}\" -B \"${PROJECT_SOURCE_DIR}/cmake/help_files.py\" \"$<TARGET_FILE:thalweg>\"
                        \"${thalweg_help_folder}\" RESULT_VARIABLE failed ERROR_VARIABLE said)
if(failed)
  message(WARNING \"No completion for shells, no manual page and no schema of cases: \${said}\")
endif()")
install(FILES ${thalweg_help_folder}/thalweg.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 OPTIONAL)
install(FILES ${thalweg_help_folder}/thalweg.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME thalweg
        OPTIONAL)
install(FILES ${thalweg_help_folder}/thalweg.schema.json DESTINATION ${thalweg_data_folder} OPTIONAL)
install(FILES ${thalweg_help_folder}/_thalweg DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions OPTIONAL)

# io needs VTK, HDF5 and yaml-cpp, which not every program has to have.
install(TARGETS thalweg_compile_options thalweg_core thalweg_lbm thalweg_bodies thalweg_dem thalweg_beds thalweg_model_fluid thalweg_coupling thalweg_continuum thalweg_analysis thalweg_loop
        EXPORT thalweg_libraries ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS thalweg_io EXPORT thalweg_io ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
foreach(set libraries io)
  install(EXPORT thalweg_${set} NAMESPACE thalweg:: FILE thalweg-${set}.cmake DESTINATION ${thalweg_config_folder})
endforeach()
foreach(module core lbm bodies dem beds model_fluid coupling continuum analysis loop io)
  install(DIRECTORY ${module} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/thalweg
          FILES_MATCHING PATTERN "*.hpp" PATTERN "*.ipp")
endforeach()

configure_package_config_file(cmake/thalweg-config.cmake.in ${PROJECT_BINARY_DIR}/thalweg-config.cmake
                              INSTALL_DESTINATION ${thalweg_config_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/thalweg-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/thalweg-config.cmake ${PROJECT_BINARY_DIR}/thalweg-config-version.cmake
        DESTINATION ${thalweg_config_folder})
