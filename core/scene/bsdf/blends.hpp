// Materials that are made of others.
#pragma once

#include <algorithm>
#include <array>

#include "core/scene/bsdf/material_inputs.hpp"

namespace lightnet {

/// From where a part of a blend is seen.
enum class SeenFrom { both, front, back };

/// One of the materials that a blend is made of. The shares of those that are seen from a side sum up to 1.
struct BlendPart {
    MaterialId material = 0;
    float share = 1;
    SeenFrom from = SeenFrom::both;
};

/// `first` or `second`, the latter with a share of `amount`. They may be mixtures, but must not lead back here.
struct MixtureMaterial {
    static constexpr const char* name = "mixture";
    MaterialId first = 0, second = 0;
    TextureId amount = 0;

    Transparency transparency() const { return Transparency::sheet; }  // a part may be
    std::array<BlendPart, 2> parts_at(const MaterialInputs& inputs) const {
        const float share = std::min(1.0f, inputs.colour(amount).r);
        return {BlendPart{first, 1 - share}, BlendPart{second, share}};
    }
};
void visit_members(Is<MixtureMaterial> auto& material, const auto& visit) {
    auto& [first, second, amount] = material;
    visit(first, second, amount);
}

/// One on the side of the normal, another behind; both opaque.
struct TwoFacedMaterial {
    static constexpr const char* name = "two-faced";
    MaterialId front = 0, back = 0;

    Transparency transparency() const { return Transparency::opaque; }
    std::array<BlendPart, 2> parts_at(const MaterialInputs&) const {
        return {BlendPart{front, 1, SeenFrom::front}, BlendPart{back, 1, SeenFrom::back}};
    }
};
void visit_members(Is<TwoFacedMaterial> auto& material, const auto& visit) {
    auto& [front, back] = material;
    visit(front, back);
}

}  // namespace lightnet
