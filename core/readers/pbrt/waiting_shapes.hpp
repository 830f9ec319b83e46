// Shapes that were asked for, until all that they name is there.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/readers/pbrt/lights.hpp"
#include "core/readers/pbrt/material_uses.hpp"
#include "core/readers/pbrt/media.hpp"
#include "core/readers/pbrt/shapes.hpp"
#include "core/readers/pbrt/sources.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet::pbrt {

/// A shape with all that was said of it.
struct WaitingShape {
    std::shared_ptr<MadeShape> made;
    std::size_t material = 0;  // of MaterialUses
    std::optional<TextureId> alpha;
    bool nowhere = false;  // alpha leaves nothing of it; pbrt lets a lamp shine all the same
    std::optional<AreaLight> lamp;
    std::string inside, outside;     // names of its media; "": none
    bool turned = false;             // its normal is against the one that the shape has by itself
    bool lamp_per_triangle = false;  // for pbrt every triangle of a mesh is a lamp of its own
    std::optional<std::uint32_t> object;
    std::string owner;  // for messages
    std::string name;   // of its file, or of its object
    SourceLine where;
};

/// Puts them into the scene at its end, in their order.
class WaitingShapes {
public:
    WaitingShapes(const Sources& sources, SceneData& scene, const MaterialUses& materials, Media& media)
        : sources_(sources), scene_(scene), materials_(materials), media_(media) {}

    void add(WaitingShape shape) { waiting_.push_back(std::move(shape)); }
    /// A material brings along what fills its shapes.
    void fill(MaterialId material, std::uint16_t medium) { fillings_[material] = medium; }
    /// Those whose meshes are to be moved along their normals first.
    std::vector<MadeShape*> displaced() const;
    /// Once textures, meshes and materials are there. `around`: the camera's medium, named in `where`.
    void finish(const std::string& around, const SourceLine& where);

private:
    void check_medium(const std::string& name, const SourceLine& where);
    void find_media(const std::string& around, const SourceLine& where);
    void finish(WaitingShape& waiting);
    std::uint16_t filling_of(MaterialId material) const;
    std::optional<MediumSides> sides_of(const WaitingShape& waiting) const;
    MaterialId filled(MaterialId material, const WaitingShape& waiting);
    MaterialId with_alpha(MaterialId material, TextureId alpha);
    void emit(Shape shape, const WaitingShape& waiting);
    void add_shape(Shape shape, const std::optional<std::uint32_t>& object);
    bool add_to_curves(const Shape& shape);

    const Sources& sources_;
    SceneData& scene_;
    const MaterialUses& materials_;
    Media& media_;
    std::vector<WaitingShape> waiting_;
    std::map<MaterialId, std::uint16_t> fillings_;
    std::map<std::pair<MaterialId, TextureId>, MaterialId> with_alpha_;
    std::map<std::tuple<MaterialId, std::string, std::string, bool>, MaterialId> filled_;
    std::optional<std::uint32_t> joined_;  // the object of the last shape
};

}  // namespace lightnet::pbrt
