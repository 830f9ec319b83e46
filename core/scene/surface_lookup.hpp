// The surface point of a position: for code whose structures hold positions and normals, and no
// names of ours.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/base/query.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {

/// Belongs to one piece of work at a time, such as the answer to one question. What it was given is found again
/// exactly: the same surface point, to the bit, by the same position; of two at one position, the last. Any other
/// position means the nearest surface within `reach`.
class SurfaceLookup {
public:
    /// Of the scene's radius: the steps by which old code keeps off surfaces are smaller.
    static constexpr float reach = 1e-3f;
    /// How many positions are known at a time: the last ones.
    static constexpr std::size_t most_known = 1024;

    explicit SurfaceLookup(const Scene& scene) : scene_(scene) {}

    /// Another piece of work begins. What is found must not depend on what came before it.
    void forget();
    /// The surface point, whose position is known from now on.
    SurfacePoint point(const Hit& hit);
    SurfacePoint point(const Query& question) { return point(scene_.hit(question)); }

    /// What lies at a position. `normal`: of the surface that is meant, on either side; zero: it isn't known.
    std::optional<Hit> find(Vec3 position, Vec3 normal = {}) const;
    /// How bright is it there, towards `outgoing` (unit)? None: there is no surface.
    std::optional<Query> question(Vec3 position, Vec3 normal, Vec3 outgoing) const;
    /// Where a ray from there into `direction` starts: off the surface, if there is one.
    Vec3 origin(Vec3 position, Vec3 direction) const;

private:
    struct Known {
        Vec3 position;
        Hit hit;
    };

    const Scene& scene_;
    std::vector<Known> known_;
    std::size_t next_ = 0;  // to be replaced, when there are as many as may be
};

}  // namespace lightnet
