# Components of the installation of which ./dev package makes Debian packages: bough (the program), libbough1 and
# libbough-dev (libbough.so, embed/CMakeLists.txt), bough-dev (static libraries), python3-bough (python/CMakeLists.txt),
# bough-doc.
include(CMakePackageConfigHelpers)
get_property(modules GLOBAL PROPERTY BOUGH_MODULES)
install(TARGETS ${modules} EXPORT BoughTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT bough-dev
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT bough-dev)
if(TARGET bough)
  install(TARGETS bough RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT bough)
  # The program writes its manual pages and completions itself, so that they say what --help says.
  set(help ${CMAKE_BINARY_DIR}/help)
  install(CODE "
    execute_process(COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:bough> -DOUTPUT=${help}
      -P ${CMAKE_SOURCE_DIR}/packaging/write_help.cmake COMMAND_ERROR_IS_FATAL ANY)" COMPONENT bough)
  install(DIRECTORY ${help}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT bough)
  install(FILES ${help}/bough.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME bough
    COMPONENT bough)
  install(FILES ${help}/bough.zsh DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions RENAME _bough
    COMPONENT bough)
  install(FILES ${help}/bough.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT bough)
endif()
foreach(room base formats fe modal stiffening solver embed cosim report analysis)
  install(DIRECTORY ${CMAKE_SOURCE_DIR}/${room} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/bough COMPONENT bough-dev
    FILES_MATCHING PATTERN "*.hpp" PATTERN "*.h" PATTERN "detail" EXCLUDE)
endforeach()
install(DIRECTORY ${CMAKE_SOURCE_DIR}/data/schema ${CMAKE_SOURCE_DIR}/data/examples ${CMAKE_SOURCE_DIR}/data/matlab
  DESTINATION ${CMAKE_INSTALL_DATADIR}/bough COMPONENT bough)
install(EXPORT BoughEmbedTargets NAMESPACE bough:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Bough COMPONENT libbough-dev)
install(EXPORT BoughTargets NAMESPACE bough:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Bough COMPONENT bough-dev)
configure_package_config_file(${CMAKE_SOURCE_DIR}/cmake/BoughConfig.cmake.in ${CMAKE_BINARY_DIR}/BoughConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Bough)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/BoughConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/BoughConfig.cmake ${CMAKE_BINARY_DIR}/BoughConfigVersion.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Bough COMPONENT libbough-dev)
# The manual, where ./dev docs has built it.
install(DIRECTORY ${CMAKE_BINARY_DIR}/html/ DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/bough-doc/html COMPONENT bough-doc OPTIONAL
  PATTERN ".buildinfo" EXCLUDE PATTERN ".doctrees" EXCLUDE)
include(${CMAKE_SOURCE_DIR}/packaging/debian.cmake)
