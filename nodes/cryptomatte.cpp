// Cryptomatte: the objects, materials or lamps seen in each pixel, for compositing.
#include <memory>
#include <vector>

#include "core/base/name_id.hpp"
#include "core/film/addition.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"
#include "core/scene/data/surface_names.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {
namespace {

/// Answers with the id of the name of each surface that it is asked about, seen once; black where it is none of those.
class Cryptomatte final : public LightOp {
public:
    explicit Cryptomatte(const NodeContext& here) {
        const SurfaceNames names = surface_names(here.scene().data(), named_by(here.text("of")));
        for (const auto& name : names.of_shape) of_shape_.push_back(once(name));
        for (const auto& name : names.of_instance) of_instance_.push_back(once(name));
    }

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        for (std::size_t i = 0; i < questions.size(); ++i) answers[i] = seen(questions[i]);
    }

private:
    static Rgb once(const std::string& name) { return name.empty() ? Rgb{} : seen_id(name_id(name)); }

    Rgb seen(const Query& question) const {
        if (question.instance != Query::no_instance)
            if (const Rgb& own = of_instance_.at(question.instance); own != Rgb{}) return own;
        return of_shape_.at(question.geometry);
    }

    std::vector<Rgb> of_shape_, of_instance_;
};

std::vector<std::string> odd_ranks(const Node& node, const SceneData*) {
    const double ranks = std::get<double>(node.params.at("ranks").data);
    if (static_cast<int>(ranks) % 2 == 0) return {};
    return {"'ranks' must be even: two of them share a layer"};
}

}  // namespace

Kind cryptomatte_kind() {
    return {
        .name = "Cryptomatte",
        .help = "no light: which objects, materials or lamps each pixel shows, and how much of it they cover",
        .params = {{.name = "of",
                    .type = ParamType::text,
                    .help = "what is told apart, by the names that the scene's file gives",
                    .choices = {"object", "mesh", "material", "lamp"}},
                   {.name = "ranks",
                    .type = ParamType::integer,
                    .help = "how many are told apart in one pixel: those that cover most of it",
                    .initial = Value{6.0},
                    .least = 2,
                    .most = double(most_ids)}},
        .mistakes = odd_ranks,
        .light = {.facts = true, .ids = true, .paths = always({})},
        .reads = reading(whole_scene),
        .make_light = [](const NodeContext& here) { return std::make_unique<Cryptomatte>(here); },
    };
}

}  // namespace lightnet
