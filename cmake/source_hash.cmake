# Writes <generated/source_hash.h> with HEATSOAK_SOURCE_HASH: the first 8 hexadecimal digits of a SHA-256 over the sources that decide numbers.
# It is part of the program's version, so that a file states by which algorithms it was written. The same sources give the same hash.
file(GLOB_RECURSE hashed CONFIGURE_DEPENDS RELATIVE "${PROJECT_SOURCE_DIR}" robot_core/*.h robot_core/*.cpp src/*.h src/*.cpp src/*.c)
list(FILTER hashed EXCLUDE REGEX "^src/(cli|present|report)/")
list(SORT hashed)
list(TRANSFORM hashed PREPEND "${PROJECT_SOURCE_DIR}/")
string(REPLACE ";" "|" listed "${hashed}")
set(HEATSOAK_SOURCE_HASH_FILE "${PROJECT_BINARY_DIR}/generated/source_hash.h")
add_custom_command(
  OUTPUT "${HEATSOAK_SOURCE_HASH_FILE}"
  COMMAND "${CMAKE_COMMAND}" "-DFILES=${listed}" "-DROOT=${PROJECT_SOURCE_DIR}" "-DOUT=${HEATSOAK_SOURCE_HASH_FILE}"
          -P "${CMAKE_CURRENT_LIST_DIR}/source_hash_script.cmake"
  DEPENDS ${hashed} "${CMAKE_CURRENT_LIST_DIR}/source_hash_script.cmake" COMMENT "Hashing the sources" VERBATIM)
