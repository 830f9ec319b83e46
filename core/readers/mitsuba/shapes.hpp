// Mitsuba's shapes.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/readers/mitsuba/bsdfs.hpp"
#include "core/readers/mitsuba/media.hpp"

namespace lightnet::mitsuba {

/// Adds the shapes of one scene to it.
class Shapes {
public:
    Shapes(Bsdfs& bsdfs, Textures& textures, Media& media)
        : bsdfs_(bsdfs), textures_(textures), media_(media), context_(textures.context()) {}

    /// A <shape> that stands in the scene: with its bsdf and its lamp, or an instance.
    void add(const Node& node);

private:
    /// What the shape is, in the world.
    std::optional<ShapeGeometry> geometry(Properties& properties);
    std::optional<ShapeGeometry> round(Properties& properties);
    std::optional<Mesh> file(Properties& properties);
    std::optional<Mesh> decoded(Properties& properties, const Node& name, bool& face_normals,
                                std::vector<Rgb>& of_triangles);
    std::string attribute_of(const Node& shape) const;
    std::optional<ShapeGeometry> cylinder(Properties& properties);
    std::optional<ShapeGeometry> curves(Properties& properties);
    std::optional<ShapeGeometry> stood(Properties& properties, Quadric quadric, const Matrix& own);
    std::optional<Mesh> placed(Properties& properties, Mesh mesh);

    std::optional<std::uint32_t> shape(const Node& node, bool in_group);
    MaterialId material(Properties& properties, bool lamp);
    std::optional<AreaEmission> emission(Properties& properties);
    bool absorb(Properties& properties, MaterialId& id);
    bool shine_alone(const Node& shape, bool fills, MaterialId& id, AreaEmission& emission) const;
    std::vector<const Node*> merged(const Node& shape, int depth) const;
    void instance(Properties& properties);
    std::optional<std::uint32_t> group(const Node& node);

    Bsdfs& bsdfs_;
    Textures& textures_;
    Media& media_;
    const Context& context_;
    std::map<const Node*, std::uint32_t> groups_;  // → objects of the scene
    std::uint64_t size_ = 0;                       // so far, in triangles
};

}  // namespace lightnet::mitsuba
