#include "core/base/error.hpp"
#include "core/readers/ply/mesh.hpp"
#include "tests/fuzz/targets.hpp"

namespace lightnet::fuzz {
namespace {

void read(std::span<const std::byte> bytes) {
    try {
        (void)read_ply(bytes);
    } catch (const Error&) {
    }
}

std::string binary_triangle() {
    std::string text =
        "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
    text.append(36, '\1');
    text += std::string("\3\0\0\0\0\1\0\0\0\2\0\0\0", 13);
    return text;
}

std::vector<std::string> seeds() {
    const std::string square =
        "comment a square\nelement vertex 4\nproperty float x\nproperty double y\nproperty float z\n"
        "property uchar red\nproperty float nx\nproperty float ny\nproperty float nz\nproperty float s\n"
        "property float t\nelement face 1\nproperty list uchar int vertex_indices\nproperty ushort group\nend_header\n"
        "0 0 0 255 0 0 1 0 0\n1 0 0 255 0 0 1 1 0\n1 1 0 255 0 0 1 1 1\n0 1 0 255 0 0 1 0 1\n4 0 1 2 3 7\n";
    return {"ply\nformat ascii 1.0\n" + square, binary_triangle(),
            "ply\r\nformat binary_big_endian 1.0\nelement vertex 0\nproperty float x\nend_header\n"};
}

}  // namespace

Target meshes() { return {"meshes", read, seeds}; }

}  // namespace lightnet::fuzz
