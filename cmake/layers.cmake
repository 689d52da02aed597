# add_layer(name USES … HIDES … ROOMS folder … REGISTERS folder:Type … OPTION option): one static library from src/<name> and its
# rooms (subfolders). A registered folder is a registry: every file x.cpp in it, or in a room of it, defines `Type x()` in the
# namespace heatsoak::<name>::<folder>. A table of these functions is generated as <name>/<folder>_registry.h. If the option is off, the
# layer is not built. Dependents then omit it, and rooms written as folder@layer.
set_property(GLOBAL PROPERTY heatsoak_layers "")
set_property(GLOBAL PROPERTY heatsoak_left_out "")

function(add_layer name)
  cmake_parse_arguments(LAYER "" "OPTION" "USES;HIDES;ROOMS;REGISTERS" ${ARGN})
  if(LAYER_OPTION AND NOT ${LAYER_OPTION})
    set_property(GLOBAL APPEND PROPERTY heatsoak_left_out ${name})
    return()
  endif()
  get_property(left_out GLOBAL PROPERTY heatsoak_left_out)
  foreach(layer IN LISTS left_out)
    list(REMOVE_ITEM LAYER_USES ${layer})
    list(FILTER LAYER_ROOMS EXCLUDE REGEX "@${layer}$")
  endforeach()
  list(TRANSFORM LAYER_ROOMS REPLACE "@.*" "")
  file(GLOB sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/src/${name}/*.cpp" "${PROJECT_SOURCE_DIR}/src/${name}/*.h")
  foreach(room IN LISTS LAYER_ROOMS)
    file(GLOB in_room CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/src/${name}/${room}/*.cpp" "${PROJECT_SOURCE_DIR}/src/${name}/${room}/*.h")
    list(APPEND sources ${in_room})
  endforeach()
  set(below "")
  get_property(declared GLOBAL PROPERTY heatsoak_layers)
  foreach(used IN LISTS LAYER_USES)
    if(used IN_LIST declared)
      list(APPEND below ${used})
      list(APPEND links heatsoak_${used})
    elseif(EXISTS "${PROJECT_SOURCE_DIR}/src/${used}")
      message(FATAL_ERROR "layer '${name}' uses '${used}', which is not declared above it")
    else()
      list(APPEND links ${used})
    endif()
  endforeach()
  foreach(registration IN LISTS LAYER_REGISTERS)
    string(REPLACE ":" ";" registration "${registration}")
    list(GET registration 0 folder)
    list(GET registration 1 type)
    file(GLOB entries CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/src/${name}/${folder}/*.cpp")
    list(APPEND sources ${entries})
    set(in_rooms ${sources})
    list(FILTER in_rooms INCLUDE REGEX "/src/${name}/${folder}/.+/[^/]+\\.cpp$")
    list(APPEND entries ${in_rooms})
    list(SORT entries COMPARE FILE_BASENAME)
    generate_registry(${name} ${folder} ${type} ${entries})
  endforeach()
  list(FILTER sources EXCLUDE REGEX "/main\\.cpp$")
  add_library(heatsoak_${name} STATIC ${sources})
  target_include_directories(heatsoak_${name} PUBLIC "${PROJECT_SOURCE_DIR}/src" "${PROJECT_BINARY_DIR}/generated")
  target_link_libraries(heatsoak_${name} PUBLIC ${links} PRIVATE heatsoak_settings ${LAYER_HIDES})
  use_headers(heatsoak_${name} heatsoak_headers)
  set_property(GLOBAL APPEND PROPERTY heatsoak_layers ${name})
  set_property(GLOBAL PROPERTY heatsoak_layer_${name}_uses "${below}")
endfunction()

# A library of the embedded core: freestanding, without exceptions and run-time types, and with the same arithmetic on every
# machine. -fno-math-errno turns a square root into one instruction instead of a call that may set errno.
set(HEATSOAK_CORE_OPTIONS -ffreestanding -fno-exceptions -fno-rtti -fno-math-errno -ffp-contract=off -Wdouble-promotion)

function(add_core name)
  file(GLOB sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/${name}/*.cpp" "${PROJECT_SOURCE_DIR}/${name}/*.h")
  add_library(heatsoak_${name} STATIC ${sources})
  target_include_directories(heatsoak_${name} PUBLIC "${PROJECT_SOURCE_DIR}")
  target_compile_options(heatsoak_${name} PRIVATE ${HEATSOAK_CORE_OPTIONS})
  # No unity build, as on the controller: some files choose their own optimisation.
  set_target_properties(heatsoak_${name} PROPERTIES UNITY_BUILD OFF)
  target_link_libraries(heatsoak_${name} PRIVATE heatsoak_settings)
  set_property(GLOBAL APPEND PROPERTY heatsoak_layers ${name})
endfunction()

function(generate_registry layer folder type)
  set(functions "")
  set(rows "")
  list(LENGTH ARGN count)
  foreach(entry IN LISTS ARGN)
    get_filename_component(stem "${entry}" NAME_WE)
    string(APPEND functions "${type} ${stem}();\n")
    string(APPEND rows "    {\"${stem}\", &${stem}},\n")
  endforeach()
  file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/generated/${layer}/${folder}_registry.h" @ONLY CONTENT
"// Generated from the files of src/@layer@/@folder@.
#pragma once
#include <array>
#include <string_view>
namespace heatsoak::@layer@::@folder@ {
@functions@
struct Entry {
  std::string_view name;
  @type@ (*make)();
};
inline constexpr std::array<Entry, @count@> registry{{
@rows@}};
}  // namespace heatsoak::@layer@::@folder@
")
endfunction()

# add_messages(name file.proto): protobuf messages as a separate library without the warning flags of hand-written code. A layer
# that lists it under HIDES includes "<file>.pb.h".
function(add_messages name file)
  get_filename_component(folder "${PROJECT_SOURCE_DIR}/${file}" DIRECTORY)
  get_filename_component(stem "${file}" NAME_WE)
  set(out "${PROJECT_BINARY_DIR}/generated/messages")
  file(MAKE_DIRECTORY "${out}")
  add_custom_command(
    OUTPUT "${out}/${stem}.pb.cc" "${out}/${stem}.pb.h"
    COMMAND protobuf::protoc "--cpp_out=${out}" "--proto_path=${folder}" "${folder}/${stem}.proto"
    DEPENDS "${PROJECT_SOURCE_DIR}/${file}" protobuf::protoc VERBATIM)
  add_library(${name} STATIC "${out}/${stem}.pb.cc" "${out}/${stem}.pb.h")
  target_include_directories(${name} SYSTEM PUBLIC "${out}")
  target_link_libraries(${name} PUBLIC protobuf::libprotobuf-lite)
  set_target_properties(${name} PROPERTIES CXX_CLANG_TIDY "")
endfunction()

function(add_program name)
  add_executable(${name} "${PROJECT_SOURCE_DIR}/src/${ARGV1}/main.cpp")
  target_link_libraries(${name} PRIVATE heatsoak_settings heatsoak_${ARGV1})
endfunction()

function(add_plugin name folder)
  cmake_parse_arguments(PLUGIN "" "" "USES;HIDES" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/${folder}/*.cpp" "${PROJECT_SOURCE_DIR}/${folder}/*.h")
  list(TRANSFORM PLUGIN_USES PREPEND heatsoak_)
  add_library(${name} MODULE ${sources})
  target_include_directories(${name} PRIVATE "${PROJECT_SOURCE_DIR}/src")
  target_link_libraries(${name} PRIVATE heatsoak_settings ${PLUGIN_USES} ${PLUGIN_HIDES})
  set_target_properties(${name} PROPERTIES PREFIX "")
endfunction()
