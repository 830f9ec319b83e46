// Balls around the shapes that shine, to be missed by most rays.
#pragma once

#include <cstddef>

#include "core/base/math/columns.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/shapes/ray.hpp"

namespace lightnet {

/// A ball around each of them, all asked at once. Immutable once all are added; any thread may ask.
class LampBalls {
public:
    void add(Vec3 center, float radius);
    /// Could the ray meet one? False is certain.
    bool may_meet(const Ray& ray) const;

private:
    struct Meeting;

    std::size_t count_ = 0;
    Columns3 centers_{};  // of the first: asking more costs as much as the ray
    Column radii2_{};
};

}  // namespace lightnet
