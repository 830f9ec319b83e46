#include "core/bsdf/bsdf.hpp"

#include <type_traits>

namespace lightnet {
namespace {

template <class Model>
constexpr bool looks_alike = std::decay_t<Model>::two_sided;

}  // namespace

// Where the shading normal turns away from a viewer who sees the surface, the geometric one takes its place; the
// surface would be black there otherwise.
Frame Bsdf::frame_for(Vec3 outgoing) const {
    const bool agree = (dot(outgoing, normal_) > 0) == (dot(outgoing, shading_.z) > 0);
    return agree ? shading_ : Frame::around(normal_);
}

std::uint8_t Bsdf::lobes() const {
    return std::visit([](const auto& model) { return model.lobes(); }, model_);
}

BsdfValue Bsdf::value_and_pdf(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const {
    const Frame frame = frame_for(outgoing);
    Vec3 o = frame.to_local(outgoing), i = frame.to_local(incoming);
    if (o.z == 0 || (i.z > 0) != (dot(incoming, normal_) > 0)) return {};
    return std::visit(
        [&](const auto& model) {
            if (looks_alike<decltype(model)> && o.z < 0) {
                o.z = -o.z;
                i.z = -i.z;
            }
            return model.evaluate(o, i, lobes);
        },
        model_);
}

std::optional<BsdfSample> Bsdf::sample(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const {
    const Frame frame = frame_for(outgoing);
    Vec3 o = frame.to_local(outgoing);
    if (o.z == 0) return {};
    auto result = std::visit(
        [&](const auto& model) {
            const bool flip = looks_alike<decltype(model)> && o.z < 0;
            if (flip) o.z = -o.z;
            auto found = model.sample(o, choice, u, lobes);
            if (found && flip) found->incoming.z = -found->incoming.z;
            return found;
        },
        model_);
    if (!result) return {};
    const bool above = result->incoming.z > 0;
    result->incoming = normalize(frame.to_world(result->incoming));
    if (above != (dot(result->incoming, normal_) > 0)) return {};
    return result;
}

}  // namespace lightnet
