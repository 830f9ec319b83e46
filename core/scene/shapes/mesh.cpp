#include "core/scene/shapes/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lightnet {
namespace {

template <class T>
std::size_t room_of(const std::vector<T>& values) {
    return values.capacity() * sizeof(T);
}

}  // namespace

std::string Mesh::fault() const {
    const std::size_t vertices = positions.size();
    std::uint32_t last = 0;
    for (const auto& [a, b, c] : triangles) last = std::max({last, a, b, c});
    if (!triangles.empty() && last >= vertices) return "a triangle names a vertex that isn't there";
    const auto fits = [&](std::size_t count) { return count == 0 || count == vertices; };
    bool all = fits(normals.size()) && fits(uvs.size()) && fits(colours.size()) && fits(values.alphas.size()) &&
               fits(tangents.size());
    for (const auto& set : values.uvs) all = all && set.size() == vertices;
    if (!all) return "normals, texture coordinates, colours or tangents don't match the vertices";
    return "";
}

void Mesh::add_to(Box& box, const Matrix& by) const {
    for (const Vec3 vertex : positions) box.add(transform_point(by, vertex));
}

float Mesh::extent() const {
    constexpr float largest = std::numeric_limits<float>::max();
    bool all = true;
    float most = 0;
    for (const Vec3 p : positions) {
        const float x = std::fabs(p.x), y = std::fabs(p.y), z = std::fabs(p.z);
        all &= (x <= largest) & (y <= largest) & (z <= largest);
        most = std::max(most, std::max(x, std::max(y, z)));
    }
    return all ? most : std::numeric_limits<float>::infinity();
}

float Mesh::largest_piece() const {
    Box box;
    for (const Vec3 p : positions) box.add(p);
    const Vec3 side = positions.empty() ? Vec3{} : box.size();
    return std::max({side.x, side.y, side.z});
}

double Mesh::area() const {
    double area = 0;
    for (const auto& t : triangles)
        area += 0.5 * double{length(cross(positions[t[1]] - positions[t[0]], positions[t[2]] - positions[t[0]]))};
    return area;
}

std::size_t Mesh::memory() const {
    std::size_t bytes = room_of(positions) + room_of(normals) + room_of(uvs) + room_of(colours) + room_of(triangles) +
                        room_of(values.alphas) + room_of(tangents);
    for (const auto& set : values.uvs) bytes += room_of(set);
    return bytes;
}

}  // namespace lightnet
