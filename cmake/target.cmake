# The drive core for its controller, a Cortex-M7 with a single-precision FPU, and programs that QEMU runs with it. If the cross
# compiler or QEMU is missing, the rest builds as usual and the tests on the target are skipped.
find_program(HEATSOAK_TARGET_COMPILER arm-none-eabi-g++)
find_program(HEATSOAK_TARGET_ARCHIVER arm-none-eabi-ar)
find_program(HEATSOAK_EMULATOR qemu-system-arm)

# Empty, or the package to install before the target can be built or emulated.
set(HEATSOAK_TARGET_MISSING "")
if(NOT HEATSOAK_TARGET_COMPILER OR NOT HEATSOAK_TARGET_ARCHIVER)
  set(HEATSOAK_TARGET_MISSING "arm-none-eabi-g++ is not installed")
else()
  # Debian's compiler lacks <limits>; the package libstdc++-arm-none-eabi-dev has it.
  execute_process(COMMAND "${HEATSOAK_TARGET_COMPILER}" -mcpu=cortex-m7 -mfloat-abi=hard -mfpu=fpv5-sp-d16 -ffreestanding -include limits
                          -include cstdint -include cstddef -x c++ -fsyntax-only /dev/null
                  RESULT_VARIABLE result OUTPUT_QUIET ERROR_QUIET)
  if(NOT result EQUAL 0)
    set(HEATSOAK_TARGET_MISSING "the headers <cstddef>, <cstdint> and <limits> for arm-none-eabi-g++ are not installed")
  endif()
endif()
if(HEATSOAK_TARGET_MISSING)
  message(STATUS "No drive core for the target: ${HEATSOAK_TARGET_MISSING}")
elseif(NOT HEATSOAK_EMULATOR)
  message(STATUS "The drive core for the target is built but not run: qemu-system-arm is not installed")
endif()

set(HEATSOAK_TARGET_PROCESSOR -mcpu=cortex-m7 -mthumb -mfpu=fpv5-sp-d16 -mfloat-abi=hard)
# In source order GCC needs fewer registers and can load two words with one instruction: 1.5 % fewer instructions per step.
set(HEATSOAK_TARGET_OPTIONS ${HEATSOAK_TARGET_PROCESSOR} -std=c++${CMAKE_CXX_STANDARD} -O2 -fno-schedule-insns ${HEATSOAK_CORE_OPTIONS}
    -Wall -Wextra -Werror -ffunction-sections -fdata-sections -fstack-usage -fcallgraph-info=su -DROBOT_CORE_WITHOUT_DOUBLE)
set(HEATSOAK_TARGET_FOLDER "${PROJECT_BINARY_DIR}/target")

# compile_for_target(out name …): compiles the files into <build>/target/<name> and sets <out> to the objects. Beside every object
# GCC writes the stack size of each function (.su) and the call graph (.ci).
function(compile_for_target out name)
  cmake_parse_arguments(PARSE_ARGV 2 COMPILE "" "" "SOURCES;FOLDERS;DEPENDS")
  list(TRANSFORM COMPILE_FOLDERS PREPEND "-I")
  set(objects "")
  foreach(source IN LISTS COMPILE_SOURCES)
    get_filename_component(stem "${source}" NAME_WE)
    set(object "${HEATSOAK_TARGET_FOLDER}/${name}/${stem}.o")
    # The compiler cache is bypassed because it does not keep .ci files.
    add_custom_command(
      OUTPUT "${object}"
      COMMAND "${CMAKE_COMMAND}" -E make_directory "${HEATSOAK_TARGET_FOLDER}/${name}"
      COMMAND "${HEATSOAK_TARGET_COMPILER}" ${HEATSOAK_TARGET_OPTIONS} "-I${PROJECT_SOURCE_DIR}" ${COMPILE_FOLDERS}
              -MD -MT "${object}" -MF "${object}.d" -c "${source}" -o "${object}"
      DEPENDS "${source}" ${COMPILE_DEPENDS} DEPFILE "${object}.d" COMMENT "Building target object ${name}/${stem}.o" VERBATIM)
    list(APPEND objects "${object}")
  endforeach()
  set(${out} "${objects}" PARENT_SCOPE)
endfunction()

