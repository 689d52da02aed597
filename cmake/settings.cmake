# Compiler settings for all targets. All flags are set here.
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
  # ccache requires this sloppiness for precompiled headers. No source uses __TIME__ or __DATE__.
  set(CMAKE_CXX_COMPILER_LAUNCHER env CCACHE_SLOPPINESS=pch_defines,time_macros "${CCACHE_PROGRAM}")
endif()

add_library(heatsoak_settings INTERFACE)
target_compile_options(heatsoak_settings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor -Woverloaded-virtual
  # False positives of GCC 12 inside std::string and std::vector (GCC bugs 105651 and 105562).
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict> $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized> $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overflow>
  $<$<BOOL:${HEATSOAK_WERROR}>:-Werror>
  # Without fused multiply-add the same seed gives the same bytes on every machine.
  -ffp-contract=off)
if(HEATSOAK_SANITIZE)
  target_compile_options(heatsoak_settings INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(heatsoak_settings INTERFACE -fsanitize=address,undefined)
  # Ceres is built without sanitizers and shares templates of Eigen with this code. Both must allocate in the same way.
  target_compile_definitions(heatsoak_settings INTERFACE EIGEN_MALLOC_ALREADY_ALIGNED=1)
endif()
if(HEATSOAK_COVERAGE)
  target_compile_options(heatsoak_settings INTERFACE --coverage -fprofile-update=atomic)
  target_link_options(heatsoak_settings INTERFACE --coverage)
endif()

# add_headers(name header FILES file… LIBRARIES library… OPTIONS option…): a precompiled header for these libraries. It is parsed once for
# all targets that call use_headers(target name). FILES instantiate the templates that the header declares extern. OPTIONS are those of the
# targets: GCC optimises a file with the options of the header.
function(add_headers name header)
  cmake_parse_arguments(HEADERS "" "" "FILES;LIBRARIES;OPTIONS" ${ARGN})
  if(HEATSOAK_PRECOMPILE)
    add_library(${name} STATIC ${HEADERS_FILES})
    target_link_libraries(${name} PRIVATE heatsoak_settings ${HEADERS_LIBRARIES})
    target_precompile_headers(${name} PRIVATE "${header}")
    target_compile_options(${name} PRIVATE ${HEATSOAK_PRECOMPILED_OPTIONS} ${HEADERS_OPTIONS})
  endif()
endfunction()

# ccache detects the contents of a precompiled header only if the preprocessor's output mentions it.
set(HEATSOAK_PRECOMPILED_OPTIONS $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)

function(use_headers target name)
  if(HEATSOAK_PRECOMPILE)
    target_precompile_headers(${target} REUSE_FROM ${name})
    target_link_libraries(${target} PRIVATE ${name})
    target_compile_options(${target} PRIVATE ${HEATSOAK_PRECOMPILED_OPTIONS})
    get_target_property(type ${target} TYPE)
    if(type STREQUAL EXECUTABLE)
      # A precompiled header is valid for one kind of position-independent code only.
      set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
      target_compile_options(${target} PRIVATE -fPIC)
    endif()
  endif()
endfunction()
