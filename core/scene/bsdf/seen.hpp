// Models of scattering as they are seen from one direction: formulas of one point and of many.
#pragma once

#include <cstdint>
#include <optional>

#include "core/base/math/vec.hpp"
#include "core/scene/bsdf/scattering.hpp"

namespace lightnet {

// A model that is shaded in columns as well has its formulas in a value that is the model from one direction: of(model,
// height of outgoing, lobes) makes it, and arriving(model, height of incoming) what depends on the other direction.
// Both look into tables, and consist of numbers as wide as a float. Directions are local, z > 0.
//   value<many>(outgoing, incoming, arriving): as evaluate() of the model
//   propose<many>(outgoing, choice, u): where sample() of the model goes
//   mirrored(choice): the weight of a mirror that was proposed
//   cosine_choices(): for which choices propose() goes by the cosine
// `many`: in loops over many points, where branches make no vectors; of one point nothing is worked out that is not
// needed.
// DECISIONS: one-formula

[[gnu::always_inline]] inline Vec3 chosen(bool first, Vec3 a, Vec3 b) {
    return {first ? a.x : b.x, first ? a.y : b.y, first ? a.z : b.z};
}
[[gnu::always_inline]] inline Rgb chosen(bool first, Rgb a, Rgb b) {
    return {first ? a.r : b.r, first ? a.g : b.g, first ? a.b : b.b};
}
/// What a model proposes: a direction above the surface, if its z is above 0.
struct Proposal {
    Vec3 incoming;
    std::uint32_t lobe;
};

/// sample() of a model.
template <class Seen>
std::optional<BsdfSample> sample_seen(const Seen& seen, const typename Seen::Model& model, Vec3 outgoing, float choice,
                                      Vec2 u) {
    const auto [incoming, by] = seen.template propose<false>(outgoing, choice, u);
    if (by == lobe::specular) return BsdfSample{incoming, seen.mirrored(choice), 0, lobe::specular};
    if (!(incoming.z > 0)) return {};
    return weighed({incoming, {}, 0, static_cast<std::uint8_t>(by)},
                   seen.template value<false>(outgoing, incoming, Seen::arriving(model, incoming.z)));
}

}  // namespace lightnet
