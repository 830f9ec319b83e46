// Light from lamps for many points at once. Where surfaces are diffuse and the lamp is the only one, and flat, points
// are put into columns, and go through the formulas of one alone in loops without a branch.
#include "core/math/columns.hpp"
#include "core/scene/direct_light.hpp"

#include <algorithm>

namespace lightnet {
namespace {

struct LitLanes {
    const FlatLamp* lamp;
    Heuristic heuristic;
    std::size_t count = 0;
    std::array<std::uint32_t, lanes> who;  // of the looks
    Columns3 position, normal, shading, outgoing, albedo;
    Column offset;
    Flags one_sided;
    Columns2 u;

    Columns3 origin, direction, light;
    Column far;
    Flags found;

    void add(std::uint32_t look, const Gathering& at, Vec2 number) {
        const std::size_t to = count++;
        who[to] = look;
        position.set(to, at.point.position);
        normal.set(to, at.point.normal);
        offset[to] = at.point.offset;
        shading.set(to, at.bsdf.shading().z);
        one_sided[to] = at.bsdf.one_sided();
        outgoing.set(to, at.outgoing);
        const Rgb& colour = *at.bsdf.diffuse_albedo();
        albedo.set(to, {colour.r, colour.g, colour.b});
        u.set(to, number);
    }

    // As ray_to_lamp().
    template <Heuristic by, bool whole>
    [[gnu::always_inline]] void look() {
        const Facet facet = lamp->facet;
        const Rgb radiance = lamp->radiance;
        const float area = lamp->area;
        const bool two_sided = lamp->two_sided;
        for (std::size_t i = 0; i < count; ++i) {
            const Vec3 on_lamp = facet.at(Facet::uniform(u[i], whole));
            const WayToLamp way = way_to_lamp(position[i], on_lamp, facet.normal, area, two_sided);
            const float pdf = diffuse_pdf(shading[i], normal[i], one_sided[i] != 0, outgoing[i], way.direction);
            const Rgb value = Rgb{albedo.x[i], albedo.y[i], albedo.z[i]} * pdf;
            const Rgb arriving = value * radiance * (share(by, way.pdf, pdf) / way.pdf);
            const Ray ray =
                ray_between(off_surface(position[i], normal[i], offset[i], way.direction), on_lamp, way.direction);
            origin.set(i, ray.origin);
            direction.set(i, ray.direction);
            far[i] = ray.far;
            light.set(i, {arriving.r, arriving.g, arriving.b});
            found[i] = way.found & ((value.r != 0) | (value.g != 0) | (value.b != 0));
        }
    }
    [[gnu::always_inline]] void work() {
        const bool power = heuristic == Heuristic::power;
        if (lamp->whole)
            power ? look<Heuristic::power, true>() : look<Heuristic::balance, true>();
        else
            power ? look<Heuristic::power, false>() : look<Heuristic::balance, false>();
    }
};

// Also what finds nothing is written, and then written over: what a point finds can't be foretold.
void hand_over(const LitLanes& many, LampRays& to) {
    std::size_t end = to.rays.size();
    to.rays.resize(end + many.count);
    to.light.resize(end + many.count);
    to.who.resize(end + many.count);
    for (std::size_t i = 0; i < many.count; ++i) {
        to.rays[end] = {many.origin[i], many.direction[i], many.far[i]};
        const Vec3 light = many.light[i];
        to.light[end] = {light.x, light.y, light.z};
        to.who[end] = many.who[i];
        end += many.found[i];
    }
    to.rays.resize(end);
    to.light.resize(end);
    to.who.resize(end);
}

}  // namespace

void rays_to_lamps(const Scene& scene, std::span<const LampLook> looks, Heuristic heuristic, LampRays& to) {
    LitLanes many;
    many.lamp = scene.only_flat_lamp();
    many.heuristic = heuristic;
    for (std::size_t first = 0; first < looks.size(); first += lanes) {
        const std::size_t last = std::min(looks.size(), first + lanes);
        many.count = 0;
        for (std::size_t i = first; i < last; ++i) {
            const auto& [at, numbers] = looks[i];
            if (many.lamp && !at.inside && (at.lobes & lobe::diffuse) && at.bsdf.diffuse_albedo()) {
                many.add(static_cast<std::uint32_t>(i), at, numbers.place);
            } else if (const auto one = ray_to_lamp(scene, at, numbers, heuristic)) {
                to.rays.push_back(one->ray);
                to.light.push_back(one->light);
                to.who.push_back(static_cast<std::uint32_t>(i));
            }
        }
        if (many.count == 0) continue;
        work_side_by_side(many);
        hand_over(many, to);
    }
}

}  // namespace lightnet
