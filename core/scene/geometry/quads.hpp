// Triangles of a mesh, two by two.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/math/vec.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// A point of a triangle by the name that hits have: the triangle, and the weights of its second and third corner.
struct TrianglePoint {
    std::uint32_t triangle = 0;
    Vec2 at;
};

/// All triangles of a mesh as quads: pairs that share an edge, and those that found no other alone. Of a quad with the
/// corners 0, 1, 2, 3, the first triangle is 0 1 3 and the second 2 3 1; one that is alone has its last corner twice.
class Quads {
public:
    Quads() = default;
    /// A triangle is paired with one of the few unpaired ones before it: files have neighbours near each other.
    explicit Quads(const Mesh& mesh);

    bool empty() const { return corners_.empty(); }
    std::size_t size() const { return corners_.size(); }
    const std::vector<std::array<std::uint32_t, 4>>& corners() const { return corners_; }

    /// Which point of which triangle is the one at (u, v), as Embree counts them: from corner 0 towards 1 and 3.
    TrianglePoint point(std::uint32_t quad, Vec2 at) const;

    /// Calls `look(triangle)` for each triangle of a quad.
    template <class Look>
    void each_triangle(std::uint32_t quad, Look look) const {
        look(pairs_[quad].first);
        if (pairs_[quad].step) look(pairs_[quad].first + pairs_[quad].step);
    }

    std::size_t memory() const;

private:
    struct Pair {
        std::uint32_t first;            // triangle
        std::uint32_t step : 28;        // to the second one; 0: there is none
        std::uint32_t first_turn : 2;   // which of its corners the quad's corner 0 is
        std::uint32_t second_turn : 2;  // and of the second one, the quad's corner 2
    };
    bool add_pair(const Mesh& mesh, std::uint32_t first, std::uint32_t second);  // false: they share no edge
    void add_alone(const Mesh& mesh, std::uint32_t triangle);

    std::vector<std::array<std::uint32_t, 4>> corners_;
    std::vector<Pair> pairs_;
};

}  // namespace lightnet
