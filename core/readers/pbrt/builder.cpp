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
      transforms_(sources_.report),
      seconds_(seconds),
      media_(sources_, scene_) {
    scene_.film.width = sources_.older() ? 640 : 1280, scene_.film.height = sources_.older() ? 480 : 720;
    Material grey;
    grey.model = DiffuseMaterial{textures_.constant({0.5f, 0.5f, 0.5f}), 0, std::nullopt};
    scene_.materials.push_back(std::move(grey));
    uses_.push_back({0, "", {}});
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
    if (state_.space != ColourSpace::srgb) statement.parameters.set_colour_space(state_.space);
    if (part == Part::before_world && in_world_)
        sources_.report.error(statement.where, statement.directive + " must stand before WorldBegin");
    else if (part == Part::in_world && !in_world_)
        sources_.report.error(statement.where, statement.directive + " must stand behind WorldBegin");
    else if (CurrentTransform::knows(statement.directive))
        transforms_.execute(statement, state_.to_world);
    else
        (this->*handlers().at(statement.directive))(statement);
}

void Builder::enter() { push(Block::import, {}); }

void Builder::leave() {
    while (!stack_.empty() && stack_.back().block != Block::import) {
        sources_.report.error(stack_.back().where, "this block is not closed in its file");
        if (stack_.back().block == Block::object) open_object_ = std::nullopt;
        state_ = std::move(stack_.back().state);
        stack_.pop_back();
    }
    pop(Block::import, "import", {});
}

void Builder::finish() {
    for (const auto& open : stack_) sources_.report.error(open.where, "this block is never closed");
    check_uses();
    if (!in_world_) sources_.report.error({sources_.main, 0}, "there is no WorldBegin, and so no scene");
    textures_.finish();  // waits for the meshes as well
    finish_shapes();
    finish_film();
    pictures_.warn_below_black(scene_);
    scene_.warnings = sources_.report.warnings();
}

Matrix Builder::to_world() { return standing(state_.to_world.transform); }

Matrix Builder::standing(const MovingTransform& transform) {
    if (transform.moves() && scene_.animations.empty()) scene_.animations.push_back({"", transforms_.end_seconds()});
    return transforms_.at(transform, seconds_.value_or(scene_.shutter ? scene_.shutter->open : 0));
}

void Builder::push(Block block, const SourceLine& where) {
    constexpr std::size_t deepest = 10000;
    if (stack_.size() == deepest) sources_.report.error(where, "blocks are nested too deeply");
    if (stack_.size() < deepest) stack_.push_back({block, state_, where});
}

std::optional<Builder::Saved> Builder::pop(Block block, const char* what, const SourceLine& where) {
    if (stack_.empty() || stack_.back().block != block) {
        std::string problem = fmt::format("there is no {} to end here", what);
        if (!stack_.empty() && stack_.back().block != Block::import)
            problem += fmt::format(" (the latest open block begins in line {})", stack_.back().where.line);
        sources_.report.error(where, problem);
        return std::nullopt;
    }
    Saved saved = std::move(stack_.back());
    stack_.pop_back();
    state_ = std::move(saved.state);
    return saved;
}

void Builder::attribute_begin(Statement& s) { push(Block::attribute, s.where); }
void Builder::attribute_end(Statement& s) { pop(Block::attribute, "AttributeBegin", s.where); }
void Builder::transform_begin(Statement& s) { push(Block::transform, s.where); }

void Builder::transform_end(Statement& s) {
    State current = state_;
    if (!pop(Block::transform, "TransformBegin", s.where)) return;
    current.to_world = state_.to_world;  // only the transform comes back
    state_ = std::move(current);
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
    auto& defaults = state_.defaults[target];
    for (const auto& parameter : s.parameters.all()) {
        std::erase_if(defaults, [&](const auto& p) { return p->name == parameter->name; });
        defaults.push_back(parameter);
    }
}

void Builder::reverse_orientation(Statement&) { state_.reversed = !state_.reversed; }

void Builder::world_begin(Statement&) {
    in_world_ = true;
    transforms_.begin_world(state_.to_world);
}

void Builder::world_end(Statement& s) {
    if (!sources_.older())
        return sources_.report.error(s.where, "'WorldEnd' belongs to pbrt-v3; in pbrt-v4 the file simply ends");
    ended_ = true;
    while (!stack_.empty()) {
        sources_.report.error(stack_.back().where, "this block is never closed");
        stack_.pop_back();
    }
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
    state_.inside = s.names.empty() ? "" : s.names.front();
    state_.outside = s.names.empty() ? "" : s.names.back();
}

void Builder::color_space(Statement& s) {
    if (const auto space = colour_space_named(s.names[0]))
        state_.space = *space;
    else
        sources_.report.error(s.where, fmt::format("unknown color space '{}'{}", s.names[0],
                                                   did_you_mean(s.names[0], colour_space_names())));
}

void Builder::camera(Statement& s) {
    const auto& [start, end] = state_.to_world.transform;
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
    around_ = state_.outside;
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
