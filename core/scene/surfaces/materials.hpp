// From materials as data to scattering at a point.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/scene/bsdf/bsdf.hpp"
#include "core/scene/bsdf/coats.hpp"
#include "core/scene/data/scene_data.hpp"
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
    /// Keeps looking at `data`. Throws Error where a material names what isn't there, or itself by way of others.
    explicit Materials(const SceneData& data);

    const MaterialNeeds& needs(MaterialId material) const { return made_[material].needs; }
    Bsdf bsdf(MaterialId material, const SurfacePoint& point) const;
    /// The same, made where it is to stay.
    void add_bsdf(MaterialId material, const SurfacePoint& point, std::vector<Bsdf>& to) const {
        const Made& made = made_[material];
        if (made.simple)
            to.emplace_back(point.shading, point.normal, *made.plain);
        else
            to.push_back(bsdf(material, point));
    }
    /// Is it diffuse and nothing else?
    bool is_plain(MaterialId material) const;
    /// Reflectance of a plain one; null: it depends on the place.
    const Rgb* plain_albedo(MaterialId material) const;
    Rgb albedo(MaterialId material, const TexturePlace& place) const;
    /// Share of the light that meets the surface.
    float opacity(MaterialId material, const TexturePlace& place) const;

private:
    struct Made {
        MaterialNeeds needs;
        std::optional<Bsdf::Model> plain;  // the same everywhere
        const Coat* coat = nullptr;        // of coated models
        const CoatedMetal* coated_metal = nullptr;
        bool simple = false;  // `plain` is all there is to it
        bool bumpy = false;   // normal or bump map
        float step = 0;       // of texture coordinates, over which a bump map is taken to be straight
        bool filled = false;  // with what absorbs
    };
    MaterialNeeds needs_of(MaterialId material) const;
    Made made_of(MaterialId material);
    Bsdf blend(MaterialId material, const SurfacePoint& point) const;
    Bsdf::Model model_at(MaterialId material, const TexturePlace& place) const;

    const SceneData& data_;
    Coats coats_;
    std::vector<Made> made_;
};

}  // namespace lightnet
