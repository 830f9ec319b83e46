#include "core/scene/scene_size.hpp"

#include "core/scene/data/contents.hpp"

namespace lightnet {
namespace {

template <class T>
std::size_t bytes_of(const std::vector<T>& values) {
    return values.capacity() * sizeof(T);
}

std::size_t texture_bytes(const SceneData& data) {
    std::size_t bytes = bytes_of(data.textures);
    for (const Image* image : images_of(data)) bytes += image->memory();
    return bytes;
}

}  // namespace

SceneSize size_of(const SceneData& data, const Geometry& geometry, const Lights& lights) {
    SceneSize size;
    std::vector<bool> in_object(data.shapes.size());
    for (const auto& object : data.objects)
        for (const auto shape : object.shapes) in_object[shape] = true;
    for (std::size_t s = 0; s < data.shapes.size(); ++s) {
        size.triangles += triangles_of(data.shapes[s]);
        size.instanced_triangles += in_object[s] ? 0 : triangles_of(data.shapes[s]);
        size.shape_bytes += memory_of(data.shapes[s].geometry);
    }
    for (const auto& instance : data.instances)
        for (const auto shape : data.objects[instance.object].shapes)
            size.instanced_triangles += triangles_of(data.shapes[shape]);
    size.lights = lights.count();
    size.tree_bytes = geometry.memory();
    size.texture_bytes = texture_bytes(data);
    size.light_bytes = lights.memory();
    return size;
}

}  // namespace lightnet
