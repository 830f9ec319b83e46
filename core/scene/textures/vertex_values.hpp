// Numbers that some meshes have at their vertices, and that few textures ask for.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/math/vec.hpp"
#include "core/scene/textures/members.hpp"

namespace lightnet {

struct VertexValues {
    std::vector<std::vector<Vec2>> uvs{};  // the second set of texture coordinates, the third …: each per vertex
    std::vector<float> alphas{};           // how much of the surface is there: per vertex, or empty

    bool empty() const { return uvs.empty() && alphas.empty(); }
};
void visit_members(Is<VertexValues> auto& values, const auto& visit) {
    auto& [uvs, alphas] = values;
    visit(uvs, alphas);
}

/// A place between three vertices.
struct BetweenVertices {
    const VertexValues* values = nullptr;    // null: there are none
    std::array<std::uint32_t, 3> corners{};  // indices of the vertices
    float u = 0, v = 0;                      // weights of the second one and of the third

    /// In a set of texture coordinates: 0 is the second. (0, 0) where there is no such set.
    Vec2 uv(std::size_t set) const { return values && set < values->uvs.size() ? between(values->uvs[set]) : Vec2{}; }
    /// 1 where nothing is said.
    float alpha() const { return values && !values->alphas.empty() ? between(values->alphas) : 1; }

private:
    template <class T>
    T between(const std::vector<T>& of) const {
        return of[corners[0]] * (1 - u - v) + of[corners[1]] * u + of[corners[2]] * v;
    }
};

}  // namespace lightnet
