// Light on some surfaces only.
#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <vector>

#include "core/graph/check_params.hpp"
#include "core/graph/graph.hpp"
#include "core/graph/kind.hpp"
#include "core/light/light_op.hpp"
#include "core/light/node_context.hpp"
#include "core/scene/scene.hpp"
#include "core/scene/scene_data.hpp"

namespace lightnet {
namespace {

/// Asks its input where a surface has the material and lies in the box that are named, and answers black elsewhere; or
/// the other way round. What isn't selected costs the input nothing.
class Select final : public LightOp {
public:
    explicit Select(const NodeContext& here)
        : scene_(here.scene()),
          inputs_(here.inputs()),
          material_(here.text("material")),
          except_(here.flag("except")),
          boxed_(!here.numbers("box").empty()) {
        const auto box = here.numbers("box");
        for (std::size_t i = 0; i < std::min(box.size(), box_.size()); ++i) box_[i] = static_cast<float>(box[i]);
    }

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        std::vector<Query> selected;
        std::vector<std::size_t> askers;
        for (std::size_t i = 0; i < questions.size(); ++i)
            if (selects(questions[i]) != except_) {
                selected.push_back(questions[i]);
                askers.push_back(i);
            }
        if (selected.empty()) return;
        const Part part = ask(inputs_, 0, selected);
        const std::size_t width = part.input->width();
        for (std::size_t q = 0; q < selected.size(); ++q)
            for (std::size_t k = 0; k < width; ++k)
                answers[askers[q] * part.layers + part.input->layers[k]] += part.answers[q * width + k];
    }

private:
    bool selects(const Query& question) const {
        const SurfacePoint point = scene_.surface(question);
        if (!material_.empty() && scene_.material_of(point) != material_) return false;
        if (!boxed_) return true;
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (point.position[axis] < box_[axis] || point.position[axis] > box_[axis + 3]) return false;
        return true;
    }

    const Scene& scene_;
    Inputs inputs_;
    std::string material_;
    bool except_, boxed_;
    std::array<float, 6> box_{};
};

std::vector<std::string> names_of(const SceneData& scene) {
    std::set<std::string> names;
    for (const auto& shape : scene.shapes)
        if (shape.material < scene.materials.size()) names.insert(scene.materials[shape.material].name);
    names.erase("");
    return {names.begin(), names.end()};
}

std::vector<std::string> mistakes(const Node& node, const SceneData* scene) {
    const auto& material = std::get<std::string>(node.params.at("material").data);
    const auto& box = std::get<Table>(node.params.at("box").data).list;
    if (material.empty() && box.empty()) return {"selects nothing: give it a 'material' or a 'box'"};
    std::vector<std::string> wrong;
    for (std::size_t axis = 0; axis < 3 && !box.empty(); ++axis)
        if (std::get<double>(box[axis].data) > std::get<double>(box[axis + 3].data))
            wrong.push_back(std::string("'box' ends before it begins along ") + "xyz"[axis]);
    if (!scene || material.empty()) return wrong;
    const auto names = names_of(*scene);
    if (std::find(names.begin(), names.end(), material) == names.end())
        wrong.push_back("no shape has a material called '" + material + "'" + suggest(material, names));
    return wrong;
}

}  // namespace

Kind select_kind() {
    return {
        .name = "Select",
        .help = "its input on surfaces of one material, or in a box; black elsewhere",
        .least_inputs = 1,
        .most_inputs = 1,
        .linear = true,
        .mistakes = mistakes,
        .partial = true,
        .params = {{.name = "material",
                    .type = ParamType::text,
                    .help = "name that the scene gives to the material; empty: any",
                    .initial = Value{""}},
                   {.name = "box",
                    .type = ParamType::numbers,
                    .help = "lower x, y, z and upper x, y, z; empty: anywhere",
                    .unit = "m",
                    .initial = Value{Table{}},
                    .count = 6},
                   {.name = "except",
                    .type = ParamType::flag,
                    .help = "all other surfaces instead",
                    .initial = Value{false}}},
        .make_light = [](const NodeContext& here) { return std::make_unique<Select>(here); },
    };
}

}  // namespace lightnet
