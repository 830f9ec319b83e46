// How paths go on from where they have come to: the larger members of PathVertices, whose header ends with them.
#pragma once

#include "core/estimate/path_vertices.hpp"

namespace lightnet {

template <bool guided, class Choice, class On>
void PathVertices::go_on_from_visitor(const Visitor& visitor, std::span<const Vec2> directions, Choice&& choice,
                                      On&& on) {
    const Gathering at = gathering(visitor);
    if (guided && guide_ && guided_[visitor.point].leads()) {
        const auto step = guided_step(at, guided_[visitor.point], directions[visitor.path]);
        if (!step) return;
        if (learns_) note_step(side_of(at), *step);
        return on(visitor.path, *step);
    }
    const float chosen = at.bsdf.chooses() ? choice(visitor.path) : 0;
    const auto sample = at.bsdf.sample(at.outgoing, chosen, directions[visitor.path], at.lobes);
    if (!sample) return;
    Step step = step_to(at, *sample);
    if (guided && guide_ && guided_[visitor.point] && sample->lobe != lobe::specular)
        step.known = guided_[visitor.point].radiance();
    if (guided && learns_) note_step(side_of(at), step);
    on(visitor.path, step);
}

template <bool guided, class On>
[[gnu::always_inline]] inline void PathVertices::go_on_from_plain(std::size_t i, On&& on) {
    const auto& steps = plain_.steps();
    if (steps.pdf[i] == 0) return;
    BsdfSample step{steps.incoming[i], plain_.albedo(i), steps.pdf[i], lobe::diffuse};
    float favour = 1, known = -1;
    if constexpr (guided) {
        if (guide_) favour = guided_plain_.favour(i), known = guided_plain_.radiance(i);
        step.weight *= 1 / favour, step.pdf *= favour;
        if (learns_) note_plain_step(i, favour);
    }
    const Vec3 at = plain_.position(i);
    const LitPoint from = only_lamp_ ? LitPoint(at)  // nothing to choose
                                     : lit_point(at, plain_.normal(i), plain_.outgoing(i));
    on(plain_.who(i), Step{step, plain_.ray_from(i, step.incoming), from, nullptr, known, favour});
}

template <bool guided, class Glossy, class On>
void PathVertices::go_on_from_glossy(const Glossy& glossy, std::size_t i, const GuidedPoint& known, On&& on) {
    const auto& steps = glossy.steps();
    if (!steps.found[i]) return;
    const Vec3 weight = steps.weight[i];
    Step step{
        {steps.incoming[i], {weight.x, weight.y, weight.z}, steps.pdf[i], static_cast<std::uint8_t>(steps.lobe[i])},
        glossy.ray_from(i, steps.incoming[i]),
        lit_point_of(glossy, i),
        nullptr};
    if constexpr (guided) {
        if (guide_ && known && step.sample.lobe != lobe::specular) step.known = known.radiance();
        if (learns_) note_step(side_of(glossy, i), step);
    }
    on(glossy.who(i), step);
}

inline void PathVertices::find_guided() {
    guided_plain_.find(*guide_, plain_);
    guided_.resize(points_.size());
    for (std::size_t i = 0; i < points_.size(); ++i) {
        const SurfacePoint& point = points_[i];
        const GuideSide side = GuideSide::of(point.normal, point.shading.z, views_[i].outgoing);
        const bool rough = bsdfs_[i].lobes() & views_[i].lobes & lobe::rough;
        const bool even = bsdfs_[i].diffuse_albedo();
        guided_[i] = rough ? guide_->at(point.position, side, even) : GuidedPoint();
    }
    for (std::size_t s = 0; s < stop_count_; ++s) {
        const std::size_t i = stops_[s].index;
        glossy_.of(stops_[s].kind, [&](const auto& group) {
            guided_glossy_[s] = guide_->at(group.position(i), side_of(group, i), false);
        });
    }
}

inline std::optional<PathVertices::Step> PathVertices::guided_step(const Gathering& at, const GuidedPoint& guided,
                                                                   Vec2 u) {
    BsdfSample sample;
    sample.incoming = guided.direction(guided.warped(u).place);
    sample.lobe = lobe::glossy;
    const auto [value, pdf] = at.bsdf.value_and_pdf(at.outgoing, sample.incoming, at.lobes);
    if (is_black(value)) return {};
    sample.pdf = guided.pdf(sample.incoming, pdf);
    if (!(sample.pdf > 0)) return {};
    sample.weight = value / sample.pdf;
    Step step = step_to(at, sample);
    step.known = guided.radiance();
    step.favour = pdf > 0 ? sample.pdf / pdf : 1;
    return step;
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
