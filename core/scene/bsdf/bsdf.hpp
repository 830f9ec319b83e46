// The BSDF of one point of a surface.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/math/frame.hpp"
#include "core/base/math/rgb.hpp"
#include "core/base/math/vec.hpp"
#include "core/base/query.hpp"
#include "core/scene/bsdf/material.hpp"
#include "core/scene/bsdf/phase.hpp"
#include "core/scene/bsdf/scattering.hpp"

namespace lightnet {

/// Which of the models in a variant look at the `choice` of sample().
template <class Models>
inline constexpr bool choosing = false;
template <class... Models>
inline constexpr std::array<bool, sizeof...(Models)> choosing<std::variant<Models...>>{Models::chooses...};

/// Scattering at one point, textures already looked up. A value: make it, use it, drop it. Both directions are unit,
/// in world space and point away from the surface. Reflection stays on the geometric normal's side of the surface and
/// transmission goes to the other one, whatever the shading normal says, so that no light leaks. At a point in a medium
/// it is the phase function, times the albedo; there is no normal then, and no side.
class Bsdf {
public:
    /// Those of materials, and that of a point in a medium.
    using Model = EachOnce<ModelsOf<AnyMaterial>::type, PhaseBsdf>;
    /// Some share of a surface; seen from one of its sides only, or from both.
    struct Part;

    Bsdf(const Frame& shading, Vec3 normal, const Model& model) : shading_(shading), normal_(normal), model_(model) {}
    /// Of a collision in a medium, where there is no normal.
    explicit Bsdf(const PhaseBsdf& phase) : shading_{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, model_(phase) {}
    /// A blend of others, one at least, whose shares sum up to 1 on each side.
    Bsdf(Vec3 normal, std::vector<Part> parts);

    /// Black from behind.
    void make_one_sided() { one_sided_ = true; }
    /// What lies behind the surface, or in front of it, absorbs that much per metre; null: nothing. Keeps looking at
    /// them; blends have none.
    void fill_with(const Rgb* behind, const Rgb* in_front) { absorption_ = behind, absorption_in_front_ = in_front; }

    /// Which lobes the surface has.
    std::uint8_t lobes() const { return diffuse() ? lobe::diffuse : lobes_of_any(); }
    /// Does sample() look at its `choice`?
    bool chooses() const { return parts_ || choosing<Model>[model_.index()]; }
    /// Of smooth glass: below which `choice` sample() reflects; what is not reflected is transmitted. None: of others.
    std::optional<float> reflection_chance(Vec3 outgoing) const;
    /// f × |cos incoming| for the non-specular lobes among `lobes`, sr⁻¹; and the density with which sample() with the
    /// same `lobes` finds `incoming`, per steradian. Both exactly 0 for specular lobes.
    BsdfValue value_and_pdf(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const {
        const DiffuseBsdf* lambertian = diffuse();
        return lambertian ? diffuse_value(*lambertian, outgoing, incoming, lobes)
                          : value_of_any(outgoing, incoming, lobes);
    }
    Rgb evaluate(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const {
        return value_and_pdf(outgoing, incoming, lobes).value;
    }
    float pdf(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const {
        return value_and_pdf(outgoing, incoming, lobes).pdf;
    }
    /// One direction of light, by importance. None: absorbed.
    std::optional<BsdfSample> sample(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const {
        const DiffuseBsdf* lambertian = diffuse();
        return lambertian ? diffuse_sample(*lambertian, outgoing, u, lobes) : sample_of_any(outgoing, choice, u, lobes);
    }
    /// For which choices sample() goes by the cosine; none where there is no such lobe, or where it is one of a blend.
    CosineChoices cosine_choices(Vec3 outgoing, std::uint8_t lobes) const;
    /// The colour of a diffuse reflector that fills nothing, alike on both sides or black from behind; null: another.
    const Rgb* diffuse_albedo() const { return diffuse() && !absorption_ ? &diffuse()->albedo : nullptr; }
    /// Does nothing count but light on the viewer's side? False of what may let light through.
    bool opaque() const { return diffuse() || any_is_opaque(); }
    /// Is it black from behind?
    bool one_sided() const { return one_sided_; }
    /// Its frame; of a blend, that of the first part.
    const Frame& shading() const { return shading_; }

    /// What a ray into `direction` passes through absorbs, per metre: of light over a length, exp(-it × length)
    /// is left. Null: nothing.
    const Rgb* absorption(Vec3 direction) const {
        return dot(direction, normal_) < 0 ? absorption_ : absorption_in_front_;
    }

private:
    // Where the shading normal turns away from a viewer who sees the surface, the geometric one takes its place; the
    // surface would be black there otherwise.
    Frame frame_for(Vec3 outgoing) const {
        const bool agree = (dot(outgoing, normal_) > 0) == (dot(outgoing, shading_.z) > 0);
        return agree ? shading_ : Frame::around(normal_);
    }
    /// What most surfaces are: null if this one is anything else.
    const DiffuseBsdf* diffuse() const { return parts_ ? nullptr : std::get_if<DiffuseBsdf>(&model_); }
    BsdfValue diffuse_value(const DiffuseBsdf& model, Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const;
    std::optional<BsdfSample> diffuse_sample(const DiffuseBsdf& model, Vec3 outgoing, Vec2 u, std::uint8_t lobes) const;
    std::uint8_t lobes_of_any() const;
    bool any_is_opaque() const;
    BsdfValue value_of_any(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const;
    std::optional<BsdfSample> sample_of_any(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const;
    float chance_of(const Part& part, Vec3 outgoing, std::uint8_t lobes) const;
    BsdfValue blended_value(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const;
    std::optional<BsdfSample> blended_sample(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const;

    Frame shading_;
    Vec3 normal_;  // geometric
    Model model_;
    bool one_sided_ = false;
    const Rgb *absorption_ = nullptr, *absorption_in_front_ = nullptr;
    std::shared_ptr<const std::vector<Part>> parts_;  // null but for blends
};

inline BsdfValue Bsdf::diffuse_value(const DiffuseBsdf& model, Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const {
    if (!(lobes & lobe::diffuse)) return {};
    const float pdf = diffuse_pdf(shading_.z, normal_, one_sided_, outgoing, incoming);
    return {model.albedo * pdf, pdf};
}

inline std::optional<BsdfSample> Bsdf::diffuse_sample(const DiffuseBsdf& model, Vec3 outgoing, Vec2 u,
                                                      std::uint8_t lobes) const {
    if (!(lobes & lobe::diffuse) || (one_sided_ && dot(outgoing, normal_) <= 0)) return {};
    const auto [incoming, pdf] = diffuse_step(frame_for(outgoing), normal_, outgoing, u);
    if (pdf == 0) return {};
    return BsdfSample{incoming, model.albedo, pdf, lobe::diffuse};
}

struct Bsdf::Part {
    Bsdf bsdf;
    float share = 1;
    SeenFrom from = SeenFrom::both;
};

}  // namespace lightnet
