// Lamps that are triangles of meshes, or a few of them in a plane.
#include "core/base/math/box.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/lamps/lamp_kinds.hpp"

#include <algorithm>
#include <cmath>

namespace lightnet {

LampStart start_on(const AreaLamp& lamp, const Mesh*, Vec2 u) {
    std::uint32_t primitive = 0;
    const Facet facet = lamp.all.facet_of(lamp, primitive, u.x);
    const Vec2 at = triangle(u);
    return {{facet.at(at), facet.normal, primitive, at.x, at.y}, lamp.area};
}

std::optional<LightSample> sample_on(const LampLook& look, const AreaLamp& lamp, const Mesh*) {
    const LampSource& source = lamp.source;
    const Facet* whole = lamp.all.whole(source);
    std::uint32_t primitive = 0;
    Vec2 u = look.u;
    const Facet on = whole ? *whole : lamp.all.facet_of(lamp, primitive, u.x);
    const Vec2 at = Facet::uniform(u, whole != nullptr);
    const Vec3 position = on.at(at);
    const auto [direction, pdf, found] = direction_to_lamp(look.from, position, on.normal, lamp.area, source.two_sided);
    if (!found) return {};
    Rgb radiance = source.radiance;
    if (!source.uniform) {
        const PointOnLamp point{position, on.normal, primitive, at.x, at.y};
        if (!look.radiance.is_there(source, point)) return {};
        radiance = look.radiance.at(source, point);
    }
    return LightSample{
        before_lamp(on, position, direction), direction, radiance, pdf, source.unseen, false, source.group};
}

EvenLamp even_on(const AreaLamp& one, const Mesh*) {
    const LampSource& source = one.source;
    const Facet* whole = one.all.whole(source);
    if (!source.uniform || (!whole && source.facets > 1)) return {};
    std::uint32_t primitive = 0;
    float u = 0;
    const Facet facet = whole ? *whole : one.all.facet_of(one, primitive, u);
    return FlatLamp{facet, whole != nullptr, one.area, source.radiance, source.two_sided, source.group};
}

LightBounds bounds_of(const AreaLamp& one, const Mesh*, float radiance) {
    const LampSource& source = one.source;
    Box box;
    const auto add = [&](const Facet& f) {
        for (const Vec3 p : {f.corner, f.corner + f.first_edge, f.corner + f.second_edge}) box.add(p);
    };
    std::uint32_t primitive = 0;
    float u = 0;
    const Facet first = one.all.facet_of(one, primitive, u);
    add(first);
    for (const Facet& facet : one.all.facets_of(source)) add(facet);
    return {box.low, box.high, first.normal, 1, 0, radiance * one.area, source.two_sided};
}

float density(const Mesh*, const LampFound& found) {
    const float cosine = std::max(1e-6f, std::fabs(dot(found.on.normal, found.direction)));
    return found.area > 0 ? found.way2() / (found.area * cosine) : 0;
}

}  // namespace lightnet
