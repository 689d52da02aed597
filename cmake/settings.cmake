# How everything is compiled; one place for flags.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/bin")
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/lib/heatsoak")

get_property(is_multi_config GLOBAL PROPERTY GENERATOR_IS_MULTI_CONFIG)
if(NOT CMAKE_BUILD_TYPE AND NOT is_multi_config)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Debug, Release or RelWithDebInfo" FORCE)
endif()

option(HEATSOAK_SANITIZE "Build with the address and undefined behaviour sanitizers" OFF)
option(HEATSOAK_COVERAGE "Build with coverage counters (gcov)" OFF)
option(HEATSOAK_WERROR "Treat warnings as errors" OFF)

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER "${CCACHE_PROGRAM}")
endif()

add_library(heatsoak_settings INTERFACE)
target_compile_options(heatsoak_settings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor -Woverloaded-virtual
  # GCC 12 reports both inside std::string and std::vector where nothing is wrong (its bugs 105651 and 105562).
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict> $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>
  $<$<BOOL:${HEATSOAK_WERROR}>:-Werror>
  # Same seed, same bytes on every machine: no fused multiply-add where the compiler happens to like it.
  -ffp-contract=off)
if(HEATSOAK_SANITIZE)
  target_compile_options(heatsoak_settings INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(heatsoak_settings INTERFACE -fsanitize=address,undefined)
endif()
if(HEATSOAK_COVERAGE)
  target_compile_options(heatsoak_settings INTERFACE --coverage -fprofile-update=atomic)
  target_link_options(heatsoak_settings INTERFACE --coverage)
endif()
