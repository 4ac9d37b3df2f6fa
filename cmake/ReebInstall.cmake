# What `cmake --install` puts where, by component: decoder (the C library, shared), decoder_static, encoder (C++ static
# libraries and headers), tools (the reeb command, its manual page and completions).
include(CMakePackageConfigHelpers)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/reeb)

function(reeb_install_component component)
  install(
    TARGETS ${ARGN}
    EXPORT reeb-${component}
    RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT ${component}
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${component}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${component})
  install(
    EXPORT reeb-${component}
    NAMESPACE reeb::
    DESTINATION ${package_folder}
    COMPONENT ${component})
endfunction()

# The decoder's development files go with either form of it.
function(reeb_install_decoder_files component)
  install(
    FILES bindings/c/reeb.h bindings/c/reeb_attributes.h bindings/cpp/reeb.hpp bindings/cpp/reeb_attributes.hpp
          ${PROJECT_BINARY_DIR}/bindings/include/reeb_version.h
    DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
    COMPONENT ${component})
  install(
    FILES ${PROJECT_BINARY_DIR}/reeb.pc
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
    COMPONENT ${component})
endfunction()

function(reeb_install_package_files component)
  install(
    FILES ${PROJECT_BINARY_DIR}/reeb-config.cmake ${PROJECT_BINARY_DIR}/reeb-config-version.cmake
    DESTINATION ${package_folder}
    COMPONENT ${component})
endfunction()

configure_package_config_file(cmake/reeb-config.cmake.in reeb-config.cmake INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(reeb-config-version.cmake COMPATIBILITY SameMinorVersion)

# Relative to the file itself, so that the tree may be moved.
file(RELATIVE_PATH REEB_PC_TO_PREFIX /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
configure_file(cmake/reeb.pc.in reeb.pc @ONLY)

if(REEB_BUILD_BINDINGS)
  reeb_install_component(decoder reeb_shared)
  reeb_install_component(decoder_static reeb_static)
  foreach(component decoder decoder_static)
    reeb_install_decoder_files(${component})
    reeb_install_package_files(${component})
  endforeach()
endif()

if(REEB_BUILD_ENCODER)
  set_target_properties(reeb_encoder PROPERTIES EXPORT_NAME encoder)
  reeb_install_component(encoder reeb_entropy reeb_bitstream reeb_common reeb_decoder reeb_segmentation reeb_encoder)
  foreach(header bitstream/attribute_kinds.h bitstream/profile.h bitstream/status.h codec/common/base/attributes.h codec/common/base/sequence.h codec/common/base/stop.h codec/enc/encoder.h)
    get_filename_component(folder ${header} DIRECTORY)
    install(
      FILES ${header}
      DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/reeb/${folder}
      COMPONENT encoder)
  endforeach()
  reeb_install_component(tools reeb)
  set(REEB_PLAYER "" CACHE PATH "Built player (bindings/web/player/build.sh) to install for `reeb view`")
  if(REEB_PLAYER)
    install(
      DIRECTORY ${REEB_PLAYER}/
      DESTINATION ${CMAKE_INSTALL_DATADIR}/reeb/player
      COMPONENT tools)
  endif()
  if(TARGET reeb_man_page)
    install(
      FILES ${PROJECT_BINARY_DIR}/tools/reeb.1
      DESTINATION ${CMAKE_INSTALL_MANDIR}/man1
      COMPONENT tools)
    foreach(place bash:bash-completion/completions/reeb zsh:zsh/site-functions/_reeb
                  fish:fish/vendor_completions.d/reeb.fish)
      string(REGEX MATCH "^([a-z]+):(.*)/([^/]+)$" place ${place})
      install(
        FILES ${PROJECT_BINARY_DIR}/tools/completion.${CMAKE_MATCH_1}
        DESTINATION ${CMAKE_INSTALL_DATADIR}/${CMAKE_MATCH_2}
        RENAME ${CMAKE_MATCH_3}
        COMPONENT tools)
    endforeach()
  endif()
  foreach(component encoder tools)
    reeb_install_package_files(${component})
  endforeach()
endif()

# A build linked as it lies, without an installation: see bindings/python.
if(REEB_BUILD_BINDINGS AND REEB_BUILD_ENCODER)
  export(
    TARGETS reeb_rules reeb_entropy reeb_bitstream reeb_common reeb_decoder reeb_static reeb_segmentation reeb_retrieval
            reeb_encoder reeb_tools reeb_commands reeb_rd
    NAMESPACE reeb::
    FILE ${PROJECT_BINARY_DIR}/reeb-build-targets.cmake)
endif()
