#include "tests/support/packed_meshes.hpp"

#include <draco/compression/encode.h>
#include <meshoptimizer.h>

#include <vector>

namespace lightnet::test {
namespace {

std::string fragment(const std::string& name, std::size_t value) {
    return ",\"" + name + "\":" + std::to_string(value);
}

void add_points(draco::Mesh& mesh, std::uint32_t points) {
    draco::GeometryAttribute position, colour;
    position.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false, 12, 0);
    colour.Init(draco::GeometryAttribute::COLOR, nullptr, 4, draco::DT_UINT8, true, 4, 0);
    const int positions = mesh.AddAttribute(position, true, points), colours = mesh.AddAttribute(colour, true, points);
    for (std::uint32_t i = 0; i < points; ++i) {
        const float p[]{float(i / 2), float(i % 2), 0};
        const std::uint8_t c[]{255, std::uint8_t(i % 2 ? 255 : 0), 0, 255};
        mesh.attribute(positions)->SetAttributeValue(draco::AttributeValueIndex(i), p);
        mesh.attribute(colours)->SetAttributeValue(draco::AttributeValueIndex(i), c);
    }
}

}  // namespace

std::string packed_by_draco(std::uint32_t quads, bool by_edges) {
    draco::Mesh mesh;
    mesh.set_num_points(2 * quads + 2);
    add_points(mesh, 2 * quads + 2);
    for (std::uint32_t i = 0; i < quads; ++i) {
        const auto at = [&](std::uint32_t k) { return draco::PointIndex(2 * i + k); };
        mesh.AddFace({at(0), at(2), at(1)});
        mesh.AddFace({at(1), at(2), at(3)});
    }
    draco::Encoder encoder;
    encoder.SetEncodingMethod(by_edges ? draco::MESH_EDGEBREAKER_ENCODING : draco::MESH_SEQUENTIAL_ENCODING);
    draco::EncoderBuffer buffer;
    if (!encoder.EncodeMeshToBuffer(mesh, &buffer).ok()) return "";
    return {buffer.data(), buffer.size()};
}

std::string PackedView::json(std::size_t at, const std::string& more) const {
    return R"({"buffer":1)" + fragment("byteLength", stride * count) +
           R"(,"extensions":{"EXT_meshopt_compression":{"buffer":0)" + fragment("byteOffset", at) +
           fragment("byteLength", bytes.size()) + fragment("byteStride", stride) + fragment("count", count) +
           R"(,"mode":")" + mode + "\"" + more + "}}}";
}

PackedView packed_corners() {
    const std::vector<float> corners{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
    std::string bytes(meshopt_encodeVertexBufferBound(4, 12), '\0');
    bytes.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(bytes.data()), bytes.size(),
                                            corners.data(), 4, 12));
    return {bytes, "ATTRIBUTES", 12, 4};
}

PackedView packed_order() {
    const std::vector<std::uint16_t> order{0, 1, 2, 2, 1, 3};
    std::string bytes(meshopt_encodeIndexBufferBound(6, 4), '\0');
    bytes.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(bytes.data()), bytes.size(), order.data(),
                                           order.size()));
    return {bytes, "TRIANGLES", 2, 6};
}

}  // namespace lightnet::test
