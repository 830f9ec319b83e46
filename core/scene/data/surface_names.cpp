#include "core/scene/data/surface_names.hpp"

#include "core/scene/data/lamp_names.hpp"

namespace lightnet {
namespace {

std::string or_unnamed(const std::string& name) { return name.empty() ? std::string(unnamed) : name; }

const std::string& material_of(const SceneData& scene, const Shape& shape) {
    static const std::string none;
    return shape.material < scene.materials.size() ? scene.materials[shape.material].name : none;
}

}  // namespace

SurfaceNames surface_names(const SceneData& scene, NamedBy by) {
    SurfaceNames names;
    if (by == NamedBy::lamp) names.of_shape = lamp_names_of_shapes(scene);
    for (const auto& shape : scene.shapes) {
        const auto& material = material_of(scene, shape);
        const auto& mesh = shape.name.empty() ? material : shape.name;
        const bool stands_alone = by == NamedBy::object && !shape.node_name.empty();
        if (by == NamedBy::object || by == NamedBy::mesh)
            names.of_shape.push_back(or_unnamed(stands_alone ? shape.node_name : mesh));
        if (by == NamedBy::material) names.of_shape.push_back(or_unnamed(material));
    }
    for (const auto& instance : scene.instances) {
        const bool stands_alone = by == NamedBy::object && !instance.node_name.empty();
        const bool named = by == NamedBy::object || by == NamedBy::mesh;
        names.of_instance.push_back(stands_alone ? instance.node_name
                                    : named      ? scene.objects[instance.object].name
                                                 : "");
    }
    return names;
}

NamedBy named_by(std::string_view word) {
    if (word == "object") return NamedBy::object;
    if (word == "mesh") return NamedBy::mesh;
    if (word == "material") return NamedBy::material;
    if (word == "lamp") return NamedBy::lamp;
    throw Error("surfaces are called by object, mesh, material or lamp");
}

}  // namespace lightnet
