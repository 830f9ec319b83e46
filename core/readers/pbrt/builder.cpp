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
      transforms_(sources_.report),
      seconds_(seconds) {
    scene_.film.width = sources_.older() ? 640 : 1280, scene_.film.height = sources_.older() ? 480 : 720;
}

const std::map<std::string, Builder::Handler>& Builder::handlers() {
    static const std::map<std::string, Handler> table{{"Accelerator", &Builder::ignored},
                                                      {"AreaLightSource", &Builder::area_light},
                                                      {"Attribute", &Builder::attribute},
                                                      {"AttributeBegin", &Builder::attribute_begin},
                                                      {"AttributeEnd", &Builder::attribute_end},
                                                      {"Camera", &Builder::camera},
                                                      {"ColorSpace", &Builder::color_space},
                                                      {"Film", &Builder::film},
                                                      {"Integrator", &Builder::ignored},
                                                      {"LightSource", &Builder::light},
                                                      {"MakeNamedMaterial", &Builder::make_named_material},
                                                      {"MakeNamedMedium", &Builder::make_named_medium},
                                                      {"Material", &Builder::material},
                                                      {"MediumInterface", &Builder::medium_interface},
                                                      {"NamedMaterial", &Builder::named_material},
                                                      {"ObjectBegin", &Builder::object_begin},
                                                      {"ObjectEnd", &Builder::object_end},
                                                      {"ObjectInstance", &Builder::object_instance},
                                                      {"Option", &Builder::option},
                                                      {"PixelFilter", &Builder::ignored},
                                                      {"Renderer", &Builder::older_business},
                                                      {"ReverseOrientation", &Builder::reverse_orientation},
                                                      {"Sampler", &Builder::ignored},
                                                      {"Shape", &Builder::shape},
                                                      {"SurfaceIntegrator", &Builder::older_business},
                                                      {"Texture", &Builder::texture},
                                                      {"TransformBegin", &Builder::transform_begin},
                                                      {"TransformEnd", &Builder::transform_end},
                                                      {"Volume", &Builder::volume},
                                                      {"VolumeIntegrator", &Builder::older_business},
                                                      {"WorldBegin", &Builder::world_begin},
                                                      {"WorldEnd", &Builder::world_end}};
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
        (this->*handlers().at(statement.directive))(statement);
}

void Builder::enter() { blocks_.begin(Blocks::Kind::import, {}); }

void Builder::leave() {
    if (blocks_.end_import()) open_object_ = std::nullopt;
}

void Builder::finish() {
    blocks_.end_file();
    materials_.check();
    if (!in_world_) sources_.report.error({sources_.main, 0}, "there is no WorldBegin, and so no scene");
    textures_.finish();  // waits for the meshes as well
    shapes_.displace(waiting_.displaced(), scene_.textures);
    if (shapes_.budget().exceeded())
        sources_.report.error({sources_.main, 0}, "the scene has more than 2^27 vertices and triangles");
    waiting_.finish(around_, around_where_);
    finish_film();
    pictures_.warn_below_black(scene_);
    scene_.warnings = sources_.report.warnings();
}

void Builder::finish_film() {
    scene_.film.scale *= exposure_;
    take_scale_out(scene_.camera);
    if (white_ == Rgb{1, 1, 1}) return;
    // light is linear, so a white balance per channel may as well be done where the light comes from
    const Rgb gain{1 / std::max(white_.r, 1e-3f), 1 / std::max(white_.g, 1e-3f), 1 / std::max(white_.b, 1e-3f)};
    for (auto& shape : scene_.shapes)
        if (shape.emission) shape.emission->radiance *= gain;
    for (auto& environment : scene_.environments) environment.radiance *= gain;
    for (auto& light : scene_.lights) std::visit([&](auto& one) { one.strength() *= gain; }, light);
}

Matrix Builder::to_world() { return standing(state().to_world.transform); }

Matrix Builder::standing(const MovingTransform& transform) {
    if (transform.moves() && scene_.animations.empty()) scene_.animations.push_back({"", transforms_.end_seconds()});
    return transforms_.at(transform, seconds_.value_or(scene_.shutter ? scene_.shutter->open : 0));
}

void Builder::attribute_begin(Statement& s) { blocks_.begin(Blocks::Kind::attribute, s.where); }
void Builder::attribute_end(Statement& s) { blocks_.end(Blocks::Kind::attribute, "AttributeBegin", s.where); }
void Builder::transform_begin(Statement& s) { blocks_.begin(Blocks::Kind::transform, s.where); }
void Builder::transform_end(Statement& s) { blocks_.end_transform(s.where); }

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

void Builder::reverse_orientation(Statement&) { state().reversed = !state().reversed; }

void Builder::world_begin(Statement&) {
    in_world_ = true;
    transforms_.begin_world(state().to_world);
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

// how images are sampled is the graph's business
void Builder::ignored(Statement&) {}

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
    const Shot shot = make_camera(s.names[0], s.parameters, sources_.version);
    s.parameters.warn_unused();
    scene_.shutter = shot.shutter;
    const MovingTransform to_world{*from_start, *from_end};
    scene_.camera = shot.camera;
    scene_.camera.to_world = standing(to_world);
    scene_.camera.where = s.where;
    scene_.camera_given = true;
    around_ = state().outside;
    around_where_ = s.where;
    exposure_ = shot.exposure;
    transforms_.define("camera", to_world);
}

void Builder::film(Statement& s) {
    const FilmShot shot = make_film(s.names[0], s.parameters, sources_.version);
    scene_.film = shot.film;
    white_ = shot.white;
    s.parameters.warn_unused();
}

}  // namespace lightnet::pbrt
