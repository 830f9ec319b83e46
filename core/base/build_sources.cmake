# Which sources decide what a place answers, or what it says to others: all that hosts of one run must have in common.
# Launchers and graph scripts (tools/, lua/) are not among them: what they make of a user's words is sent to the hosts.

# lightnet_answering_sources(ROOT OUT [CONFIGURE_DEPENDS])
function(lightnet_answering_sources root out)
  set(patterns)
  foreach(room IN ITEMS core nodes transport)
    list(APPEND patterns "${root}/${room}/*.cpp" "${root}/${room}/*.hpp")
  endforeach()
  file(GLOB_RECURSE files ${ARGN} ${patterns})
  set(${out} "${files}" PARENT_SCOPE)
endfunction()

# As a script: cmake -D ROOT=... -D MORE=a;b -D TEMPLATE=... -D OUTPUT=... -P build_sources.cmake writes OUTPUT, where the
# hash over names and contents of these sources, and of MORE, stands for @LIGHTNET_SOURCES_HASH@.
if(CMAKE_SCRIPT_MODE_FILE AND CMAKE_SCRIPT_MODE_FILE STREQUAL CMAKE_CURRENT_LIST_FILE)
  cmake_minimum_required(VERSION 3.25)
  lightnet_answering_sources("${ROOT}" sources)
  set(hashes "")
  foreach(source IN LISTS sources MORE)
    file(SHA256 "${source}" hash)
    cmake_path(GET source FILENAME name)
    if(source IN_LIST sources)
      cmake_path(RELATIVE_PATH source BASE_DIRECTORY "${ROOT}" OUTPUT_VARIABLE name)
    endif()
    string(APPEND hashes "${name} ${hash}\n")
  endforeach()
  string(SHA256 LIGHTNET_SOURCES_HASH "${hashes}")
  string(SUBSTRING "${LIGHTNET_SOURCES_HASH}" 0 12 LIGHTNET_SOURCES_HASH)
  configure_file("${TEMPLATE}" "${OUTPUT}" @ONLY)
endif()
