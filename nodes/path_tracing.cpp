// Path tracing: indirect light, or all light.
#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "core/estimate/path_walk.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"

namespace lightnet {
namespace {

/// Follows light paths from the points asked about: PathWalk. Where it has a guide, they go on by what that has learnt.
class PathTracing final : public LightOp {
public:
    explicit PathTracing(const NodeContext& here)
        : key_(here.key()),
          guide_(here.has("guide") ? &here.taken("guide") : nullptr),
          first_rays_(here.shared<SharedFirstRays>()),
          paths_(here.scene(),
                 {static_cast<std::uint32_t>(here.integer("samples")),
                  static_cast<std::uint32_t>(here.integer("max_depth")),
                  static_cast<std::uint32_t>(here.integer("roulette_depth")), here.text("paths") == "all"}) {}

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        std::fill(answers.begin(), answers.end(), Rgb{});
        if (!guide_) return paths_.light(questions, key_, *first_rays_, answers);
        const auto guide = guide_->frozen().as<LightGuide>();
        if (guide && guide->size() == 0) return paths_.light(questions, key_, *first_rays_, answers);
        if (guide) return paths_.light(questions, key_, *guide, answers);
        // It learns where it is asked for: from the questions of its rehearsals.
        std::vector<Rgb> none(questions.size());
        guide_->light(questions, none);
    }

private:
    Key key_;
    const LightOp* guide_;  // null: none
    std::shared_ptr<SharedFirstRays> first_rays_;
    PathWalk paths_;
};
// A limit counts the surfaces and collisions between the lamp and the one asked about, but no panes, which these words
// can't tell from mirrors.
std::vector<std::string> paths_of(const Node& node) {
    const bool all = std::get<std::string>(node.params.at("paths").data) == "all";
    const double most = std::get<double>(node.params.at("max_depth").data);
    const std::string least = all ? "0" : "1";
    if (most == 0) return {all ? "L(S|D|V)*(D|V)" : "L(S|D|V)+(D|V)"};
    return {"L(S|D|V){" + least + "," + std::to_string(static_cast<int>(most)) + "}(D|V)"};
}

}  // namespace

Kind path_tracing_kind() {
    return {
        .name = "PathTracing",
        .help = "path tracing: indirect light, all that arrives by way of other surfaces; or all light",
        .params =
            {
                {.name = "samples",
                 .type = ParamType::integer,
                 .help = "light paths per question",
                 .unit = "samples",
                 .initial = Value{1.0},
                 .least = 1,
                 .most = 65536},
                {.name = "max_depth",
                 .type = ParamType::integer,
                 .help = "surfaces that a light path may have between a lamp and the point, but for panes that it "
                         "passes straight; 0: any number",
                 .initial = Value{0.0},
                 .least = 0,
                 .most = 65536},
                {.name = "roulette_depth",
                 .type = ParamType::integer,
                 .help = "surfaces after which paths may end by chance: Russian roulette",
                 .initial = Value{3.0},
                 .least = 0,
                 .most = 65536},
                {.name = "paths",
                 .type = ParamType::text,
                 .help = "which light: what comes by way of other surfaces, or direct light as well",
                 .initial = Value{"indirect"},
                 .choices = {"indirect", "all"}},
                {.name = "guide",
                 .type = ParamType::node,
                 .help = "the guide that knows where light comes from; none: paths go on by surfaces alone",
                 .choices = {"light directions"},
                 .optional = true},
            },
        .light = {.space = true, .lamps = true, .groups = true, .paths = paths_of},
        .reads = reading(scene_of_light),
        .make_light = [](const NodeContext& here) { return std::make_unique<PathTracing>(here); },
    };
}

}  // namespace lightnet
