# What hosts compare before they work together. Compiler, flags and libraries are known when CMake runs; the sources are
# hashed whenever one of them changed, so an edited tree never keeps its old name.
include(build_sources.cmake)

# Flags that decide about bits, as they are given to every file; not what warns or what debuggers read.
get_directory_property(flags COMPILE_OPTIONS)
string(TOUPPER "${CMAKE_BUILD_TYPE}" config)
set(flags "${flags} ${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${config}}")
string(REGEX REPLACE "(^|[ ;])-(W|g|f(diagnostics|file-prefix-map|debug))[^ ;]*" " " flags "${flags}")
string(REGEX REPLACE "[ ;]+" " " flags "${flags}")
# Decoders that give what a texture or a mesh is; libm is asked for its answers (core/run/assembly/fingerprint.hpp).
string(SHA256 LIGHTNET_FLAGS_HASH "${flags}, OpenEXR ${OpenEXR_VERSION}, JPEG ${libjpeg_VERSION}, PNG ${PNG_VERSION_STRING}, TIFF ${TIFF_VERSION_STRING}, WebP ${webp_libwebp_VERSION}, GIF ${GIF_VERSION}, draco ${draco_VERSION}, meshoptimizer ${meshoptimizer_VERSION}, ${OPENSUBDIV_VERSION}")
string(SUBSTRING "${LIGHTNET_FLAGS_HASH}" 0 6 LIGHTNET_FLAGS_HASH)
set(LIGHTNET_EMBREE_VERSION "${embree_VERSION}")

set(LIGHTNET_SOURCES_HASH @LIGHTNET_SOURCES_HASH@)   # stays to be filled in
configure_file(build_info.cpp.in build_info.in @ONLY)
lightnet_answering_sources("${PROJECT_SOURCE_DIR}" answering CONFIGURE_DEPENDS)
set(list_of_nodes "${PROJECT_BINARY_DIR}/nodes/standard_nodes.cpp")
add_custom_command(OUTPUT build_info.cpp
  COMMAND "${CMAKE_COMMAND}" -D "ROOT=${PROJECT_SOURCE_DIR}" -D "MORE=${list_of_nodes}"
    -D "TEMPLATE=${CMAKE_CURRENT_BINARY_DIR}/build_info.in" -D "OUTPUT=${CMAKE_CURRENT_BINARY_DIR}/build_info.cpp"
    -P "${CMAKE_CURRENT_SOURCE_DIR}/build_sources.cmake"
  DEPENDS ${answering} "${list_of_nodes}" "${CMAKE_CURRENT_BINARY_DIR}/build_info.in" build_sources.cmake
  COMMENT "Naming this build" VERBATIM)
