#include "core/scene/batch/glossy_surfaces.hpp"

#include "core/scene/direct_light.hpp"
#include "core/scene/surfaces/looking_up.hpp"

namespace lightnet {

template <class Seen>
void GlossySurfaces<Seen>::add(std::uint32_t who, const ColumnShape& shape, const Hit& hit, Vec3 outgoing,
                               std::uint8_t lobes) {
    lobes_[size()] = lobes;
    add_point(who, shape, hit, outgoing);
}

// As value_of_any() and sample_of_any() of Bsdf begin.
template <class Seen>
struct GlossySurfaces<Seen>::Facing {
    GlossySurfaces& at;

    [[gnu::always_inline]] void work() {
        for (std::size_t i = 0; i < at.count_; ++i) {
            const Vec3 outgoing = at.outgoing_[i], normal = at.normal_[i], shading = at.shading_[i];
            const float seen = dot(outgoing, normal);
            const float side = seen > 0 ? 1 : 0, shading_side = dot(outgoing, shading) > 0 ? 1 : 0;
            const bool agree = side == shading_side;
            const Frame frame = Frame::around(
                {agree ? shading.x : normal.x, agree ? shading.y : normal.y, agree ? shading.z : normal.z});
            const Vec3 local = frame.to_local(outgoing);
            at.across_.set(i, frame.x);
            at.along_.set(i, frame.y);
            at.up_.set(i, frame.z);
            at.seen_.set(i, {local.x, local.y, local.z < 0 ? -local.z : local.z});
            at.turned_[i] = local.z < 0;
            at.dark_[i] = ((at.one_sided_[i] != 0) & (seen <= 0)) | (local.z == 0);
        }
    }
};

template <class Seen>
void GlossySurfaces<Seen>::find_bsdfs() {
    using Model = typename Seen::Model;
    for (std::size_t i = 0; i < size(); ++i)
        if (const Bsdf::Model* model = shapes_[i]->model) columns_.set(i, *std::get_if<Model>(model));
    look_up([&](std::size_t i, const TexturePlace& place) {
        columns_.set(i, shapes_[i]->shading->template model<Model>(hits_[i].geometry, place));
    });
    Facing facing{*this};
    work_in_lanes(facing);
    for (std::size_t i = 0; i < size(); ++i) columns_.see(i, seen_.z[i], lobes_[i]);
}

template <class Seen>
Bsdf GlossySurfaces<Seen>::bsdf(std::size_t i) const {
    Bsdf bsdf(Frame::around(shading_[i]), normal_[i], columns_.model(i));
    if (one_sided_[i]) bsdf.make_one_sided();
    return bsdf;
}

// As value_of_any() of Bsdf goes on.
template <class Seen>
struct GlossySurfaces<Seen>::Arriving {
    GlossySurfaces& at;

    [[gnu::always_inline]] void work() {
        for (std::size_t i = 0; i < at.count_; ++i) {
            const Vec3 direction = at.lamps_.direction[i];
            const Vec3 local = Frame{at.across_[i], at.along_[i], at.up_[i]}.to_local(direction);
            const float side = local.z > 0 ? 1 : 0, true_side = dot(direction, at.normal_[i]) > 0 ? 1 : 0;
            const float height = at.turned_[i] != 0 ? -local.z : local.z;
            at.lit_.set(i, {local.x, local.y, height});
            at.leaks_[i] = (side != true_side) | (height <= 0) | (at.dark_[i] != 0);
        }
    }
};

// As ray_to_lamp(). `whole`: nothing is shared.
template <class Seen>
template <bool whole>
struct GlossySurfaces<Seen>::Looking {
    GlossySurfaces& at;
    Heuristic heuristic;

