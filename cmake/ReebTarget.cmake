# reeb_library(NAME SOURCES... [DEPENDS targets...]): a static library of one unit with the project's
# compile rules. Floating-point contraction is off everywhere, since decoded positions are specified
# to the bit.
add_library(reeb_rules INTERFACE)
target_compile_features(reeb_rules INTERFACE cxx_std_20)
target_compile_options(reeb_rules INTERFACE -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion
                                            -ffp-contract=off -fno-fast-math)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|i[3-6]86)$" AND CMAKE_SIZEOF_VOID_P EQUAL 4)
  # The x87 unit keeps more bits than binary32 and binary64 have.
  target_compile_options(reeb_rules INTERFACE -msse2 -mfpmath=sse)
endif()
if(REEB_WERROR)
  target_compile_options(reeb_rules INTERFACE -Werror)
endif()
if(REEB_SANITIZE)
  target_compile_options(reeb_rules INTERFACE -fsanitize=${REEB_SANITIZE} -fno-sanitize-recover=all
                                              -fno-omit-frame-pointer)
  target_link_options(reeb_rules INTERFACE -fsanitize=${REEB_SANITIZE})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # GCC 12 takes library code that sanitizers keep it from inlining for uninitialised.
    target_compile_options(reeb_rules INTERFACE -Wno-maybe-uninitialized)
  endif()
endif()
target_include_directories(reeb_rules INTERFACE ${PROJECT_SOURCE_DIR})

function(reeb_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES})
  string(REPLACE "reeb_" "" export_name ${name})
  set_target_properties(${name} PROPERTIES CXX_EXTENSIONS OFF POSITION_INDEPENDENT_CODE ON
                                           EXPORT_NAME unit_${export_name})
  target_link_libraries(${name} PUBLIC ${ARG_DEPENDS} PRIVATE $<BUILD_INTERFACE:reeb_rules>)
  target_include_directories(${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                                            $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/reeb>)
  target_compile_features(${name} PUBLIC cxx_std_20)
endfunction()

# reeb_together(TARGET [FILES...]): compiles these files, or all of a target, as one translation unit, since what
# they include and instantiate alike takes most of their time. A target may have several such groups.
option(REEB_TOGETHER "Compile files that include much alike as one translation unit" ON)
function(reeb_together target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${REEB_TOGETHER})
  if(ARGN)
    list(GET ARGN 0 first)
    string(MAKE_C_IDENTIFIER "with_${first}" group)
    set_target_properties(${target} PROPERTIES UNITY_BUILD_MODE GROUP)
    set_source_files_properties(${ARGN} PROPERTIES UNITY_GROUP ${group})
  else()
    set_target_properties(${target} PROPERTIES UNITY_BUILD_BATCH_SIZE 0)
  endif()
endfunction()
