# How every target of the project is built.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/bin")
set(CMAKE_VERIFY_INTERFACE_HEADER_SETS ON)

# Same bytes everywhere: no fused multiply-add behind our back, no fast-math, one instruction set. Nobody asks for errno or
# for the flags of exceptions: without these a root is one instruction, and loops become vectors, with the same bits.
# DECISIONS: instruction-set
add_compile_options(-ffp-contract=off -fno-math-errno -fno-trapping-math -march=${LIGHTNET_ARCH})
# Else how fast a short loop is would depend on where the linker happens to put it: differently in each program.
# DECISIONS: aligned-functions
add_compile_options($<$<CONFIG:Release>:-falign-functions=64>)

# Warnings are each target's own business; -Werror comes from the dev preset.
add_library(lightnet_warnings INTERFACE)
target_compile_options(lightnet_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual -Wimplicit-fallthrough
  # g++ takes the files that a compilation of several includes for headers, and warns of classes in them that use types
  # of a nameless namespace.
  "$<$<AND:$<BOOL:${LIGHTNET_UNITY}>,$<CXX_COMPILER_ID:GNU>>:-Wno-subobject-linkage>"
  # g++ 12 to 14 warn of copies and lists of std::string that are sound (its bug 105651 is one), when it optimises. Debug
  # builds keep both.
  "$<$<AND:$<CONFIG:Release,RelWithDebInfo>,$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,15>>:-Wno-restrict;-Wno-maybe-uninitialized>"
  # g++ 13 and 14 warn of copies of std::vector that are sound.
  "$<$<AND:$<CONFIG:Release,RelWithDebInfo>,$<CXX_COMPILER_ID:GNU>,$<VERSION_GREATER_EQUAL:$<CXX_COMPILER_VERSION>,13>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,15>>:-Wno-array-bounds>")

# For what is run seldom: less time to build. Quickest, a fifth less than quick, is for what waits for people, disks and
# tests. At -O1 and below g++ is wrong about its strings in more ways.
foreach(level IN ITEMS quick:-O1 quickest:-Og)
  string(REPLACE ":" ";" level "${level}")
  list(POP_FRONT level name)
  add_library(lightnet_${name}_build INTERFACE)
  target_compile_options(lightnet_${name}_build INTERFACE $<$<CONFIG:Release>:${level}>
    "$<$<AND:$<CONFIG:Release,RelWithDebInfo>,$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,15>>:-Wno-array-bounds;-Wno-stringop-overflow>")
endforeach()

# With a sanitizer (presets asan, tsan) every program knows how it is to behave, wherever it is started from.
if(CMAKE_CXX_FLAGS MATCHES "-fsanitize=")
  # clang has other words for what it checks.
  foreach(checks ADDRESS THREAD)
    string(TOLOWER "${checks}" name)
    if(CMAKE_CXX_COMPILER_ID MATCHES "Clang" AND CMAKE_CXX_FLAGS MATCHES "-fsanitize=[a-z,]*${name}")
      add_compile_definitions(__SANITIZE_${checks}__=1)
    endif()
  endforeach()
  add_library(sanitizer_options OBJECT "${PROJECT_SOURCE_DIR}/tests/support/sanitizer_options.cpp")
  target_compile_definitions(sanitizer_options PRIVATE
    LIGHTNET_TSAN_SUPPRESSIONS="${PROJECT_SOURCE_DIR}/tests/tsan.supp")
  link_libraries("$<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>:$<TARGET_OBJECTS:sanitizer_options>>")
endif()

# lightnet_together(TARGET): files of one folder are compiled as one, which takes half the time: what they include is read
# once, and what they use of templates made once. So names in one folder's nameless namespaces differ.
function(lightnet_together name)
  if(NOT LIGHTNET_UNITY)
    return()
  endif()
  get_target_property(sources ${name} SOURCES)
  get_target_property(base ${name} SOURCE_DIR)
  foreach(source IN LISTS sources)
    cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY "${base}" NORMALIZE)
    cmake_path(GET source PARENT_PATH folder)
    cmake_path(RELATIVE_PATH folder BASE_DIRECTORY "${PROJECT_SOURCE_DIR}")
    string(MAKE_C_IDENTIFIER "${folder}" group)
    get_target_property(unit ${name} "LIGHTNET_UNIT_OF_${group}")
    if(unit)
      set(group "${unit}")
    endif()
    set_property(SOURCE "${source}" TARGET_DIRECTORY ${name} PROPERTY UNITY_GROUP "${group}")
  endforeach()
  set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()

# lightnet_one_unit(TARGET folders...): small ones, which include the same, are compiled as one. ".": the files beside them.
function(lightnet_one_unit name)
  cmake_path(RELATIVE_PATH CMAKE_CURRENT_SOURCE_DIR BASE_DIRECTORY "${PROJECT_SOURCE_DIR}" OUTPUT_VARIABLE here)
  foreach(folder IN LISTS ARGN)
    set(path "${here}/${folder}")
    if(folder STREQUAL ".")
      set(path "${here}")
    endif()
    string(MAKE_C_IDENTIFIER "${path}" group)
    list(JOIN ARGN "_" unit)
    string(MAKE_C_IDENTIFIER "${unit}" unit)
    set_target_properties(lightnet_${name} PROPERTIES "LIGHTNET_UNIT_OF_${group}" "unit_${unit}")
  endforeach()
endfunction()

# lightnet_library(NAME sources... HEADERS ... NEEDS libraries-in-our-headers HIDES libraries-inside-our-cpp-files)
function(lightnet_library name)
  cmake_parse_arguments(PARSE_ARGV 1 LIB "" "" "HEADERS;NEEDS;HIDES")
  add_library(lightnet_${name} STATIC ${LIB_UNPARSED_ARGUMENTS})
  add_library(lightnet::${name} ALIAS lightnet_${name})
  target_sources(lightnet_${name} PUBLIC FILE_SET HEADERS BASE_DIRS "${PROJECT_SOURCE_DIR}" FILES ${LIB_HEADERS})
  target_link_libraries(lightnet_${name} PUBLIC ${LIB_NEEDS} PRIVATE ${LIB_HIDES} lightnet_warnings)
  # When the rooms inside have added their files.
  cmake_language(EVAL CODE "cmake_language(DEFER DIRECTORY [[${PROJECT_SOURCE_DIR}]] CALL lightnet_together lightnet_${name})")
endfunction()

# lightnet_links_alone(NAME): the linker, too, holds that a library needs nothing but what it names.
function(lightnet_links_alone name)
  add_executable(${name}_alone "${PROJECT_SOURCE_DIR}/tests/architecture/alone.cpp")
  target_link_libraries(${name}_alone PRIVATE "$<LINK_LIBRARY:WHOLE_ARCHIVE,lightnet_${name}>" lightnet_warnings)
endfunction()