    [[gnu::always_inline]] void work() {
        const LightSamples& lamps = at.lamps_;
        const Heuristic by = heuristic;
        for (std::size_t i = 0; i < at.count_; ++i) {
            const BsdfValue found = at.columns_.value(i, at.seen_[i], at.lit_[i]);
            const bool dark = at.leaks_[i] != 0;
            const Rgb value{dark ? 0 : found.value.r, dark ? 0 : found.value.g, dark ? 0 : found.value.b};
            const float pdf = dark ? 0 : found.pdf;
            const bool alone = whole | (lamps.bare[i] != 0), squared = squares(by, lamps.from_infinity[i] != 0);
            const float part = alone ? 1 : share(squared, lamps.pdf[i], pdf);
            at.set_ray_to_lamp(i, value, part);
            if constexpr (whole) at.set_densities(i, pdf);
        }
    }
};

template <class Seen>
template <bool whole>
const RaysToLamp& GlossySurfaces<Seen>::look(const LightSamples& lamps, Heuristic heuristic) {
    lamps_ = lamps;
    Arriving arriving{*this};
    work_in_lanes(arriving);
    for (std::size_t i = 0; i < size(); ++i) columns_.arrive(i, lit_.z[i]);
    Looking<whole> looking{*this, heuristic};
    work_in_lanes(looking);
    return rays_;
}

template <class Seen>
const RaysToLamp& GlossySurfaces<Seen>::look_at(const LightSamples& lamps, Heuristic heuristic) {
    return look<false>(lamps, heuristic);
}

template <class Seen>
const RaysToLamp& GlossySurfaces<Seen>::look_at_whole(const LightSamples& lamps) {
    return look<true>(lamps, Heuristic::automatic);
}

template <class Seen>
struct GlossySurfaces<Seen>::Proposing {
    GlossySurfaces& at;

    [[gnu::always_inline]] void work() {
        for (std::size_t i = 0; i < at.count_; ++i) {
            const Proposal proposal =
                at.columns_[i].template propose<true>(at.seen_[i], at.choices_[i], at.numbers_[i]);
            at.lit_.set(i, proposal.incoming);
            at.proposed_[i] = proposal.lobe;
        }
    }
};

// As sample_of_any() of Bsdf, and sample_seen(), end.
template <class Seen>
struct GlossySurfaces<Seen>::Finishing {
    GlossySurfaces& at;

    [[gnu::always_inline]] void work() {
        for (std::size_t i = 0; i < at.count_; ++i) {
            const Vec3 incoming = at.lit_[i];
            const bool specular = at.proposed_[i] == lobe::specular;
            const BsdfValue found = at.columns_.value(i, at.seen_[i], incoming);
            const Rgb rough = found.value / found.pdf, smooth = at.columns_[i].mirrored(at.choices_[i]);
            const float height = at.turned_[i] != 0 ? -incoming.z : incoming.z;
            const Frame frame{at.across_[i], at.along_[i], at.up_[i]};
            const Vec3 direction = normalize(frame.to_world({incoming.x, incoming.y, height}));
            const float side = height > 0 ? 1 : 0, true_side = dot(direction, at.normal_[i]) > 0 ? 1 : 0;
            at.steps_.incoming.set(i, direction);
            const Rgb weight = chosen(specular, smooth, rough);
            at.steps_.weight.set(i, {weight.r, weight.g, weight.b});
            at.steps_.pdf[i] = found.pdf;
            at.leaks_[i] = side != true_side;
        }
    }
};

template <class Seen>
const typename GlossySurfaces<Seen>::Steps& GlossySurfaces<Seen>::sample() {
    Proposing proposing{*this};
    work_in_lanes(proposing);
    for (std::size_t i = 0; i < size(); ++i) columns_.arrive(i, lit_.z[i]);
    Finishing finishing{*this};
    work_in_lanes(finishing);
    for (std::size_t i = 0; i < size(); ++i) {  // apart: compilers make no vectors of so many conditions
        const bool specular = proposed_[i] == lobe::specular;
        const bool absorbed = !specular && !(lit_.z[i] > 0 && steps_.pdf[i] > 0);
        steps_.found[i] = !absorbed && !leaks_[i] && !dark_[i];
        steps_.rough[i] = steps_.found[i] & std::uint32_t{!specular};
        steps_.lobe[i] = proposed_[i];
        if (specular) steps_.pdf[i] = 0;
    }
    return steps_;
}

template class GlossySurfaces<SeenCoatedDiffuse<GgxLaw>>;
template class GlossySurfaces<SeenCoatedDiffuse<BeckmannLaw>>;
template class GlossySurfaces<SeenConductor<GgxLaw>>;
template class GlossySurfaces<SeenConductor<BeckmannLaw>>;
template class GlossySurfaces<SeenPrincipled>;

}  // namespace lightnet
