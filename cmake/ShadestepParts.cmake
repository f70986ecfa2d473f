# One part of the house = one folder = one target. `shadestep_part` gives every part the same warnings,
# and makes the direction of knowledge (docs/hacking.md) a build error when it is broken:
#   - a part may USE only what the table below allows;
#   - a part's headers are found only by those who USE it, as "<part>/<header>.h".

set(SHADESTEP_ALLOWED_wire "")
set(SHADESTEP_ALLOWED_interceptor wire)
set(SHADESTEP_ALLOWED_glsl-frontend "")
set(SHADESTEP_ALLOWED_instrumenter glsl-frontend)
set(SHADESTEP_ALLOWED_session instrumenter glsl-frontend wire)
set(SHADESTEP_ALLOWED_profiler session instrumenter glsl-frontend)
set(SHADESTEP_ALLOWED_cli profiler session instrumenter glsl-frontend)
set(SHADESTEP_ALLOWED_debugger-gui profiler session instrumenter glsl-frontend)

add_library(shadestep_warnings INTERFACE)
target_compile_options(shadestep_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Werror -Wshadow -Wnon-virtual-dtor -Wold-style-cast -Wcast-align
  -Wunused -Woverloaded-virtual -Wdouble-promotion -Wimplicit-fallthrough)

# SHADESTEP_SANITIZE (a list as -fsanitize= takes it) holds for the debugger's own side, from the front-end up, and for what
# links it. The guest, what it shares with the debugger (wire), and the programs under debug stay as they are: a preloaded
# library must come before a sanitizer's runtime, and what a user's program links is not ours to change.
set(SHADESTEP_SANITIZE "" CACHE STRING "Sanitizers for the debugger's own side, such as address,undefined")
add_library(shadestep_sanitized INTERFACE)
if(SHADESTEP_SANITIZE)
  # With its checks in between, the compiler no longer sees what libstdc++'s std::function initializes.
  target_compile_options(shadestep_sanitized INTERFACE
    -fsanitize=${SHADESTEP_SANITIZE} -fno-omit-frame-pointer -Wno-maybe-uninitialized)
  target_link_options(shadestep_sanitized INTERFACE -fsanitize=${SHADESTEP_SANITIZE})
endif()
set(SHADESTEP_PLAIN_PARTS wire interceptor CACHE STRING "Parts that stay as they are")

# shadestep_check_uses(PART USES...): stops the configuration when PART may not know one of USES.
function(shadestep_check_uses part)
  foreach(used IN LISTS ARGN)
    if(NOT used IN_LIST SHADESTEP_ALLOWED_${part})
      message(FATAL_ERROR "${part} may not use ${used}; see the table in cmake/ShadestepParts.cmake "
        "and the layers in docs/hacking.md")
    endif()
  endforeach()
endfunction()

# Makes this folder's headers reachable as "<part>/<header>.h", and as nothing else.
function(shadestep_export_headers target part)
  set(view ${CMAKE_BINARY_DIR}/include/${part})
  file(MAKE_DIRECTORY ${view})
  if(NOT EXISTS ${view}/${part})
    file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR} ${view}/${part} SYMBOLIC)
  endif()
  target_include_directories(${target} PUBLIC ${view})
endfunction()

# shadestep_part(NAME SOURCES a.cpp... [USES part...] [LINKS lib...] [PRIVATE_LINKS lib...])
# Defines the static library target shadestep-NAME in the current folder.
function(shadestep_part name)
  cmake_parse_arguments(PART "" "" "SOURCES;USES;LINKS;PRIVATE_LINKS" ${ARGN})
  shadestep_check_uses(${name} ${PART_USES})
  add_library(shadestep-${name} STATIC ${PART_SOURCES})
  shadestep_export_headers(shadestep-${name} ${name})
  list(TRANSFORM PART_USES PREPEND shadestep- OUTPUT_VARIABLE targets)
  if(NOT name IN_LIST SHADESTEP_PLAIN_PARTS)
    list(APPEND targets shadestep_sanitized)
  endif()
  target_link_libraries(shadestep-${name}
    PUBLIC ${targets} ${PART_LINKS}
    PRIVATE shadestep_warnings ${PART_PRIVATE_LINKS})
endfunction()

# shadestep_test(NAME SOURCES a.cpp... LINKS lib... [LABELS l...])
# A GoogleTest executable whose cases are registered with ctest one by one.
function(shadestep_test name)
  cmake_parse_arguments(TEST "" "" "SOURCES;LINKS;LABELS;PROPERTIES" ${ARGN})
  add_executable(${name} ${TEST_SOURCES})
  target_link_libraries(${name} PRIVATE ${TEST_LINKS} shadestep_warnings GTest::gtest GTest::gmock GTest::gtest_main)
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST
    PROPERTIES LABELS "${TEST_LABELS}" TIMEOUT 300 ${TEST_PROPERTIES})
endfunction()
