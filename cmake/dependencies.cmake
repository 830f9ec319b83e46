# What lightnet stands on. Each library has one home; only that folder's .cpp files include it.
find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
pkg_check_modules(jemalloc REQUIRED IMPORTED_TARGET jemalloc)   # memory in large pages (programs)
find_package(embree 4 QUIET)                               # rays against triangles and spheres (core/scene)
if(NOT embree_FOUND)
  find_package(embree 3 REQUIRED)
endif()
add_library(embree_any INTERFACE)                          # either, with the face of 4: <embree/rtcore.h>
target_link_libraries(embree_any INTERFACE embree)
target_include_directories(embree_any SYSTEM INTERFACE "${CMAKE_CURRENT_LIST_DIR}/include")
target_compile_definitions(embree_any INTERFACE LIGHTNET_EMBREE=${embree_VERSION_MAJOR})
find_package(OpenEXR 3 CONFIG REQUIRED)                    # pictures out (core/film), textures in (core/readers)
pkg_check_modules(ocio REQUIRED IMPORTED_TARGET OpenColorIO>=2.1)   # how pictures are shown (core/film)
find_package(PNG REQUIRED)                                 # pictures out, textures in
find_package(ZLIB REQUIRED)                                # packed scene files
find_package(JPEG REQUIRED)                                # textures in
find_package(TIFF 4.5 REQUIRED)                            # textures in
find_package(GIF 5 REQUIRED)                               # textures in
pkg_check_modules(webp REQUIRED IMPORTED_TARGET libwebp libwebpdemux)   # textures in
pkg_check_modules(zstd REQUIRED IMPORTED_TARGET libzstd)   # packed textures in
pkg_check_modules(blosc REQUIRED IMPORTED_TARGET blosc)   # packed grids (core/readers/files)
pkg_check_modules(libjpeg QUIET libjpeg)                   # its full version: decoders differ in bits
pkg_check_modules(draco REQUIRED IMPORTED_TARGET draco)     # packed meshes (core/readers/gltf)
find_package(meshoptimizer 0.18 REQUIRED CONFIG)           # the same, by another packer
find_path(OPENSUBDIV_INCLUDE_DIR opensubdiv/version.h REQUIRED)   # smooth surfaces of cages (core/readers/common)
find_library(OPENSUBDIV_LIBRARY osdCPU REQUIRED)           # its config file names static libraries that no package has
file(STRINGS "${OPENSUBDIV_INCLUDE_DIR}/opensubdiv/version.h" OPENSUBDIV_VERSION REGEX "define OPENSUBDIV_VERSION_NUMBER")
add_library(opensubdiv INTERFACE)
target_link_libraries(opensubdiv INTERFACE "${OPENSUBDIV_LIBRARY}")
target_include_directories(opensubdiv SYSTEM INTERFACE "${OPENSUBDIV_INCLUDE_DIR}")
find_package(pugixml REQUIRED)                             # scenes in XML (core/readers/mitsuba)
find_package(Boost 1.74 REQUIRED COMPONENTS context)       # fibers (core/fiber); Beast: HTTP (tools/watch)
find_package(Eigen3 3.4 REQUIRED CONFIG)                # least squares (core/film)
find_package(fmt REQUIRED)                                 # text: g++ 12 has no std::format
find_package(nlohmann_json REQUIRED)                       # how texts and numbers are written and read in JSON (core/base)
find_package(CLI11 REQUIRED)                               # command lines (tools)
find_package(cppzmq REQUIRED)                              # sockets (transport)
pkg_check_modules(crypto REQUIRED IMPORTED_TARGET libcrypto)   # SHA-256 content hashes (core)
pkg_check_modules(sodium REQUIRED IMPORTED_TARGET libsodium)   # keys (transport/keys)
pkg_check_modules(lua REQUIRED IMPORTED_TARGET lua5.4-c++)     # the build of Lua whose errors are C++ exceptions

# <lua_any.hpp> includes it as its names want it.
include(CheckCXXSourceCompiles)
set(CMAKE_REQUIRED_LIBRARIES PkgConfig::lua)
check_cxx_source_compiles("#include <lua.hpp>
int main() { lua_close(nullptr); }" LIGHTNET_LUA_NAMES_OF_C)
unset(CMAKE_REQUIRED_LIBRARIES)
add_library(lua_any INTERFACE)
target_link_libraries(lua_any INTERFACE PkgConfig::lua)
target_include_directories(lua_any SYSTEM INTERFACE "${CMAKE_CURRENT_LIST_DIR}/include")
target_compile_definitions(lua_any INTERFACE LIGHTNET_LUA_NAMES_OF_C=$<BOOL:${LIGHTNET_LUA_NAMES_OF_C}>)

# msgpack-cxx installs a config file under a name of its own; an interface target is surer.
find_path(MSGPACK_INCLUDE_DIR msgpack.hpp REQUIRED)
add_library(msgpack_headers INTERFACE)
target_include_directories(msgpack_headers SYSTEM INTERFACE "${MSGPACK_INCLUDE_DIR}")
target_compile_definitions(msgpack_headers INTERFACE MSGPACK_NO_BOOST MSGPACK_DEFAULT_API_VERSION=3)

if(LIGHTNET_BUILD_TESTS)
  find_package(GTest REQUIRED)
endif()
if(LIGHTNET_BUILD_BENCHMARKS)
  find_package(benchmark REQUIRED)
endif()
