# As a script: cmake -D ROOT=... -D HEADERS=a;b -D OUTPUT=... -P interface_hash.cmake writes the header whose hash names all
# that a node outside the tree is compiled against.
set(hashes "")
foreach(header IN LISTS HEADERS)
  file(SHA256 "${header}" hash)
  cmake_path(RELATIVE_PATH header BASE_DIRECTORY "${ROOT}")
  string(APPEND hashes "${header} ${hash}\n")
endforeach()
string(SHA256 hash "${hashes}")
string(SUBSTRING "${hash}" 0 12 hash)
file(CONFIGURE OUTPUT "${OUTPUT}" CONTENT [[
// Written by CMake from the headers that a node sees.
#pragma once

namespace lightnet {

// One for each library that is compiled with it: were it shared, the program would find its own in every plugin.
constexpr char interface_hash[] = "@hash@";

}  // namespace lightnet
]] @ONLY)
