// Light on some surfaces only.
#include <algorithm>
#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "core/network/graph/check_params.hpp"
#include "core/network/graph/graph.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"
#include "core/scene/bsdf/hair_ways.hpp"
#include "core/scene/data/lamp_names.hpp"
#include "core/scene/data/scene_data.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {
namespace {

std::uint8_t without_others(const std::string& way) {
    if (way == "R") return without_way::any & ~without_way::r;
    if (way == "TT") return without_way::any & ~without_way::tt;
    if (way == "TRT") return without_way::any & ~without_way::trt;
    return 0;
}

/// Asks its input where a point is on a surface or in a medium, as is wanted, and a surface has the material, belongs
/// to the object and lies in the box that are named, and answers black elsewhere; or the other way round. What isn't
/// selected costs the input nothing. Of hair it may ask for light that comes by one way through a fibre.
class Select final : public LightOp {
public:
    explicit Select(const NodeContext& here)
        : scene_(here.scene()),
          inputs_(here.inputs()),
          except_(here.flag("except")),
          at_surfaces_(here.text("where") != "media"),
          in_media_(here.text("where") != "surfaces"),
          boxed_(!here.numbers("box").empty()),
          named_(!here.text("material").empty() || !here.text("object").empty()),
          others_(without_others(here.text("hair"))) {
        const auto box = here.numbers("box");
        for (std::size_t i = 0; i < std::min(box.size(), box_.size()); ++i) box_[i] = static_cast<float>(box[i]);
        const auto& materials = scene_.all<Material>();
        const auto& objects = scene_.all<Object>();
        const auto& material = here.text("material");
        const auto& object = here.text("object");
        for (const auto& shape : scene_.all<Shape>()) {
            const Material& made_of = materials[shape.material];
            made_of_.push_back((material.empty() || goes_by(made_of.name, material)) &&
                               (others_ == 0 || std::holds_alternative<HairMaterial>(made_of.model)));
            called_.push_back(object.empty() || goes_by(shape.name, object) || goes_by(shape.node_name, object));
        }
        for (const auto& instance : scene_.all<Instance>())
            of_object_.push_back(goes_by(objects[instance.object].name, object) || goes_by(instance.node_name, object));
    }

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        std::vector<Query> selected;
        std::vector<std::size_t> askers;
        for (std::size_t i = 0; i < questions.size(); ++i) {
            const bool here = selects(questions[i]);
            if (here == except_ && !(here && others_)) continue;
            Query& question = selected.emplace_back(questions[i]);
            if (here) question.lobes |= except_ ? without_way::any & ~others_ : others_;
            askers.push_back(i);
        }
        if (selected.empty()) return;
        const Part part = ask(inputs_, 0, selected);
        each_colour(part, [&](std::size_t q, std::size_t layer, const Rgb& colour) {
            answers[askers[q] * part.layers + layer] += colour;
        });
    }

private:
    bool selects(const Query& question) const {
        if (!(question.is_in_space() ? in_media_ : at_surfaces_)) return false;
        if (question.is_in_space() ? named_ || others_ : !is_called_so(question)) return false;
        if (!boxed_) return true;
        const SurfacePoint point = scene_.surface(question);
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (point.position[axis] < box_[axis] || point.position[axis] > box_[axis + 3]) return false;
        return true;
    }

    bool is_called_so(const Query& question) const {
        const bool instance = question.instance != Query::no_instance;
        return made_of_[question.geometry] &&
               (called_[question.geometry] || (instance && of_object_[question.instance]));
    }

    const Scene& scene_;
    Inputs inputs_;
    std::vector<bool> made_of_, called_;  // by shape: it has the material, the name
    std::vector<bool> of_object_;         // by instance
    bool except_, at_surfaces_, in_media_, boxed_;
    bool named_;           // a material or an object: media have no such name
    std::uint8_t others_;  // bits of `without_way`: ways through hair that aren't asked for; 0: there is no such wish
    std::array<float, 6> box_{};
};

using Names = std::set<std::string>;

Names materials_of(const SceneData& scene) {
    Names names;
    for (const auto& shape : scene.shapes)
        if (shape.material < scene.materials.size()) names.insert(scene.materials[shape.material].name);
    return names;
}

Names objects_of(const SceneData& scene) {
    Names names;
    for (const auto& shape : scene.shapes) names.insert({shape.name, shape.node_name});
    for (const auto& instance : scene.instances)
        if (instance.object < scene.objects.size())
            names.insert({scene.objects[instance.object].name, instance.node_name});
    return names;
}

