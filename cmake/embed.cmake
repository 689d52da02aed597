# embed_texts(name FILES file…): a static library <name> that holds the text of the files as they are at build time, and its
# header <embedded/name.h>:
#
#   namespace heatsoak::embedded {
#   struct Text { std::string_view path; std::string_view text; };   // path from the project's folder; in the order of FILES
#   std::span<const Text> name();
#   }
#
# FILES are paths in the project. Callers that glob them use CONFIGURE_DEPENDS. A layer lists <name> under HIDES.
set(HEATSOAK_EMBED_SCRIPT "${CMAKE_CURRENT_LIST_DIR}/embed_script.cmake")

function(embed_texts name)
  cmake_parse_arguments(EMBED "" "" "FILES" ${ARGN})
  set(folder "${PROJECT_BINARY_DIR}/generated/embedded")
  set(absolute "")
  foreach(file IN LISTS EMBED_FILES)
    get_filename_component(path "${file}" ABSOLUTE BASE_DIR "${PROJECT_SOURCE_DIR}")
    list(APPEND absolute "${path}")
  endforeach()
  file(CONFIGURE OUTPUT "${folder}/${name}.h" @ONLY CONTENT
"// Generated: texts of the project that the program carries with it.
#pragma once
#include <span>
#include <string_view>
namespace heatsoak::embedded {
#ifndef HEATSOAK_EMBEDDED_TEXT
#define HEATSOAK_EMBEDDED_TEXT
struct Text {
  std::string_view path;
  std::string_view text;
};
#endif
std::span<const Text> @name@();
}  // namespace heatsoak::embedded
")
  string(REPLACE ";" "|" listed "${absolute}")
  add_custom_command(
    OUTPUT "${folder}/${name}.cpp"
    COMMAND "${CMAKE_COMMAND}" "-DNAME=${name}" "-DFILES=${listed}" "-DROOT=${PROJECT_SOURCE_DIR}" "-DOUT=${folder}/${name}.cpp"
            -P "${HEATSOAK_EMBED_SCRIPT}"
    DEPENDS ${absolute} "${HEATSOAK_EMBED_SCRIPT}" COMMENT "Embedding texts of ${name}" VERBATIM)
  add_library(${name} STATIC "${folder}/${name}.cpp")
  target_include_directories(${name} PUBLIC "${PROJECT_BINARY_DIR}/generated")
  target_link_libraries(${name} PRIVATE heatsoak_settings)
  set_target_properties(${name} PROPERTIES CXX_CLANG_TIDY "")
endfunction()
