#include "core/scene/surface_lookup.hpp"

namespace lightnet {

void SurfaceLookup::forget() {
    known_.clear();
    next_ = 0;
}

SurfacePoint SurfaceLookup::point(const Hit& hit) {
    const SurfacePoint point = scene_.surface(hit);
    if (known_.size() < most_known) known_.emplace_back();
    known_[next_] = {point.position, hit};
    next_ = (next_ + 1) % most_known;
    return point;
}

// Nearly always it is the last one, or the one before: that is where the search begins.
std::optional<Hit> SurfaceLookup::find(Vec3 position, Vec3 normal) const {
    for (std::size_t back = 1; back <= known_.size(); ++back) {
        const Known& known = known_[(next_ + most_known - back) % most_known];
        if (known.position == position) return known.hit;
    }
    return scene_.nearest(position, normal, reach * scene_.radius());
}

std::optional<Query> SurfaceLookup::question(Vec3 position, Vec3 normal, Vec3 outgoing) const {
    const auto hit = find(position, normal);
    if (!hit) return {};
    Query question;
    question.instance = hit->instance;
    question.geometry = hit->geometry;
    question.primitive = hit->primitive;
    question.u = hit->u, question.v = hit->v;
    question.outgoing = outgoing;
    return question;
}

Vec3 SurfaceLookup::origin(Vec3 position, Vec3 direction) const {
    const auto hit = find(position);
    return hit ? scene_.surface(*hit).origin_towards(direction) : position;
}

}  // namespace lightnet
