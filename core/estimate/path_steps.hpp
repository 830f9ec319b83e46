// Steps of paths from one surface to the next: the larger members of PathVertices, whose header ends with them.
#pragma once

#include "core/estimate/path_vertices.hpp"

namespace lightnet {

template <bool guided, class Choice, class On>
void PathVertices::go_on_from_visitor(const Leaving& visitor, std::span<const Vec2> directions, Choice&& choice,
                                      On&& on) {
    const Gathering at = gathering(visitor);
    const float chosen = at.bsdf.chooses() ? choice(visitor.path) : 0;
    const Vec2 u = directions[visitor.path];
    const GuidedPoint known = guided && guide_ ? guided_[visitor.point] : GuidedPoint();
    const bool leads = guided && known && known.leads(chosen) && !visitor.alone;
    const auto sample = leads ? led(at, known, u) : at.bsdf.sample(at.outgoing, chosen, u, at.lobes);
    if (!sample) return;
    Step step = step_to(at, *sample);
    if (guided && known && sample->lobe != lobe::specular)
        follow(known.radiance(), known.pdf(sample->incoming, sample->pdf) / sample->pdf, step);
    if (guided && learns_) note_step(side_of(at), step);
    on(visitor.path, step);
}

template <bool guided, class On>
[[gnu::always_inline]] inline void PathVertices::go_on_from_plain(std::size_t i, On&& on) {
    const auto& steps = plain_.steps();
    if (steps.pdf[i] == 0) return;
    const Vec3 at = plain_.position(i);
    const LitPoint from = only_lamp_ ? LitPoint(at, plain_.time(i))  // nothing to choose
                                     : lit_point(at, plain_.normal(i), plain_.outgoing(i), plain_.time(i));
    Step step{{steps.incoming[i], plain_.albedo(i), steps.pdf[i], lobe::diffuse},
              plain_.ray_from(i, steps.incoming[i]),
              from,
              nullptr};
    if constexpr (guided) {
        if (guide_) follow(plain_.guided.radiance(i), plain_.guided.favour(i), step);
        if (learns_) note_plain_step(i, step.favour);
    }
    on(plain_.who(i), step);
}

template <bool guided, class Glossy, class On>
void PathVertices::go_on_from_glossy(const Glossy& glossy, std::size_t i, On&& on) {
    const auto& steps = glossy.steps();
    if (!steps.found[i]) return;
    const Vec3 weight = steps.weight[i];
    Step step{
        {steps.incoming[i], {weight.x, weight.y, weight.z}, steps.pdf[i], static_cast<std::uint8_t>(steps.lobe[i])},
        glossy.ray_from(i, steps.incoming[i]),
        lit_point_of(glossy, i),
        nullptr};
    if constexpr (guided) {
        if (guide_ && steps.rough[i]) follow(glossy.guided.radiance(i), glossy.guided.favour(i), step);
        if (learns_) note_step(side_of(glossy, i), step);
    }
    on(glossy.who(i), step);
}

inline void PathVertices::find_guided() {
    each_group([&](auto& group) { group.guided.find(*guide_, group); });
    guided_.resize(points_.size());
    for (std::size_t i = 0; i < points_.size(); ++i) {
        const SurfacePoint& point = points_[i];
        const GuideSide side = GuideSide::of(point.normal, bsdfs_[i].shading().z, views_[i].outgoing);
        // No guide knows directions around a point without a normal.
        const bool rough = !point.is_in_space() && bsdfs_[i].lobes() & views_[i].lobes & lobe::rough;
        const CosineChoices choices = bsdfs_[i].cosine_choices(views_[i].outgoing, views_[i].lobes);
        guided_[i] = rough ? guide_->at(point.position, side, choices) : GuidedPoint();
    }
}

inline std::optional<BsdfSample> PathVertices::led(const Gathering& at, const GuidedPoint& known, Vec2 u) {
    const Vec3 incoming = known.direction(known.warped(u).place);
    const auto [value, pdf] = at.bsdf.value_and_pdf(at.outgoing, incoming, at.lobes);
    if (!(pdf > 0)) return {};
    return BsdfSample{incoming, value / pdf, pdf, lobe::diffuse};
}

inline void PathVertices::note_step(const GuideSide& side, const Step& step) {
    record_.reset();
    const float z = dot(step.sample.incoming, side.up), height = side.turned ? -z : z;
    if (step.sample.lobe == lobe::specular || !(height > least_height)) return;
    const Frame frame = Frame::around(side.up);
    const Vec2 place = from_disk({dot(step.sample.incoming, frame.x), dot(step.sample.incoming, frame.y)});
    const float density = step.sample.pdf * pi / height;
    record_ = GuideStep{step.from.position, density, LightGuide::turn_of(side), place};
}

}  // namespace lightnet
