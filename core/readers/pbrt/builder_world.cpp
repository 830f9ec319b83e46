// The Builder's statements behind WorldBegin: materials, lights, shapes, instances.
#include <fmt/format.h>

#include <utility>

#include "core/base/suggestion.hpp"
#include "core/readers/files/files.hpp"
#include "core/readers/pbrt/builder.hpp"
#include "core/readers/pbrt/materials.hpp"
#include "core/readers/pbrt/older_materials.hpp"
#include "core/readers/pbrt/transforms.hpp"
#include "core/scene/reach.hpp"
#include "core/scene/surfaces/placement.hpp"

namespace lightnet::pbrt {

Material Builder::material_of(const std::string& type, Parameters& parameters) {
    parameters.inherit(state().defaults["material"]);
    const auto find = [&](const std::string& name) { return materials_.made(name); };
    const auto measured = [&](const std::string& name, const SourceLine& where) {
        const std::string path = sources_.path(name);
        return measurements_.get(path, where, [&] { return sources_.files.read(path); });
    };
    // whoever asked puts it at the end of the scene's
    const auto fill = [&](Medium medium) {
        waiting_.fill(static_cast<MaterialId>(scene_.materials.size()), media_.add(std::move(medium)));
    };
    Material material;
    if (sources_.older()) {
        const auto add = [&](Material part) {
            scene_.materials.push_back(std::move(part));
            return static_cast<MaterialId>(scene_.materials.size() - 1);
        };
        material = make_older_material(type, parameters, {{textures_, find, measured, fill}, add});
    } else {
        material = make_material(type, parameters, {textures_, find, measured, fill});
    }
    parameters.warn_unused();
    return material;
}

void Builder::material(Statement& s) {
    state().material = materials_.use(material_of(s.names[0], s.parameters), s.where);
}

void Builder::make_named_material(Statement& s) {
    const std::string& name = s.names[0];
    const std::string type = s.parameters.text("type", "");
    if (sources_.older() && materials_.made(name)) {
        s.parameters.warn("a material of that name is there already: from here on this one is meant");
        materials_.forget(name);
    }
    const std::size_t use = materials_.use(name, s.where);
    if (!s.parameters.find("type")) {
        s.parameters.error("parameter 'type' is missing");
        return materials_.give_up(use);
    }
    Material material = material_of(type, s.parameters);
    if (materials_.made(use)) s.parameters.error("a material of that name is there already");
    material.name = name;
    materials_.make(use, std::move(material));
}

// pbrt looks names up at the end, so a material may be named before it is made
void Builder::named_material(Statement& s) { state().material = materials_.use(s.names[0], s.where); }

void Builder::texture(Statement& s) {
    s.parameters.inherit(state().defaults["texture"]);
    textures_.define(s.names[0], s.names[1], s.names[2], to_world(), s.parameters);
    s.parameters.warn_unused();
}

void Builder::area_light(Statement& s) {
    s.parameters.inherit(state().defaults["light"]);
    state().lamp = make_area_light(s.names[0], s.parameters, textures_, sources_);
    s.parameters.warn_unused();
}

void Builder::light(Statement& s) {
    s.parameters.inherit(state().defaults["light"]);
    const bool everywhere = s.names[0] == "infinite" && !s.parameters.find("filename") && !s.parameters.find("mapname");
    const Matrix placed = to_world();
    if (!everywhere && !inverse(placed))
        return s.parameters.warn("it stands under a singular transform, and is left out");
    const std::size_t before = scene_.lights.size();
    add_light(s.names[0], s.parameters, textures_, sources_, placed, scene_);
    if (scene_.lights.size() > before && !in_reach(scene_.lights.back())) s.parameters.error("it stands out of reach");
    s.parameters.warn_unused();
}

void Builder::shape(Statement& s) {
    s.parameters.inherit(state().defaults["shape"]);
    const Matrix placed = to_world();
    const auto from_world = inverse(placed);
    if (!from_world) return s.parameters.warn("it stands under a singular transform, and is left out");
    WaitingShape shape;
    shape.alpha = alpha_of(s.parameters);
    const auto everywhere = shape.alpha ? textures_.constant_value(*shape.alpha) : std::nullopt;
    shape.nowhere = everywhere && everywhere->r <= 0;
    if (sources_.older() && s.parameters.find("shadowalpha"))
        s.parameters.warn("'shadowalpha' is left out: the shape throws the whole shadow of what is there");
    const Placement placement{placed, *from_world, state().reversed};
    const auto heights = s.names[0] == "plymesh" ? textures_.maybe_number(s.parameters, "displacement") : std::nullopt;
    shape.made = shapes_.make(s.names[0], s.parameters, placement, heights);
    shape.turned = placement.flips();
    s.parameters.warn_unused();
    if (!shape.made) return;
    if (state().lamp && objects_.open())
        s.parameters.warn("lamps inside of an object don't shine (as in pbrt)");
    else
        shape.lamp = state().lamp;
    shape.lamp_per_triangle = s.names[0] == "trianglemesh" || s.names[0] == "plymesh";
    shape.material = state().material;
    shape.inside = state().inside;
    shape.outside = state().outside;
    shape.object = objects_.open();
    shape.owner = s.parameters.owner();
    shape.name = stem_of(s.names[0] == "plymesh" ? s.parameters.file("filename") : "");
    shape.where = s.where;
    waiting_.add(std::move(shape));
}

/// None: opaque.
std::optional<TextureId> Builder::alpha_of(Parameters& parameters) {
    const auto alpha = textures_.maybe_number(parameters, "alpha");
    const auto everywhere = alpha ? textures_.constant_value(*alpha) : std::nullopt;
    return everywhere && everywhere->r >= 1 ? std::nullopt : alpha;
}

}  // namespace lightnet::pbrt
