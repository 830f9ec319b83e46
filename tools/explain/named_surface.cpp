#include "tools/explain/named_surface.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "core/base/printable.hpp"

namespace lightnet {

NamedSurface named_surface(const Scene& scene, const Hit& hit) {
    const SceneData& data = scene.data();
    const Shape& shape = data.shapes[hit.geometry];
    const Material& material = data.materials[shape.material];
    NamedSurface named;
    named.position = scene.surface(hit).position;
    named.shape = shape.name.empty() ? fmt::format("shape {}", hit.geometry) : printable(shape.name);
    named.material = std::visit([](const auto& model) { return std::string(model.name); }, material.model);
    if (!material.name.empty()) named.material = printable(material.name) + ", " + named.material;
    if (shape.emission) named.material += ", shines";
    if (hit.instance != Query::no_instance)
        named.object = fmt::format("instance {} of '{}'", hit.instance,
                                   printable(data.objects[data.instances[hit.instance].object].name));
    if (!shape.where.file.empty())
        named.where = fmt::format("{}:{}", printable(std::filesystem::path(shape.where.file).filename().string()),
                                  shape.where.line);
    return named;
}

NamedSurface named_point(const Scene& scene, const Query& question) {
    if (!question.is_in_space()) return named_surface(scene, scene.hit(question));
    const auto& media = scene.data().media;
    const Medium* medium = question.medium < media.size() ? &media[question.medium] : nullptr;
    const bool has_name = medium && !medium->name.empty();
    NamedSurface named;
    named.position = question.place_in_space();
    named.shape = has_name ? printable(medium->name) : fmt::format("medium {}", question.medium);
    named.material = "V, a collision in a medium";
    return named;
}

std::string to_string(Vec3 position) {
    return fmt::format("{:.5g}, {:.5g}, {:.5g}", position.x, position.y, position.z);
}

std::string to_string(const NamedSurface& surface) {
    return fmt::format("{}{}{} ({}) at {}", surface.shape, surface.object.empty() ? "" : " in " + surface.object,
                       surface.where.empty() ? "" : " [" + surface.where + "]", surface.material,
                       to_string(surface.position));
}

}  // namespace lightnet
