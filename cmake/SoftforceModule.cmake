# softforce_module(NAME SOURCES … USES … PUBLIC … PRIVATE …)
#
# Makes the static library softforce_NAME (alias softforce::NAME) from the listed sources in
# src/NAME, with its public headers in include/softforce/NAME.
#   USES     our modules that it may include and links to
#   PUBLIC   outside libraries that appear in its public headers
#   PRIVATE  outside libraries that appear only in src/NAME
# The test layering_NAME holds every #include of the module against these lists.
function(softforce_module name)
  cmake_parse_arguments(ARG "" "" "SOURCES;USES;PUBLIC;PRIVATE" ${ARGN})
  add_library(softforce_${name} STATIC ${ARG_SOURCES})
  add_library(softforce::${name} ALIAS softforce_${name})
  target_include_directories(softforce_${name} PUBLIC ${PROJECT_SOURCE_DIR}/include
                                               PRIVATE ${PROJECT_SOURCE_DIR}/src)
  list(TRANSFORM ARG_USES PREPEND softforce:: OUTPUT_VARIABLE used_modules)
  target_link_libraries(softforce_${name} PUBLIC ${used_modules} ${ARG_PUBLIC}
                                          PRIVATE ${ARG_PRIVATE} softforce_settings)

  if(SOFTFORCE_BUILD_TESTS)
    list(JOIN ARG_USES "," uses)
    list(JOIN ARG_PUBLIC "," public)
    list(JOIN ARG_PRIVATE "," private)
    add_test(NAME layering_${name}
             COMMAND ${CMAKE_COMMAND} -DROOT=${PROJECT_SOURCE_DIR} -DMODULE=${name} -DUSES=${uses}
                     -DPUBLIC=${public} -DPRIVATE=${private}
                     -P ${PROJECT_SOURCE_DIR}/cmake/CheckLayering.cmake)
  endif()
endfunction()

# softforce_test(NAME SOURCES … USES … LIBRARIES …): the GoogleTest program NAME_test, for the module NAME if there is
# one.
function(softforce_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;USES;LIBRARIES" ${ARGN})
  add_executable(${name}_test ${ARG_SOURCES})
  if(TARGET softforce_${name})
    list(APPEND ARG_USES ${name})
  endif()
  list(TRANSFORM ARG_USES PREPEND softforce:: OUTPUT_VARIABLE used_modules)
  target_include_directories(${name}_test PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_link_libraries(${name}_test PRIVATE ${used_modules} ${ARG_LIBRARIES}
                                             softforce_settings GTest::gtest GTest::gmock
                                             GTest::gtest_main)
  target_precompile_headers(${name}_test PRIVATE <gmock/gmock.h> <gtest/gtest.h>)
  target_compile_definitions(${name}_test PRIVATE SOFTFORCE_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  gtest_discover_tests(${name}_test DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT 300)
endfunction()

# Compiler settings that every target of the project shares.
add_library(softforce_settings INTERFACE)
target_compile_options(softforce_settings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror
  -Wno-sign-conversion        # Eigen's indices are signed, the standard library's are not
  -Wno-maybe-uninitialized)   # GCC 12 sees ghosts in Eigen's vectorised code
# Some imported targets switch OpenMP on; Eigen must not start threads of its own because of that.
target_compile_definitions(softforce_settings INTERFACE EIGEN_DONT_PARALLELIZE)
if(SOFTFORCE_SANITIZE)
  target_compile_options(softforce_settings INTERFACE
    -fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  target_link_options(softforce_settings INTERFACE -fsanitize=address,undefined)
endif()
if(SOFTFORCE_NAN_INITIALISE)
  target_compile_definitions(softforce_settings INTERFACE EIGEN_INITIALIZE_MATRICES_BY_NAN)
endif()
if(SOFTFORCE_BUILD_TESTS)
  include(GoogleTest)
endif()
