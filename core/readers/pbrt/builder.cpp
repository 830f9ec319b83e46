#include "core/readers/pbrt/builder.hpp"
#include "core/base/unwanted.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/suggestion.hpp"
#include "core/readers/pbrt/transforms.hpp"

namespace lightnet::pbrt {
namespace {

enum class Part { anywhere, before_world, in_world };

Part part_of(const std::string& directive) {
    static const std::map<std::string, Part> parts{
        {"Accelerator", Part::before_world}, {"Camera", Part::before_world},      {"Film", Part::before_world},
        {"Integrator", Part::before_world},  {"PixelFilter", Part::before_world}, {"Sampler", Part::before_world},
        {"WorldBegin", Part::before_world},  {"AreaLightSource", Part::in_world}, {"AttributeBegin", Part::in_world},
        {"AttributeEnd", Part::in_world},    {"LightSource", Part::in_world},     {"MakeNamedMaterial", Part::in_world},
        {"Material", Part::in_world},        {"NamedMaterial", Part::in_world},   {"ObjectBegin", Part::in_world},
        {"ObjectEnd", Part::in_world},       {"ObjectInstance", Part::in_world},  {"Shape", Part::in_world},
        {"Texture", Part::in_world}};
    const auto found = parts.find(directive);
    return found == parts.end() ? Part::anywhere : found->second;
}

}  // namespace

Builder::Builder(const Sources& sources, std::optional<double> seconds)
    : sources_(sources),
      pictures_(sources_, thread_pool_),
      textures_(sources_, scene_, pictures_),
      measurements_(sources_.report),
      shapes_(sources_, thread_pool_),
      media_(sources_, scene_),
      materials_(sources_, scene_, {"", DiffuseMaterial{textures_.constant({0.5f, 0.5f, 0.5f}), 0, std::nullopt}}),
      waiting_(sources_, scene_, materials_, media_),
      blocks_(sources_),
      objects_(sources_, scene_, blocks_),
      eye_(sources_.version),
      transforms_(sources_.report),
      seconds_(seconds) {
    scene_.film.width = sources_.older() ? 640 : 1280, scene_.film.height = sources_.older() ? 480 : 720;
}

const std::map<std::string, Builder::Handler>& Builder::handlers() {
    const Handler ignored = [](Builder&, Statement&) {};  // how images are sampled is the graph's business
    static const std::map<std::string, Handler> table{
        {"Accelerator", ignored},
        {"AreaLightSource", call<&Builder::area_light>},
        {"Attribute", call<&Builder::attribute>},
        {"AttributeBegin", [](Builder& b, Statement& s) { b.blocks_.begin(Blocks::Kind::attribute, s.where); }},
        {"AttributeEnd",
         [](Builder& b, Statement& s) { b.blocks_.end(Blocks::Kind::attribute, "AttributeBegin", s.where); }},
        {"Camera", call<&Builder::camera>},
        {"ColorSpace", call<&Builder::color_space>},
        {"Film", [](Builder& b, Statement& s) { b.eye_.film(s, b.scene_); }},
        {"Integrator", ignored},
        {"LightSource", call<&Builder::light>},
        {"MakeNamedMaterial", call<&Builder::make_named_material>},
        {"MakeNamedMedium", call<&Builder::make_named_medium>},
        {"Material", call<&Builder::material>},
        {"MediumInterface", call<&Builder::medium_interface>},
        {"NamedMaterial", call<&Builder::named_material>},
        {"ObjectBegin", [](Builder& b, Statement& s) { b.objects_.begin(s); }},
        {"ObjectEnd", [](Builder& b, Statement& s) { b.objects_.end(s); }},
        {"ObjectInstance", [](Builder& b, Statement& s) { b.objects_.place(s, b.to_world(), b.shapes_.budget()); }},
        {"Option", call<&Builder::option>},
        {"PixelFilter", ignored},
        {"Renderer", call<&Builder::older_business>},
        {"ReverseOrientation", [](Builder& b, Statement&) { b.state().reversed = !b.state().reversed; }},
        {"Sampler", ignored},
        {"Shape", call<&Builder::shape>},
        {"SurfaceIntegrator", call<&Builder::older_business>},
        {"Texture", call<&Builder::texture>},
        {"TransformBegin", [](Builder& b, Statement& s) { b.blocks_.begin(Blocks::Kind::transform, s.where); }},
        {"TransformEnd", [](Builder& b, Statement& s) { b.blocks_.end_transform(s.where); }},
        {"Volume", call<&Builder::volume>},
        {"VolumeIntegrator", call<&Builder::older_business>},
        {"WorldBegin",
         [](Builder& b, Statement&) {
             b.in_world_ = true;
             b.transforms_.begin_world(b.state().to_world);
         }},
        {"WorldEnd", call<&Builder::world_end>}};
    return table;
}

void Builder::execute(Statement& statement) {
    end_if_unwanted();
    if (ended_)
        return sources_.report.warn(statement.where,
                                    "what stands behind the first WorldEnd is left out: nothing of it is seen");
    const Part part = part_of(statement.directive);
    if (state().space != ColourSpace::srgb) statement.parameters.set_colour_space(state().space);
    if (part == Part::before_world && in_world_)
        sources_.report.error(statement.where, statement.directive + " must stand before WorldBegin");
    else if (part == Part::in_world && !in_world_)
        sources_.report.error(statement.where, statement.directive + " must stand behind WorldBegin");
    else if (CurrentTransform::knows(statement.directive))
        transforms_.execute(statement, state().to_world);
    else
        handlers().at(statement.directive)(*this, statement);
}

void Builder::enter() { blocks_.begin(Blocks::Kind::import, {}); }

void Builder::leave() {
    if (blocks_.end_import()) objects_.abandon();
}

void Builder::finish() {
    blocks_.end_file();
    materials_.check();
    if (!in_world_) sources_.report.error({sources_.main, 0}, "there is no WorldBegin, and so no scene");
    textures_.finish();  // waits for the meshes as well
    shapes_.displace(waiting_.displaced(), scene_.textures);
    if (shapes_.budget().exceeded())
        sources_.report.error({sources_.main, 0}, "the scene has more than 2^27 vertices and triangles");
    waiting_.finish(eye_.medium(), eye_.where());
    eye_.finish(scene_);
    pictures_.warn_below_black(scene_);
    scene_.warnings = sources_.report.warnings();
}

Matrix Builder::to_world() { return standing(state().to_world.transform); }

Matrix Builder::standing(const MovingTransform& transform) {
    if (transform.moves() && scene_.animations.empty()) scene_.animations.push_back({"", transforms_.end_seconds()});
    return transforms_.at(transform, seconds_.value_or(scene_.shutter ? scene_.shutter->open : 0));
}

void Builder::attribute(Statement& s) {
    static const std::vector<std::string> known{"light", "material", "medium", "shape", "texture"};
    const std::string& target = s.names[0];
    if (std::find(known.begin(), known.end(), target) == known.end()) {
        sources_.report.error(
            s.where, fmt::format("Attribute is of light, material, medium, shape or texture, not '{}'{}", target,
                                 did_you_mean(target, known)));
        return;
    }
    auto& defaults = state().defaults[target];
    for (const auto& parameter : s.parameters.all()) {
        std::erase_if(defaults, [&](const auto& p) { return p->name == parameter->name; });
        defaults.push_back(parameter);
    }
}

void Builder::world_end(Statement& s) {
    if (!sources_.older())
        return sources_.report.error(s.where, "'WorldEnd' belongs to pbrt-v3; in pbrt-v4 the file simply ends");
    ended_ = true;
    blocks_.end_file();
}

void Builder::older_business(Statement& s) {
    if (!sources_.older())
        sources_.report.error(s.where,
                              fmt::format("'{}' belongs to older versions; pbrt-v4 says 'Integrator'", s.directive));
}

void Builder::volume(Statement& s) {
    older_business(s);
    sources_.report.warn(s.where, "participating media of version 2 are not supported: the space is taken as empty");
}

void Builder::option(Statement& s) {
    if (s.parameters.boolean("forcediffuse", false))
        s.parameters.warn("'forcediffuse' is left out: surfaces keep their materials");
}

void Builder::make_named_medium(Statement& s) {
    if (!media_.define(s.names[0], to_world(), s.parameters))
        s.parameters.error(fmt::format("there is a medium '{}' already", s.names[0]));
}

/// One name is that of both sides. What media a shape parts waits for its material.
void Builder::medium_interface(Statement& s) {
    state().inside = s.names.empty() ? "" : s.names.front();
    state().outside = s.names.empty() ? "" : s.names.back();
}

void Builder::color_space(Statement& s) {
    if (const auto space = colour_space_named(s.names[0]))
        state().space = *space;
    else
        sources_.report.error(s.where, fmt::format("unknown color space '{}'{}", s.names[0],
                                                   did_you_mean(s.names[0], colour_space_names())));
}

void Builder::camera(Statement& s) {
    const auto& [start, end] = state().to_world.transform;
    const auto from_start = inverse(start), from_end = inverse(end);
    if (!from_start || !from_end) {
        sources_.report.error(s.where, "the camera's transform is singular");
        return;
    }
    const Shot shot = eye_.camera(s, state().outside);
    scene_.shutter = shot.shutter;
    const MovingTransform to_world{*from_start, *from_end};
    scene_.camera = shot.camera;
    scene_.camera.to_world = standing(to_world);
    scene_.camera.where = s.where;
    scene_.camera_given = true;
    transforms_.define("camera", to_world);
}

}  // namespace lightnet::pbrt