// Complains where nothing goes by that name.
void look_for(const std::string& wanted, const char* what, Names names, std::vector<std::string>& wrong) {
    names.erase("");
    if (wanted.empty() ||
        std::any_of(names.begin(), names.end(), [&](const auto& name) { return goes_by(name, wanted); }))
        return;
    constexpr std::size_t most = 40;
    std::vector<std::string> known(names.begin(), names.end());
    auto text = suggest(wanted, known);
    if (known.size() > most && !text.starts_with(" (did")) {
        known.resize(most);
        text = suggest(wanted, known);
        text.insert(text.size() - 1, ", …");
    }
    wrong.push_back(what + (" called '" + wanted + "'") + (known.empty() ? ": the scene's file names none" : text));
}

const std::string& text_of(const Node& node, const char* param) {
    return std::get<std::string>(node.params.at(param).data);
}

bool names_places(const Node& node) {
    return !text_of(node, "material").empty() || !text_of(node, "object").empty() || text_of(node, "hair") != "all" ||
           !std::get<Table>(node.params.at("box").data).list.empty();
}

bool passes_all(const Node& node) { return !names_places(node) && text_of(node, "where") == "anywhere"; }

bool is_hair(const Material& material) { return std::holds_alternative<HairMaterial>(material.model); }

// By a last letter surfaces are told from media, and nothing else.
PassedOn passed_by(const Node& node) {
    const std::string& where = text_of(node, "where");
    const bool except = std::get<bool>(node.params.at("except").data), part = names_places(node);
    if (where == "anywhere" || (except && part)) return {"", part};
    return {(where == "media") != except ? "V" : ends_at_surface, part};
}

std::vector<std::string> mistakes(const Node& node, const SceneData* scene) {
    const auto& material = text_of(node, "material");
    const auto& object = text_of(node, "object");
    const auto& box = std::get<Table>(node.params.at("box").data).list;
    if (passes_all(node))
        return {"selects nothing: give it a 'material', an 'object', a 'box', a 'where' or a way through 'hair'"};
    std::vector<std::string> wrong;
    for (std::size_t axis = 0; axis < 3 && !box.empty(); ++axis)
        if (std::get<double>(box[axis].data) > std::get<double>(box[axis + 3].data))
            wrong.push_back(std::string("'box' ends before it begins along ") + "xyz"[axis]);
    if (!scene) return wrong;
    if (text_of(node, "hair") != "all" && std::ranges::none_of(scene->materials, is_hair))
        wrong.push_back("no material of the scene is 'hair'");
    look_for(material, "no shape has a material", materials_of(*scene), wrong);
    look_for(object, "there is no object or shape", objects_of(*scene), wrong);
    return wrong;
}

}  // namespace

Kind select_kind() {
    return {
        .name = "Select",
        .help =
            "its input on surfaces of one material, of one object, in a box, in media, or by a way through hair; black "
            "elsewhere",
        .inputs = {1, 1},
        .params =
            {{.name = "material",
              .type = ParamType::text,
              .help = "name that the scene's file gives to the material, * for any part of it; empty: any",
              .initial = Value{""}},
             {.name = "object",
              .type = ParamType::text,
              .help = "name of the object or shape in the scene's file, * for any part of it; empty: any",
              .initial = Value{""}},
             {.name = "box",
              .type = ParamType::numbers,
              .help = "lower x, y, z and upper x, y, z; empty: anywhere",
              .unit = "scene units",
              .initial = Value{Table{}},
              .count = 6},
             {.name = "where",
              .type = ParamType::text,
              .help = "on surfaces alone, or where media scatter light",
              .initial = Value{"anywhere"},
              .choices = {"anywhere", "surfaces", "media"}},
             {.name = "hair",
              .type = ParamType::text,
              .help = "of hair alone what fibres reflect (R), let through (TT), or reflect inside (TRT)",
              .initial = Value{"all"},
              .choices = {"all", "R", "TT", "TRT"}},
             {.name = "except", .type = ParamType::flag, .help = "all other places instead", .initial = Value{false}}},
        .mistakes = mistakes,
        .light = {.linear = true, .partial = true, .space = true, .passed = passed_by},
        .reads = reading(scene_of_light | ScenePart::names),
        .make_light = [](const NodeContext& here) { return std::make_unique<Select>(here); },
    };
}

}  // namespace lightnet
