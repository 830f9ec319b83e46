#include "core/scene/batch/lambertian_surfaces.hpp"

#include "core/scene/direct_light.hpp"
#include "core/scene/surfaces/looking_up.hpp"

namespace lightnet {

void LambertianSurfaces::find_points() {
    find_places();
    if (various_count_ > 0)
        look_up([&](std::size_t i, const TexturePlace& place) {
            const Rgb albedo = shapes_[i]->shading->albedo(hits_[i].geometry, place);
            albedo_.set(i, {albedo.r, albedo.g, albedo.b});
        });
}

Bsdf LambertianSurfaces::bsdf(std::size_t i) const {
    Bsdf bsdf(Frame::around(shading_[i]), normal_[i], DiffuseBsdf{albedo(i)});
    if (one_sided_[i]) bsdf.make_one_sided();
    return bsdf;
}

struct LambertianSurfaces::Sampling {
    LambertianSurfaces& at;

    // As Bsdf::sample().
    [[gnu::always_inline]] void work() {
        for (std::size_t i = 0; i < at.count_; ++i) {
            const Vec3 outgoing = at.outgoing_[i], normal = at.normal_[i], shading = at.shading_[i];
            const float seen = dot(outgoing, normal);
            const float side = seen > 0 ? 1 : 0, shading_side = dot(outgoing, shading) > 0 ? 1 : 0;
            const bool agree = side == shading_side;
            const Vec3 up{agree ? shading.x : normal.x, agree ? shading.y : normal.y, agree ? shading.z : normal.z};
            const DiffuseStep step = diffuse_step(Frame::around(up), normal, outgoing, at.numbers_[i]);
            at.steps_.incoming.set(i, step.incoming);
            const float front = seen > 0 ? step.pdf : 0;
            at.steps_.pdf[i] = at.one_sided_[i] != 0 ? front : step.pdf;
        }
    }
};

const LambertianSurfaces::Steps& LambertianSurfaces::sample() {
    Sampling sampling{*this};
    work_in_lanes(sampling);
    return steps_;
}

// `whole`: nothing is shared.
template <bool whole, bool parallelogram>
struct LambertianSurfaces::Looking {
    LambertianSurfaces& at;
    FlatLamp lamp;  // a copy, as the lamps below are: nothing that is written is any of it
    Heuristic heuristic;

    // As ray_to_lamp().
    [[gnu::always_inline]] void work() {
        const bool squared = squares(heuristic, false);
        const Facet facet = lamp.facet;
        const Rgb radiance = lamp.radiance;
        const float area = lamp.area;
        const bool two_sided = lamp.two_sided;
        for (std::size_t i = 0; i < at.count_; ++i) {
            const Vec3 position = at.position_[i], normal = at.normal_[i];
            const Vec3 on_lamp = facet.at(Facet::uniform(at.numbers_[i], parallelogram));
            const DirectionToLamp way = direction_to_lamp(position, on_lamp, facet.normal, area, two_sided);
            const float pdf =
                diffuse_pdf(at.shading_[i], normal, at.one_sided_[i] != 0, at.outgoing_[i], way.direction);
            const Rgb value = Rgb{at.albedo_.x[i], at.albedo_.y[i], at.albedo_.z[i]} * pdf;
            const float part = whole ? 1 : share(squared, way.pdf, pdf);
            const Rgb arriving = value * radiance * (part / way.pdf);
            const Vec3 end = before_lamp(facet, on_lamp, way.direction);
            const Ray ray =
                ray_between(off_surface(position, normal, at.offset_[i], way.direction), end, way.direction);
            at.rays_.origin.set(i, ray.origin);
            at.rays_.direction.set(i, ray.direction);
            at.rays_.far[i] = ray.far;
            at.rays_.light.set(i, {arriving.r, arriving.g, arriving.b});
            if constexpr (whole) {
                at.rays_.lamp_pdf[i] = way.pdf;
                at.rays_.pdf[i] = pdf;
                at.rays_.bare[i] = at.rays_.from_infinity[i] = 0;
            }
            at.rays_.group[i] = lamp.group;
            at.rays_.found[i] = way.found & ((value.r != 0) | (value.g != 0) | (value.b != 0));
        }
    }
};

template <bool whole>
struct LambertianSurfaces::LookingAtMany {
    LambertianSurfaces& at;
    Heuristic heuristic;

    // As ray_to_lamp().
    [[gnu::always_inline]] void work() {
        const LightSamples& lamps = at.lamps_;
        const Heuristic by = heuristic;
        for (std::size_t i = 0; i < at.count_; ++i) {
            const float pdf =
                diffuse_pdf(at.shading_[i], at.normal_[i], at.one_sided_[i] != 0, at.outgoing_[i], lamps.direction[i]);
            const Rgb value = Rgb{at.albedo_.x[i], at.albedo_.y[i], at.albedo_.z[i]} * pdf;
            const bool alone = whole | (lamps.bare[i] != 0), squared = squares(by, lamps.from_infinity[i] != 0);
            const float part = alone ? 1 : share(squared, lamps.pdf[i], pdf);
            at.set_ray_to_lamp(i, value, part);
            if constexpr (whole) at.set_densities(i, pdf);
        }
    }
};

template <bool whole>
const RaysToLamp& LambertianSurfaces::look(const FlatLamp& lamp, Heuristic heuristic) {
    const auto work = [](auto looking) { work_in_lanes(looking); };
    lamp.whole ? work(Looking<whole, true>{*this, lamp, heuristic})
               : work(Looking<whole, false>{*this, lamp, heuristic});
    return rays_;
}

const RaysToLamp& LambertianSurfaces::look_at(const FlatLamp& lamp, Heuristic heuristic) {
    return look<false>(lamp, heuristic);
}

const RaysToLamp& LambertianSurfaces::look_at_whole(const FlatLamp& lamp) {
    return look<true>(lamp, Heuristic::automatic);
}

const RaysToLamp& LambertianSurfaces::look_at(const LightSamples& lamps, Heuristic heuristic) {
    lamps_ = lamps;
    LookingAtMany<false> looking{*this, heuristic};
    work_in_lanes(looking);
    return rays_;
}

const RaysToLamp& LambertianSurfaces::look_at_whole(const LightSamples& lamps) {
    lamps_ = lamps;
    LookingAtMany<true> looking{*this, Heuristic::automatic};
    work_in_lanes(looking);
    return rays_;
}

}  // namespace lightnet
