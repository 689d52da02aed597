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
option(HEATSOAK_MEASURED "Build what learns from measured data: the verbs log, friction, calibrate and diagnose, and the tests" ON)
option(HEATSOAK_PRECOMPILE "Compile the headers of libraries once for all files; off shows what a file forgot to include" ON)

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # The sloppiness is what ccache asks for where headers are precompiled; no source says __TIME__ or __DATE__.
  set(CMAKE_CXX_COMPILER_LAUNCHER env CCACHE_SLOPPINESS=pch_defines,time_macros "${CCACHE_PROGRAM}")
endif()

add_library(heatsoak_settings INTERFACE)
target_compile_options(heatsoak_settings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor -Woverloaded-virtual
  # GCC 12 reports these inside std::string and std::vector where nothing is wrong (its bugs 105651 and 105562).
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict> $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized> $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overflow>
  $<$<BOOL:${HEATSOAK_WERROR}>:-Werror>
  # Same seed, same bytes on every machine: no fused multiply-add where the compiler happens to like it.
  -ffp-contract=off)
if(HEATSOAK_SANITIZE)
  target_compile_options(heatsoak_settings INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(heatsoak_settings INTERFACE -fsanitize=address,undefined)
  # Ceres is compiled without them, and shares templates of Eigen with this: both have to allocate alike.
  target_compile_definitions(heatsoak_settings INTERFACE EIGEN_MALLOC_ALREADY_ALIGNED=1)
endif()
if(HEATSOAK_COVERAGE)
  target_compile_options(heatsoak_settings INTERFACE --coverage -fprofile-update=atomic)
  target_link_options(heatsoak_settings INTERFACE --coverage)
endif()

# add_headers(name header FILES file… LIBRARIES library…): a header of these libraries that is parsed once for every target
# that says use_headers(target name), and the files with the templates that it declares to be compiled elsewhere.
function(add_headers name header)
  cmake_parse_arguments(HEADERS "" "" "FILES;LIBRARIES" ${ARGN})
  if(HEATSOAK_PRECOMPILE)
    add_library(${name} STATIC ${HEADERS_FILES})
    target_link_libraries(${name} PRIVATE heatsoak_settings ${HEADERS_LIBRARIES})
    target_precompile_headers(${name} PRIVATE "${header}")
    target_compile_options(${name} PRIVATE ${HEATSOAK_PRECOMPILED_OPTIONS})
  endif()
endfunction()

# ccache can only tell what a precompiled header holds where the preprocessor's output says that it is used.
set(HEATSOAK_PRECOMPILED_OPTIONS $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)

function(use_headers target name)
  if(HEATSOAK_PRECOMPILE)
    target_precompile_headers(${target} REUSE_FROM ${name})
    target_link_libraries(${target} PRIVATE ${name})
    target_compile_options(${target} PRIVATE ${HEATSOAK_PRECOMPILED_OPTIONS})
    get_target_property(type ${target} TYPE)
    if(type STREQUAL EXECUTABLE)
      # A precompiled header serves one kind of position-independent code.
      set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
      target_compile_options(${target} PRIVATE -fPIC)
    endif()
  endif()
endfunction()
