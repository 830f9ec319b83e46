#include "core/readers/part_edits.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/in_quotes.hpp"
#include "core/base/joined.hpp"
#include "core/base/suggestion.hpp"
#include "core/scene/data/lamp_names.hpp"
#include "core/scene/data/same_shapes.hpp"

namespace lightnet {
namespace {

UneditedParts parts_of(const SceneData& scene) {
    UneditedParts parts{scene.materials, scene.textures.size(), {}, scene.lights, {}, vertices_of(scene)};
    for (const Shape& shape : scene.shapes)
        if (shape.emission) parts.emissions.push_back(*shape.emission);
    for (const auto& environment : scene.environments) parts.around.push_back(environment.radiance);
    return parts;
}

void put_back(SceneData& scene) {
    const UneditedParts& parts = *scene.unedited;
    scene.materials = parts.materials;
    scene.textures.resize(parts.textures);
    scene.lights = parts.lights;
    auto emission = parts.emissions.begin();
    for (Shape& shape : scene.shapes)
        if (shape.emission) shape.emission = *emission++;
    for (std::size_t i = 0; i < parts.around.size(); ++i) scene.environments[i].radiance = parts.around[i];
}

/// A texture of one colour, made where it is wanted.
class Paint {
public:
    Paint(SceneData& scene, Rgb colour) : scene_(scene), colour_(colour) {}
    TextureId texture() {
        if (!made_) {
            scene_.textures.push_back({colour_, {}, false});
            made_ = static_cast<TextureId>(scene_.textures.size() - 1);
        }
        return *made_;
    }
    Rgb colour() const { return colour_; }

private:
    SceneData& scene_;
    Rgb colour_;
    std::optional<TextureId> made_;
};

/// Gives a material another colour, which is what most of its light is coloured by. False: it has none.
struct Recoloured {
    Paint& paint;

    bool operator()(DiffuseMaterial& one) const { return one.reflectance = paint.texture(), true; }
    bool operator()(ConductorMaterial& one) const { return one.metal.reflectance = paint.texture(), true; }
    bool operator()(DielectricMaterial& one) const { return one.transmitted = paint.texture(), true; }
    bool operator()(CoatedDiffuseMaterial& one) const { return one.reflectance = paint.texture(), true; }
    bool operator()(CoatedConductorMaterial& one) const { return one.metal.reflectance = paint.texture(), true; }
    bool operator()(PrincipledMaterial& one) const { return one.base_colour = paint.texture(), true; }
    bool operator()(BurleyMaterial& one) const { return one.base_colour = paint.texture(), true; }
    bool operator()(auto&) const { return false; }
};

/// Gives a material another roughness.
struct Roughened {
    float roughness;

    bool set(Roughness& one) const {
        one.u = one.v = roughness;
        one.texture.reset();
        return true;
    }
    bool operator()(ConductorMaterial& one) const { return set(one.roughness); }
    bool operator()(DielectricMaterial& one) const { return set(one.roughness); }
    bool operator()(CoatedDiffuseMaterial& one) const { return set(one.roughness); }
    bool operator()(CoatedConductorMaterial& one) const { return set(one.roughness); }
    bool operator()(PrincipledMaterial& one) const { return set(one.roughness); }
    bool operator()(BurleyMaterial& one) const { return set(one.roughness); }
    bool operator()(auto&) const { return false; }
};

/// Makes the edits of one scene, and collects what is wrong with them.
class Editor {
public:
    Editor(SceneData& scene, SourceLine where) : scene_(scene), where_(std::move(where)) {}

    void change_lamps(const std::map<std::string, Rgb>& gains) {
        std::vector<std::pair<LampsCalled, Rgb>> found;
        for (const auto& [name, gain] : gains) {
            found.emplace_back(lamps_called(scene_, name), gain);
            if (!found.back().first.fault.empty()) complain("'lamps': " + found.back().first.fault);
        }
        for (const auto& [lamps, gain] : found) {  // by now none is black by an edit
            for (const auto shape : lamps.shapes) scene_.shapes[shape].emission->radiance *= gain;
            for (const auto light : lamps.lights)
                std::visit([by = gain](auto& one) { one.strength() *= by; }, scene_.lights[light]);
            if (lamps.around)
                for (auto& environment : scene_.environments) environment.radiance *= gain;
        }
    }

    /// `change(material)`: false where it can't be.
    void change_materials(const std::string& what, const std::string& wanted, const auto& change) {
        bool met = false;
        std::string unable;
        for (auto& material : scene_.materials) {
            if (!goes_by(material.name, wanted)) continue;
            if (change(material))
                met = true;
            else
                unable = std::visit([](const auto& one) { return one.name; }, material.model);
        }
        if (met) return;
        std::vector<std::string> names;
        for (const auto& material : scene_.materials)
            if (!material.name.empty() && std::ranges::find(names, material.name) == names.end())
                names.push_back(material.name);
        const std::string fault =
            unable.empty() ? "there is no material called " + in_quotes(wanted) + did_you_mean(wanted, names)
                           : "material " + in_quotes(wanted) + " is " + unable + ", which has none of its own";
        complain("'" + what + "': " + fault);
    }

    /// Throws UserError where something was wrong.
    void end() {
        if (problems_.empty()) return;
        put_back(scene_);
        throw UserError(std::move(problems_));
    }

private:
    void complain(std::string what) { problems_.push_back({where_, std::move(what)}); }

    SceneData& scene_;
    SourceLine where_;
    std::vector<Problem> problems_;
};

}  // namespace

bool may_be_edited(const SceneData& scene) { return scene.unedited && scene.motion.empty() && !scene.next; }

void edit_parts(const PartEdits& edits, SceneData& scene, const SourceLine& where) {
    if (scene.unedited)
        put_back(scene);
    else
        scene.unedited = parts_of(scene);
    Editor editor(scene, where);
    editor.change_lamps(edits.lamps);
    for (auto& environment : scene.environments) environment.radiance *= edits.environment_scale;
    for (const auto& [name, colour] : edits.colours) {
        Paint paint(scene, colour);
        editor.change_materials("colours", name,
                                [&](Material& one) { return std::visit(Recoloured{paint}, one.model); });
    }
    for (const auto& [name, value] : edits.roughness)
        editor.change_materials("roughness", name, [roughness = value.r](Material& one) {
            return std::visit(Roughened{roughness}, one.model);
        });
    editor.end();
}

}  // namespace lightnet