# add_target_core(name): lib<name>_m7.a in <build>/lib from <name>/*.cpp, with the same sources as add_core uses for the host.
function(add_target_core name)
  if(HEATSOAK_TARGET_MISSING)
    return()
  endif()
  file(GLOB sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/${name}/*.cpp")
  compile_for_target(objects ${name} SOURCES ${sources})
  set(library "${PROJECT_BINARY_DIR}/lib/lib${name}_m7.a")
  add_custom_command(
    OUTPUT "${library}"
    COMMAND "${CMAKE_COMMAND}" -E make_directory "${PROJECT_BINARY_DIR}/lib"
    COMMAND "${CMAKE_COMMAND}" -E rm -f "${library}"
    COMMAND "${HEATSOAK_TARGET_ARCHIVER}" qcsD "${library}" ${objects}
    DEPENDS ${objects} COMMENT "Linking target library lib${name}_m7.a" VERBATIM)
  file(GLOB sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/${name}/port/*.cpp")
  compile_for_target(port ${name}_port SOURCES ${sources})
  # The port is built here, too, because commands of another folder find only files that a target makes.
  add_custom_target(${name}_m7 ALL DEPENDS "${library}" ${port})
  set_target_properties(${name}_m7 PROPERTIES LIBRARY_FILE "${library}" OBJECT_FILES "${objects}" PORT_FILES "${port}"
                        PORT_SCRIPT "${PROJECT_SOURCE_DIR}/${name}/port/mps2_an500.ld")
endfunction()

# add_target_image(name core SOURCES … FOLDERS … DEPENDS …): the program <build>/target/<name>.elf for the emulator.
function(add_target_image name core)
  if(HEATSOAK_TARGET_MISSING)
    return()
  endif()
  cmake_parse_arguments(IMAGE "" "" "SOURCES;FOLDERS;DEPENDS" ${ARGN})
  compile_for_target(objects ${name} SOURCES ${IMAGE_SOURCES} FOLDERS ${IMAGE_FOLDERS} DEPENDS ${IMAGE_DEPENDS})
  get_target_property(library ${core}_m7 LIBRARY_FILE)
  get_target_property(port ${core}_m7 PORT_FILES)
  get_target_property(script ${core}_m7 PORT_SCRIPT)
  set(image "${HEATSOAK_TARGET_FOLDER}/${name}.elf")
  # Links without the compiler's libraries: if the core needs anything besides the port, linking fails.
  add_custom_command(
    OUTPUT "${image}"
    COMMAND "${HEATSOAK_TARGET_COMPILER}" ${HEATSOAK_TARGET_PROCESSOR} -nostdlib "-Wl,--gc-sections,--fatal-warnings" "-T${script}"
            -o "${image}" ${objects} ${port} "${library}"
    DEPENDS ${objects} ${port} "${library}" "${script}" COMMENT "Linking target image ${name}.elf" VERBATIM)
  add_custom_target(${name} ALL DEPENDS "${image}")
  add_dependencies(${name} ${core}_m7)
  set_target_properties(${name} PROPERTIES IMAGE_FILE "${image}" OBJECT_FILES "${objects}")
endfunction()

# Passes the tools, the core's library and these images to the test program: HEATSOAK_<IMAGE> (for example the program
# planner_image) and HEATSOAK_<IMAGE>_CALL_GRAPHS (its .ci files).
function(use_target_images test core)
  target_compile_definitions(${test} PRIVATE HEATSOAK_TARGET_MISSING="${HEATSOAK_TARGET_MISSING}")
  string(REPLACE ";" " " processor "${HEATSOAK_TARGET_PROCESSOR}")
  set(emulator "${HEATSOAK_EMULATOR}")
  if(NOT HEATSOAK_EMULATOR)
    set(emulator "")
  endif()
  set(library "")
  set(graphs "")
  if(NOT HEATSOAK_TARGET_MISSING)
    add_dependencies(${test} ${core}_m7)
    get_target_property(library ${core}_m7 LIBRARY_FILE)
    get_target_property(objects ${core}_m7 OBJECT_FILES)
    get_target_property(port ${core}_m7 PORT_FILES)
    call_graphs(graphs ${objects} ${port})
  endif()
  target_compile_definitions(${test} PRIVATE
    HEATSOAK_TARGET_COMPILER="${HEATSOAK_TARGET_COMPILER}" HEATSOAK_TARGET_PROCESSOR="${processor}"
    HEATSOAK_EMULATOR="${emulator}" HEATSOAK_TARGET_LIBRARY="${library}" HEATSOAK_TARGET_CALL_GRAPHS="${graphs}")
  foreach(image IN LISTS ARGN)
    set(file "")
    set(graphs "")
    if(NOT HEATSOAK_TARGET_MISSING)
      add_dependencies(${test} ${image})
      get_target_property(file ${image} IMAGE_FILE)
      get_target_property(objects ${image} OBJECT_FILES)
      call_graphs(graphs ${objects})
    endif()
    string(TOUPPER "${image}" define)
    target_compile_definitions(${test} PRIVATE HEATSOAK_${define}="${file}" HEATSOAK_${define}_CALL_GRAPHS="${graphs}")
  endforeach()
endfunction()

# Sets <out> to the .ci files of the objects, separated by ':'.
function(call_graphs out)
  list(TRANSFORM ARGN REPLACE "\\.o$" ".ci" OUTPUT_VARIABLE files)
  string(REPLACE ";" ":" files "${files}")
  set(${out} "${files}" PARENT_SCOPE)
endfunction()
