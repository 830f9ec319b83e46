// Materials made ready: from data to scattering at a point.
#pragma once

#include <concepts>
#include <memory>
#include <optional>
#include <span>
#include <variant>
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
    bool tangent = false;  // how fast the surface runs along u and v
    bool grooves = false;  // the same, and a frame along u
    bool holes = false;    // its opacity is below 1 somewhere

    friend MaterialNeeds operator|(MaterialNeeds a, MaterialNeeds b) {
        return {a.texture || b.texture, a.tangent || b.tangent, a.grooves || b.grooves, a.holes || b.holes};
    }
};

/// The materials of a scene. Any thread may ask.
class Materials {
public:
    /// Keeps looking at `data`. Throws Error as check_textures() and check_materials() do.
    explicit Materials(const SceneData& data);

    const MaterialNeeds& needs(MaterialId material) const { return made_[material].needs; }
    Bsdf bsdf(MaterialId material, const SurfacePoint& point) const;
    /// Appends how a material scatters at a point, made where it is to stay.
    void add_bsdf(MaterialId material, const SurfacePoint& point, std::vector<Bsdf>& to) const {
        const Made& made = made_[material];
        if (made.simple)
            to.emplace_back(point.shading, point.normal, *made.constant);
        else
            to.push_back(bsdf(material, point));
    }
    /// How its points are shaded many at once, if they are.
    ColumnShape::Kind column_kind(MaterialId material) const;
    /// How a material scatters that is alike everywhere; null: it depends on the place.
    const Bsdf::Model* constant_model(MaterialId material) const {
        return made_[material].constant ? &*made_[material].constant : nullptr;
    }
    /// Bsdf::lobes() at all of its points; 0: that depends on the place.
    std::uint8_t lobes(MaterialId material) const { return made_[material].lobes; }
    /// Has it a normal or bump map?
    bool bumpy(MaterialId material) const { return made_[material].bumpy; }
    /// By such a map: the shading normal there, on the side of the geometric one.
    Vec3 bumpy_normal(MaterialId material, const SurfacePoint& point) const;
    /// Reflectance of a Lambertian one.
    Rgb albedo(MaterialId material, const TexturePlace& place) const;
    /// Of a material whose models are of this one kind alone.
    template <class Model>
    Model model(MaterialId material, const TexturePlace& place) const;
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
        bool bumpy = false;
        float step = 0;       // of texture coordinates, over which a bump map is taken to be straight
        bool filled = false;  // with what absorbs
        bool handed = false;  // its grooves may be turned: its frame is as left-handed as texture coordinates are
        const PrincipledCoatNormal* coat = nullptr;  // its coat has a normal of its own
        bool hair_by_v = false;                      // it is hair, and v goes across what is seen of a fibre
        std::uint8_t lobes = 0;
        std::vector<const ImageTexture*> pictures;  // all that it looks into
    };
    void make(MaterialId material);
    std::uint8_t lobes_everywhere(MaterialId material) const;
    MaterialNeeds needs_of(MaterialId material);
    Frame frame_at(MaterialId material, const SurfacePoint& point) const;
    Bsdf::Model fitted(MaterialId material, const Bsdf::Model& model, const Frame& frame,
                       const SurfacePoint& point) const;
    Frame bumpy_frame(MaterialId material, const SurfacePoint& point) const;
    Bsdf blend(std::span<const BlendPart> parts, const SurfacePoint& point) const;

    const SceneData& data_;
    Coats coats_;
    std::vector<Made> made_;
};

template <class Model>
Model Materials::model(MaterialId id, const TexturePlace& place) const {
    const MaterialInputs inputs(data_.textures, place, made_[id].coating);
    return std::visit(
        [&]<class M>(const M& material) -> Model {
            if constexpr (std::same_as<typename ScatteringOf<M>::type, Model>)
                return material.at(inputs);
            else
                throw std::bad_variant_access();
        },
        data_.materials[id].model);
}

}  // namespace lightnet
