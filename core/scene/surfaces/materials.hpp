// From materials as data to scattering at a point.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/scene/bsdf/bsdf.hpp"
#include "core/scene/bsdf/coats.hpp"
#include "core/scene/data/scene_data.hpp"
#include "core/scene/surfaces/column_shape.hpp"
#include "core/scene/surfaces/surface.hpp"
#include "core/scene/textures/look_up.hpp"

namespace lightnet {

/// What a material wants to know of a point.
struct MaterialNeeds {
    bool texture = false;  // texture coordinates, vertex colours
    bool tangent = false;  // a frame along the texture, and how fast the surface runs along u and v
    bool holes = false;    // its opacity is below 1 somewhere

    friend MaterialNeeds operator|(MaterialNeeds a, MaterialNeeds b) {
        return {a.texture || b.texture, a.tangent || b.tangent, a.holes || b.holes};
    }
};

/// The materials of a scene. Any thread may ask.
class Materials {
public:
    /// Keeps looking at `data`. Throws Error as check_textures() and check_materials() do.
    explicit Materials(const SceneData& data);

    const MaterialNeeds& needs(MaterialId material) const { return made_[material].needs; }
    Bsdf bsdf(MaterialId material, const SurfacePoint& point) const;
    /// The same, made where it is to stay.
    void add_bsdf(MaterialId material, const SurfacePoint& point, std::vector<Bsdf>& to) const {
        const Made& made = made_[material];
        if (made.simple)
            to.emplace_back(point.shading, point.normal, *made.constant);
        else
            to.push_back(bsdf(material, point));
    }
    /// How its points are shaded many at once, if they are.
    ColumnShape::Kind column_kind(MaterialId material) const;
    /// The same everywhere; null: it depends on the place.
    const Bsdf::Model* constant_model(MaterialId material) const {
        return made_[material].constant ? &*made_[material].constant : nullptr;
    }
    /// Bsdf::lobes() at all of its points; 0: that depends on the place.
    std::uint8_t lobes(MaterialId material) const { return made_[material].lobes; }
    /// Reflectance of a Lambertian one.
    Rgb albedo(MaterialId material, const TexturePlace& place) const;
    /// Of a material whose models are of this one kind alone.
    CoatedDiffuseBsdf coated(MaterialId material, const TexturePlace& place) const;
    ConductorBsdf metal(MaterialId material, const TexturePlace& place) const;
    /// Fetches from memory what bsdf() and albedo() will read of pictures there.
    [[gnu::always_inline]] void expect(MaterialId material, Vec2 uv) const {
        for (const ImageTexture* picture : made_[material].pictures) {
            const auto [upper, lower] = lines_of(*picture, uv);
            __builtin_prefetch(upper);
            __builtin_prefetch(lower);
        }
    }
    /// Share of the light that meets the surface.
    float opacity(MaterialId material, const TexturePlace& place) const;

private:
    struct Made {
        MaterialNeeds needs;
        std::optional<Bsdf::Model> constant;  // the same everywhere
        Coating coating;                      // of coated models
        bool done = false;
        bool simple = false;  // `constant` is all there is to it
        bool bumpy = false;   // normal or bump map
        float step = 0;       // of texture coordinates, over which a bump map is taken to be straight
        bool filled = false;  // with what absorbs
        std::uint8_t lobes = 0;
        std::vector<const ImageTexture*> pictures;  // all that it looks into
    };
    void make(MaterialId material);
    std::uint8_t lobes_everywhere(MaterialId material) const;
    MaterialNeeds needs_of(MaterialId material);
    Bsdf blend(std::span<const BlendPart> parts, const SurfacePoint& point) const;

    const SceneData& data_;
    Coats coats_;
    std::vector<Made> made_;
};

}  // namespace lightnet
