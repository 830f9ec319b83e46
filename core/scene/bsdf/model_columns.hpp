// Models of many points as a structure of arrays.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "core/base/math/columns.hpp"
#include "core/base/math/lanes_of.hpp"
#include "core/scene/bsdf/seen.hpp"

namespace lightnet {

/// Models that are seen each from its own direction. see() comes before anything else, and arrive() before value():
/// they look into tables, and so are no part of loops.
template <class Seen>
class ModelColumns {
public:
    using Model = typename Seen::Model;

    void set(std::size_t i, const Model& model) { models_[i] = model; }
    const Model& model(std::size_t i) const { return models_[i]; }
    bool has_gloss(std::size_t i) const { return models_[i].lobes() & lobe::glossy; }
    /// All rough `lobes` that the model has, at least.
    void see(std::size_t i, float outgoing, std::uint8_t lobes) { seen_.set(i, Seen::of(models_[i], outgoing, lobes)); }
    void arrive(std::size_t i, float incoming) { arriving_.set(i, Seen::arriving(models_[i], incoming)); }

    /// As it is seen.
    [[gnu::always_inline]] Seen operator[](std::size_t i) const { return seen_[i]; }
    [[gnu::always_inline]] BsdfValue value(std::size_t i, Vec3 outgoing, Vec3 incoming) const {
        return seen_[i].template value<true>(outgoing, incoming, arriving_[i]);
    }

private:
    using Arriving = decltype(Seen::arriving(std::declval<const Model&>(), 0));

    std::array<Model, lanes> models_;
    LanesOf<Seen> seen_;
    LanesOf<Arriving> arriving_;
};

}  // namespace lightnet
