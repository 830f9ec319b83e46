// The Builder's statements behind WorldBegin: materials, lights, shapes, instances.
#include <fmt/format.h>

#include <utility>

#include "core/scene/pbrt/builder.hpp"
#include "core/scene/pbrt/materials.hpp"
#include "core/scene/pbrt/transforms.hpp"
#include "core/suggestion.hpp"

namespace lightnet::pbrt {
namespace {

/// What it takes of memory, counted in vertices and triangles.
std::uint64_t size_of(const Shape& shape) {
    constexpr std::uint64_t least = 16;
    const auto* mesh = std::get_if<Mesh>(&shape.geometry);
    return least + (mesh ? mesh->triangles.size() + mesh->positions.size() : 0);
}

/// One triangle of a mesh, alone.
Mesh single(const Mesh& mesh, std::size_t triangle) {
    Mesh result;
    result.flip_normals = mesh.flip_normals;
    for (const auto i : mesh.triangles[triangle]) {
        result.positions.push_back(mesh.positions[i]);
        if (!mesh.normals.empty()) result.normals.push_back(mesh.normals[i]);
        if (!mesh.uvs.empty()) result.uvs.push_back(mesh.uvs[i]);
    }
    result.triangles.push_back({0, 1, 2});
    return result;
}

}  // namespace

Material Builder::material_of(const std::string& type, Parameters& parameters) {
    parameters.inherit(state_.defaults["material"]);
    const auto find = [&](const std::string& name) -> const Material* {
        const auto found = named_.find(name);
        return found != named_.end() && found->second.made ? &scene_.materials[found->second.index] : nullptr;
    };
    Material material = make_material(type, parameters, {textures_, scene_, find});
    parameters.warn_unused();
    return material;
}

void Builder::material(Statement& s) {
    const std::string& type = s.names[0];
    state_.material = static_cast<std::uint32_t>(scene_.materials.size());
    interfaces_.push_back(is_interface(type));
    scene_.materials.push_back(interfaces_.back() ? scene_.materials[0] : material_of(type, s.parameters));
}

Builder::Named& Builder::named(const std::string& name, const SourceLine& where) {
    const auto [place, fresh] = named_.try_emplace(name);
    if (fresh) {
        place->second = {static_cast<std::uint32_t>(scene_.materials.size()), false, where};
        scene_.materials.push_back(scene_.materials[0]);
        interfaces_.push_back(false);
    }
    return place->second;
}

void Builder::make_named_material(Statement& s) {
    const std::string& name = s.names[0];
    const std::string type = s.parameters.text("type", "");
    if (!s.parameters.find("type")) {
        s.parameters.error("parameter 'type' is missing");
        named(name, s.where).made = true;
        return;
    }
    Material material = is_interface(type) ? scene_.materials[0] : material_of(type, s.parameters);
    Named& place = named(name, s.where);
    if (place.made) s.parameters.error("a material of that name is there already");
    place.made = true;
    material.name = name;
    interfaces_[place.index] = is_interface(type);
    scene_.materials[place.index] = std::move(material);
}

// pbrt looks names up at the end, so a material may be named before it is made
void Builder::named_material(Statement& s) { state_.material = named(s.names[0], s.where).index; }

void Builder::texture(Statement& s) {
    s.parameters.inherit(state_.defaults["texture"]);
    textures_.define(s.names[0], s.names[1], s.names[2], s.parameters);
    s.parameters.warn_unused();
}

void Builder::area_light(Statement& s) {
    s.parameters.inherit(state_.defaults["light"]);
    state_.lamp = make_area_light(s.names[0], s.parameters, textures_, sources_);
    s.parameters.warn_unused();
}

void Builder::light(Statement& s) {
    s.parameters.inherit(state_.defaults["light"]);
    if (const auto light = make_light(s.names[0], s.parameters, textures_, sources_))
        scene_.environments.push_back(*light);
    s.parameters.warn_unused();
}

void Builder::shape(Statement& s) {
    s.parameters.inherit(state_.defaults["shape"]);
    const auto from_world = inverse(state_.to_world);
    if (!from_world) {
        s.parameters.error("the transform is singular");
        return;
    }
    auto geometry = make_shape(s.names[0], s.parameters, sources_, {state_.to_world, *from_world, state_.reversed});
    s.parameters.warn_unused();
    if (!geometry) return;
    Shape shape{std::move(*geometry), state_.material, std::nullopt, s.where};
    if (state_.lamp && open_object_)
        s.parameters.warn("lamps inside of an object don't shine (as in pbrt)");
    else if (state_.lamp && interfaces_[state_.material])
        s.parameters.warn("a lamp with the material 'interface' doesn't shine (as in pbrt)");
    else if (state_.lamp)
        return emit(std::move(shape), *state_.lamp, s.names[0] == "trianglemesh" || s.names[0] == "plymesh");
    add_shape(std::move(shape));
}

/// `each_triangle`: for pbrt every triangle of a mesh is a lamp of its own, with the power that was asked for.
void Builder::emit(Shape shape, const AreaLight& lamp, bool each_triangle) {
    constexpr std::size_t most_lamps = 1 << 16;
    const auto* mesh = std::get_if<Mesh>(&shape.geometry);
    const double area = area_of(shape.geometry);
    if (!lamp.power || !each_triangle || !mesh) {
        shape.emission = lamp.on(area);
        return add_shape(std::move(shape));
    }
    if (mesh->triangles.size() > most_lamps) {
        sources_.report.warn(shape.where, "the power of so many triangles is spread evenly over all of them");
        shape.emission = lamp.on(area / double(mesh->triangles.size()));
        return add_shape(std::move(shape));
    }
    for (std::size_t i = 0; i < mesh->triangles.size(); ++i) {
        Shape one{single(*mesh, i), shape.material, std::nullopt, shape.where};
        one.emission = lamp.on(area_of(one.geometry));
        add_shape(std::move(one));
    }
}

bool Builder::room_for(const Shape& shape, const SourceLine& where) {
    constexpr std::uint64_t most = std::uint64_t{1} << 27;  // about 4 GB, and as much again in Embree
    const std::uint64_t more = size_of(shape);
    if (size_ + more <= most) {
        size_ += more;
        return true;
    }
    if (size_ <= most)
        sources_.report.error(where, "the scene has more than 2^27 vertices and triangles, its instances counted");
    size_ = most + 1;
    return false;
}

void Builder::add_shape(Shape shape) {
    if (const auto* mesh = std::get_if<Mesh>(&shape.geometry); mesh && mesh->triangles.empty()) {
        sources_.report.warn(shape.where, "a shape without any triangle is left out");
        return;
    }
    if (!room_for(shape, shape.where)) return;
    (open_object_ ? open_object_->shapes : scene_.shapes).push_back(std::move(shape));
}

// Only now, as a material may be made after it was named.
void Builder::drop_interfaces() {
    std::erase_if(scene_.shapes, [&](const Shape& shape) {
        if (!interfaces_[shape.material]) return false;
        sources_.report.warn(shape.where, "a shape of the material 'interface' only bounds media, and is left out");
        return true;
    });
}

void Builder::object_begin(Statement& s) {
    if (open_object_) {
        sources_.report.error(s.where, "ObjectBegin inside of another object");
        return;
    }
    push(Block::object, s.where);
    const auto [place, fresh] = objects_.try_emplace(s.names[0]);
    if (!fresh) sources_.report.error(s.where, fmt::format("there is an object '{}' already", s.names[0]));
    open_object_ = &place->second;
}

void Builder::object_end(Statement& s) {
    if (pop(Block::object, "ObjectBegin", s.where)) open_object_ = nullptr;
}

// Embree could share the triangles of instances; for now each gets its own copy.
void Builder::object_instance(Statement& s) {
    const auto found = objects_.find(s.names[0]);
    const auto from_world = inverse(state_.to_world);
    if (found == objects_.end() || open_object_ || !from_world) {
        std::vector<std::string> known;
        for (const auto& [name, object] : objects_) known.push_back(name);
        sources_.report.error(s.where, open_object_  ? "ObjectInstance inside of an object"
                                       : !from_world ? "the transform is singular"
                                                     : fmt::format("there is no object '{}'{}", s.names[0],
                                                                   did_you_mean(s.names[0], known)));
        return;
    }
    for (const auto& shape : found->second.shapes) {
        if (!room_for(shape, s.where)) return;
        scene_.shapes.push_back(
            {moved(shape.geometry, {state_.to_world, *from_world}), shape.material, std::nullopt, shape.where});
    }
}

}  // namespace lightnet::pbrt
