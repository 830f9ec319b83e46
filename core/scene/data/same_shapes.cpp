#include "core/scene/data/same_shapes.hpp"

#include <algorithm>
#include <cstring>
#include <type_traits>
#include <variant>
#include <vector>

namespace lightnet {
namespace {

// Bit by bit, as trees are made of bits. Padding within elements could at most tell apart what is alike.
template <class T>
bool same_bits(const T* a, const T* b, std::size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    return count == 0 || std::memcmp(a, b, count * sizeof(T)) == 0;
}
template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && same_bits(a.data(), b.data(), a.size());
}
template <class T>
bool same_bits(const T& a, const T& b) {
    return same_bits(&a, &b, 1);
}

bool stands_as(const Mesh& built, const Mesh& wanted) {
    const auto more = built.positions.size() - wanted.positions.size();
    return more <= 1 && same_bits(built.positions.data(), wanted.positions.data(), wanted.positions.size()) &&
           same_bits(built.triangles, wanted.triangles) && built.flip_normals == wanted.flip_normals;
}
bool stands_as(const Sphere& built, const Sphere& wanted) { return same_bits(built, wanted); }
bool stands_as(const Quadric& built, const Quadric& wanted) { return same_bits(built, wanted); }
bool stands_as(const Curves& built, const Curves& wanted) {
    return built.basis == wanted.basis && same_bits(built.points, wanted.points) &&
           same_bits(built.segments, wanted.segments) && same_bits(built.strands, wanted.strands);
}

bool stands_as(const ShapeGeometry& built, const ShapeGeometry& wanted) {
    if (built.index() != wanted.index()) return false;
    return std::visit([&]<class S>(const S& one) { return stands_as(one, std::get<S>(wanted)); }, built);
}

bool has_surface(const SceneData& scene, const Shape& shape) {
    return !std::holds_alternative<NoMaterial>(scene.materials[shape.material].model);
}

bool has_plain_shapes(const SceneData& scene) {
    return scene.motion.empty() &&
           std::ranges::none_of(scene.materials, [](const Material& material) { return material.opacity.has_value(); });
}

}  // namespace

std::vector<std::size_t> vertices_of(const SceneData& data) {
    std::vector<std::size_t> vertices;
    for (const Shape& shape : data.shapes) {
        const auto* mesh = std::get_if<Mesh>(&shape.geometry);
        vertices.push_back(mesh ? mesh->positions.size() : 0);
    }
    return vertices;
}

SceneData with_vertices(SceneData data, const std::vector<std::size_t>& vertices) {
    for (std::size_t i = 0; i < vertices.size(); ++i)
        if (auto* mesh = std::get_if<Mesh>(&data.shapes[i].geometry)) mesh->positions.resize(vertices[i]);
    return data;
}

void pad_positions(SceneData& data) {
    for (Shape& shape : data.shapes)
        if (auto* mesh = std::get_if<Mesh>(&shape.geometry)) {
            mesh->positions.reserve(mesh->positions.size() + 1);
            mesh->positions.emplace_back();
        }
}

bool have_same_shapes(const SceneData& built, const SceneData& wanted) {
    if (!has_plain_shapes(built) || !has_plain_shapes(wanted)) return false;
    return std::ranges::equal(built.objects, wanted.objects, {}, &Object::shapes, &Object::shapes) &&
           std::ranges::equal(built.instances, wanted.instances,
                              [](const Instance& a, const Instance& b) {
                                  return a.object == b.object && same_bits(a.to_world, b.to_world);
                              }) &&
           std::ranges::equal(built.shapes, wanted.shapes, [&](const Shape& a, const Shape& b) {
               return has_surface(built, a) == has_surface(wanted, b) && stands_as(a.geometry, b.geometry);
           });
}

}  // namespace lightnet
