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
bool same(const T* a, const T* b, std::size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    return count == 0 || std::memcmp(a, b, count * sizeof(T)) == 0;
}
template <class T>
bool same(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && same(a.data(), b.data(), a.size());
}
template <class T>
bool same(const T& a, const T& b) {
    return same(&a, &b, 1);
}

bool alike(const Mesh& built, const Mesh& wanted) {
    const auto more = built.positions.size() - wanted.positions.size();
    return more <= 1 && same(built.positions.data(), wanted.positions.data(), wanted.positions.size()) &&
           same(built.triangles, wanted.triangles) && built.flip_normals == wanted.flip_normals;
}
bool alike(const Sphere& built, const Sphere& wanted) { return same(built, wanted); }
bool alike(const Quadric& built, const Quadric& wanted) { return same(built, wanted); }
bool alike(const Curves& built, const Curves& wanted) {
    return built.basis == wanted.basis && same(built.points, wanted.points) && same(built.segments, wanted.segments) &&
           same(built.strands, wanted.strands);
}

bool alike(const ShapeGeometry& built, const ShapeGeometry& wanted) {
    if (built.index() != wanted.index()) return false;
    return std::visit([&]<class S>(const S& one) { return alike(one, std::get<S>(wanted)); }, built);
}

bool has_surface(const SceneData& scene, const Shape& shape) {
    return !std::holds_alternative<NoMaterial>(scene.materials[shape.material].model);
}

bool is_plain(const SceneData& scene) {
    return scene.motion.empty() &&
           std::ranges::none_of(scene.materials, [](const Material& material) { return material.opacity.has_value(); });
}

}  // namespace

bool have_same_shapes(const SceneData& built, const SceneData& wanted) {
    if (!is_plain(built) || !is_plain(wanted)) return false;
    return std::ranges::equal(built.objects, wanted.objects, {}, &Object::shapes, &Object::shapes) &&
           std::ranges::equal(built.instances, wanted.instances,
                              [](const Instance& a, const Instance& b) {
                                  return a.object == b.object && same(a.to_world, b.to_world);
                              }) &&
           std::ranges::equal(built.shapes, wanted.shapes, [&](const Shape& a, const Shape& b) {
               return has_surface(built, a) == has_surface(wanted, b) && alike(a.geometry, b.geometry);
           });
}

}  // namespace lightnet
