#include "core/scene/bsdf/bsdf.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace lightnet {
namespace {

template <class Model>
constexpr bool looks_alike = std::decay_t<Model>::two_sided;

template <class Model>
inline BsdfValue value_of(const Model& model, Vec3 o, Vec3 i, std::uint8_t lobes) {
    if (looks_alike<Model> && o.z < 0) {
        o.z = -o.z;
        i.z = -i.z;
    }
    return model.evaluate(o, i, lobes);
}

template <class Model>
inline std::optional<BsdfSample> sample_of(const Model& model, Vec3 o, float choice, Vec2 u, std::uint8_t lobes) {
    const bool flip = looks_alike<Model> && o.z < 0;
    if (flip) o.z = -o.z;
    auto found = model.sample(o, choice, u, lobes);
    if (found && flip) found->incoming.z = -found->incoming.z;
    return found;
}

// Of those that aren't named here, nothing is known for certain.
template <class Model>
constexpr bool always_opaque = std::is_same_v<Model, DiffuseBsdf> || std::is_same_v<Model, RoughDiffuseBsdf> ||
                               std::is_same_v<Model, ConductorBsdf> || std::is_same_v<Model, CoatedDiffuseBsdf> ||
                               std::is_same_v<Model, CoatedConductorBsdf> || std::is_same_v<Model, MeasuredBsdf>;

}  // namespace

Bsdf::Bsdf(Vec3 normal, std::vector<Part> parts)
    : shading_(parts.front().bsdf.shading()),
      normal_(normal),
      parts_(std::make_shared<const std::vector<Part>>(std::move(parts))) {}

std::uint8_t Bsdf::lobes_of_any() const {
    if (!parts_) return std::visit([](const auto& m) { return m.lobes(); }, model_);
    std::uint8_t all = 0;
    for (const Part& part : *parts_) all |= part.bsdf.lobes();
    return all;
}

bool Bsdf::any_is_opaque() const {
    if (parts_) return std::all_of(parts_->begin(), parts_->end(), [](const Part& p) { return p.bsdf.opaque(); });
    if (const auto* principled = std::get_if<PrincipledBsdf>(&model_))
        return principled->transmission == 0 && principled->translucence == 0;
    if (const auto* burley = std::get_if<BurleyBsdf>(&model_)) return !burley->lets_through();
    return std::visit([](const auto& m) { return always_opaque<std::decay_t<decltype(m)>>; }, model_);
}

BsdfValue Bsdf::value_of_any(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const {
    if (parts_) return blended_value(outgoing, incoming, lobes);
    if (const auto* phase = std::get_if<PhaseBsdf>(&model_)) return phase->evaluate(outgoing, incoming, lobes);
    if (one_sided_ && dot(outgoing, normal_) <= 0) return {};
    const Frame frame = frame_for(outgoing);
    const Vec3 o = frame.to_local(outgoing), i = frame.to_local(incoming);
    if (o.z == 0 || (i.z > 0) != (dot(incoming, normal_) > 0)) return {};
    return std::visit([&](const auto& m) { return value_of(m, o, i, lobes); }, model_);
}

std::optional<BsdfSample> Bsdf::sample_of_any(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const {
    if (parts_) return blended_sample(outgoing, choice, u, lobes);
    if (const auto* phase = std::get_if<PhaseBsdf>(&model_)) return phase->sample(outgoing, choice, u, lobes);
    if (one_sided_ && dot(outgoing, normal_) <= 0) return {};
    const Frame frame = frame_for(outgoing);
    const Vec3 o = frame.to_local(outgoing);
    if (o.z == 0) return {};
    auto result = std::visit([&](const auto& m) { return sample_of(m, o, choice, u, lobes); }, model_);
    if (!result) return {};
    const bool above = result->incoming.z > 0;
    result->incoming = normalize(frame.to_world(result->incoming));
    if (above != (dot(result->incoming, normal_) > 0)) return {};
    return result;
}

CosineChoices Bsdf::cosine_choices(Vec3 outgoing, std::uint8_t lobes) const {
    if (parts_ || (one_sided_ && dot(outgoing, normal_) <= 0)) return {};
    const float height = frame_for(outgoing).to_local(outgoing).z;
    if (height == 0) return {};
    return std::visit(
        [&]<class Model>(const Model& model) -> CosineChoices {
            const float seen = looks_alike<Model> ? std::fabs(height) : height;
            if constexpr (requires { model.cosine_choices(seen, lobes); })
                return model.cosine_choices(seen, lobes);
            else
                return {};
        },
        model_);
}

std::optional<float> Bsdf::reflection_chance(Vec3 outgoing) const {
    if (parts_ || one_sided_) return {};
    const float height = frame_for(outgoing).to_local(outgoing).z;
    const auto* glass = std::get_if<DielectricBsdf>(&model_);
    if (glass && glass->smooth()) return glass->reflection_chance({0, 0, height});
    if (const auto* pane = std::get_if<ThinDielectricBsdf>(&model_))
        return pane->reflection_chance({0, 0, std::fabs(height)});
    return {};
}

// With which weight a part is sampled: 0 where it can't be seen, or has none of the lobes.
float Bsdf::chance_of(const Part& part, Vec3 outgoing, std::uint8_t lobes) const {
    const bool front = dot(outgoing, normal_) > 0;
    const bool seen = part.from == SeenFrom::both || (part.from == SeenFrom::front) == front;
    return seen && (part.bsdf.lobes() & lobes) ? part.share : 0;
}

[[gnu::cold]] BsdfValue Bsdf::blended_value(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const {
    BsdfValue sum;
    float chances = 0;
    for (const Part& part : *parts_) {
        const float chance = chance_of(part, outgoing, lobes);
        if (!(chance > 0)) continue;
        const auto [value, pdf] = part.bsdf.value_and_pdf(outgoing, incoming, lobes);
        sum.value += value * chance;
        sum.pdf += pdf * chance;
        chances += chance;
    }
    if (chances > 0) sum.pdf /= chances;
    return sum;
}

[[gnu::cold]] std::optional<BsdfSample> Bsdf::blended_sample(Vec3 outgoing, float choice, Vec2 u,
                                                             std::uint8_t lobes) const {
    float chances = 0;
    for (const Part& part : *parts_) chances += chance_of(part, outgoing, lobes);
    choice *= chances;
    const Part* chosen = nullptr;
    float chance = 0;
    for (const Part& part : *parts_) {
        const float own = chance_of(part, outgoing, lobes);
        if (!(own > 0)) continue;
        if (chosen && choice < chance) break;
        if (chosen) choice -= chance;
        chosen = &part;
        chance = own;
    }
    if (!chosen) return {};
    // within the part, its share of the choice is as good a number as the whole was
    auto result = chosen->bsdf.sample(outgoing, std::clamp(choice / chance, 0.0f, 0x1.fffffep-1f), u, lobes);
    if (!result) return {};
    if (result->lobe == lobe::specular) {
        result->weight *= chances;  // share over chance
        return result;
    }
    const auto [value, pdf] = blended_value(outgoing, result->incoming, lobes);
    if (!(pdf > 0)) return {};
    result->weight = value / pdf;
    result->pdf = pdf;
    return result;
}

}  // namespace lightnet
