// How one point of a surface scatters light.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "core/bsdf/coated_conductor.hpp"
#include "core/bsdf/coated_diffuse.hpp"
#include "core/bsdf/conductor.hpp"
#include "core/bsdf/dielectric.hpp"
#include "core/bsdf/diffuse.hpp"
#include "core/bsdf/diffuse_transmission.hpp"
#include "core/bsdf/principled.hpp"
#include "core/bsdf/rough_diffuse.hpp"
#include "core/bsdf/scattering.hpp"
#include "core/light/query.hpp"
#include "core/math/frame.hpp"
#include "core/math/rgb.hpp"
#include "core/math/vec.hpp"

namespace lightnet {

/// Scattering at one point, textures already looked up. A value: make it, use it, drop it. Both directions are unit,
/// in world space and point away from the surface. Reflection stays on the geometric normal's side of the surface and
/// transmission goes to the other one, whatever the shading normal says, so that no light leaks.
class Bsdf {
public:
    /// The first three have nothing to choose from.
    using Model = std::variant<DiffuseBsdf, RoughDiffuseBsdf, ConductorBsdf, DielectricBsdf, ThinDielectricBsdf,
                               DiffuseTransmissionBsdf, CoatedDiffuseBsdf, CoatedConductorBsdf, PrincipledBsdf>;
    /// Some share of a surface; seen from one of its sides only, or from both.
    struct Part;

    Bsdf(const Frame& shading, Vec3 normal, const Model& model) : shading_(shading), normal_(normal), model_(model) {}
    /// A blend of others, whose shares sum up to 1 on each side.
    Bsdf(Vec3 normal, std::vector<Part> parts);

    /// Black from behind.
    void make_one_sided() { one_sided_ = true; }
    /// What lies behind the surface absorbs that much per metre. Keeps looking at it; blends have none.
    void fill_with(const Rgb* absorption) { absorption_ = absorption; }

    /// Which lobes the surface has.
    std::uint8_t lobes() const { return diffuse() ? lobe::diffuse : lobes_of_any(); }
    /// Does sample() look at its `choice`?
    bool chooses() const { return model_.index() > 2 || parts_; }
    /// f × |cos incoming| for the non-specular lobes among `lobes`, sr⁻¹; and the density with which sample() with the
    /// same `lobes` finds `incoming`, per steradian. Both exactly 0 for specular lobes.
    BsdfValue value_and_pdf(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const {
        const DiffuseBsdf* plain = diffuse();
        return plain ? diffuse_value(*plain, outgoing, incoming, lobes) : value_of_any(outgoing, incoming, lobes);
    }
    Rgb evaluate(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const {
        return value_and_pdf(outgoing, incoming, lobes).value;
    }
    float pdf(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const {
        return value_and_pdf(outgoing, incoming, lobes).pdf;
    }
    /// One direction of light, by importance. None: absorbed.
    std::optional<BsdfSample> sample(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const {
        const DiffuseBsdf* plain = diffuse();
        return plain ? diffuse_sample(*plain, outgoing, u, lobes) : sample_of_any(outgoing, choice, u, lobes);
    }
    /// What a way into `direction` leads through absorbs, per metre: of light on a way of that length exp(-it × length)
    /// is left. Null: nothing.
    const Rgb* absorption(Vec3 direction) const {
        return absorption_ && dot(direction, normal_) < 0 ? absorption_ : nullptr;
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
    BsdfValue diffuse_value(const DiffuseBsdf& plain, Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const;
    std::optional<BsdfSample> diffuse_sample(const DiffuseBsdf& plain, Vec3 outgoing, Vec2 u, std::uint8_t lobes) const;
    std::uint8_t lobes_of_any() const;
    BsdfValue value_of_any(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const;
    std::optional<BsdfSample> sample_of_any(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const;
    float chance_of(const Part& part, Vec3 outgoing, std::uint8_t lobes) const;
    BsdfValue blended_value(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const;
    std::optional<BsdfSample> blended_sample(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const;

    Frame shading_;
    Vec3 normal_;  // geometric
    Model model_;
    bool one_sided_ = false;
    const Rgb* absorption_ = nullptr;
    std::shared_ptr<const std::vector<Part>> parts_;  // null but for blends
};

// The same as of any other model, without what only those need: of the outgoing direction no more than its side counts.
inline BsdfValue Bsdf::diffuse_value(const DiffuseBsdf& plain, Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const {
    const float seen = dot(outgoing, normal_), lit = dot(incoming, normal_);
    if (one_sided_ && seen <= 0) return {};
    float from = dot(outgoing, shading_.z), to = dot(incoming, shading_.z);
    if ((seen > 0) != (from > 0)) [[unlikely]] {
        from = seen;
        to = lit;
    }
    if (from == 0 || (to > 0) != (lit > 0)) return {};
    return plain.evaluate({}, {0, 0, from < 0 ? -to : to}, lobes);
}

inline std::optional<BsdfSample> Bsdf::diffuse_sample(const DiffuseBsdf& plain, Vec3 outgoing, Vec2 u,
                                                      std::uint8_t lobes) const {
    const float seen = dot(outgoing, normal_);
    const bool agree = (seen > 0) == (dot(outgoing, shading_.z) > 0);
    const float from = agree ? dot(outgoing, shading_.z) : seen;
    Vec3 local = cosine_hemisphere(u);
    if (!(lobes & lobe::diffuse) || local.z <= 0 || from == 0 || (one_sided_ && seen <= 0)) return {};
    const float pdf = local.z * inverse_pi;
    if (from < 0) local.z = -local.z;
    const Vec3 incoming = normalize(agree ? shading_.to_world(local) : Frame::around(normal_).to_world(local));
    if ((local.z > 0) != (dot(incoming, normal_) > 0)) return {};
    return BsdfSample{incoming, plain.albedo, pdf, lobe::diffuse};
}

struct Bsdf::Part {
    Bsdf bsdf;
    float share = 1;
    enum class Face { both, front, back } face = Face::both;
};

}  // namespace lightnet
