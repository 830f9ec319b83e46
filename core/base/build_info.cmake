# A hash over what computes answers. Taken when CMake runs, so an edited tree that was not configured again keeps its
# old one: good enough to tell installations apart, and it costs nothing per build.
file(GLOB_RECURSE sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/core/*.?pp" "${PROJECT_SOURCE_DIR}/nodes/*.cpp"
     "${PROJECT_SOURCE_DIR}/transport/*.?pp")
set(hashes "")
foreach(source IN LISTS sources)
  file(SHA256 "${source}" hash)
  string(APPEND hashes "${hash}")
endforeach()
string(SHA256 LIGHTNET_SOURCES_HASH "${hashes}")
string(SUBSTRING "${LIGHTNET_SOURCES_HASH}" 0 12 LIGHTNET_SOURCES_HASH)
configure_file(build_info.cpp.in build_info.cpp @ONLY)
