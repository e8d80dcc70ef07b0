include(CMakePackageConfigHelpers)
get_property(modules GLOBAL PROPERTY BOUGH_MODULES)
install(TARGETS ${modules} EXPORT BoughTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
if(TARGET bough)
  install(TARGETS bough RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  # The program writes its manual page and its completion itself, so that they say what --help says.
  install(CODE "
    execute_process(COMMAND \"$<TARGET_FILE:bough>\" --man-page
      OUTPUT_FILE \"${CMAKE_BINARY_DIR}/bough.1\" COMMAND_ERROR_IS_FATAL ANY)
    execute_process(COMMAND \"$<TARGET_FILE:bough>\" --bash-completion
      OUTPUT_FILE \"${CMAKE_BINARY_DIR}/bough.bash\" COMMAND_ERROR_IS_FATAL ANY)")
  install(FILES ${CMAKE_BINARY_DIR}/bough.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
  install(FILES ${CMAKE_BINARY_DIR}/bough.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
    RENAME bough)
endif()
foreach(room base formats fe modal stiffening solver)
  install(DIRECTORY ${CMAKE_SOURCE_DIR}/${room} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/bough
    FILES_MATCHING PATTERN "*.hpp" PATTERN "detail" EXCLUDE)
endforeach()
install(DIRECTORY ${CMAKE_SOURCE_DIR}/data/schema ${CMAKE_SOURCE_DIR}/data/examples
  DESTINATION ${CMAKE_INSTALL_DATADIR}/bough)
install(EXPORT BoughTargets NAMESPACE bough:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Bough)
configure_package_config_file(${CMAKE_SOURCE_DIR}/cmake/BoughConfig.cmake.in ${CMAKE_BINARY_DIR}/BoughConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Bough)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/BoughConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/BoughConfig.cmake ${CMAKE_BINARY_DIR}/BoughConfigVersion.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Bough)
