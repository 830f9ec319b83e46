#include "lua/custom.hpp"

#include <memory>
#include <string>
#include <variant>

#include "core/network/graph/graph.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"
#include "lua/custom_call.hpp"
#include "lua/function_source.hpp"

namespace lightnet {
namespace {

/// A function of the graph file. Each call has a Lua state of its own.
class Custom final : public LightOp {
public:
    explicit Custom(const NodeContext& here) {
        program_.node = here.name();
        program_.source = here.text("light");
        program_.file = lua::file_of_source(program_.source, here.name());
        program_.scene = &here.scene();
        program_.inputs = here.inputs();
        program_.key = here.key();
    }

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        lua::CustomCall(program_, questions).answer(answers);
    }

private:
    lua::CustomProgram program_;
};

std::vector<std::string> mistakes_in_function(const Node& node, const SceneData*) {
    const auto found = node.params.find("light");
    if (found == node.params.end()) return {};
    const auto* const source = std::get_if<std::string>(&found->second.data);
    if (!source) return {};
    const auto mistake = lua::CustomCall::mistake_in(*source, lua::file_of_source(*source, node.where.file));
    return mistake.empty() ? std::vector<std::string>{} : std::vector{mistake};
}

}  // namespace

Kind custom_kind() {
    return {.name = "Custom",
            .help = "a function of the graph file: columns in, columns out",
            .inputs = {0, 64},
            .params = {{.name = "light",
                        .type = ParamType::text,
                        .help = "function(q, ask) that answers with a column of numbers or colours"}},
            .mistakes = mistakes_in_function,
            .light = {.paths = always({}), .onward = ""},
            .reads = reading(ScenePart::geometry | ScenePart::materials | ScenePart::media),
            .make_light = [](const NodeContext& here) { return std::make_unique<Custom>(here); }};
}

}  // namespace lightnet
