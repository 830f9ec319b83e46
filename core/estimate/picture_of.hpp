// Pictures of what another node has learnt: for looking at it, no light.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <utility>

#include "core/estimate/nearest.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {

/// Takes the frozen state of the node that the parameter `of` names, and gives each point a colour by it.
template <class State>
class PictureOf : public LightOp {
public:
    explicit PictureOf(const NodeContext& here) : scene_(here.scene()), shown_(here.taken("of")) {}

    void prepare(Services&) override { state_ = shown_.frozen().template as<State>(); }

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        if (!state_) return;  // others rehearse
        Nearest scratch;
        for (std::size_t i = 0; i < questions.size(); ++i)
            answers[i] = colour(*state_, scene_.surface(questions[i]), scratch);
    }

private:
    virtual Rgb colour(const State& state, const SurfacePoint& point, Nearest& scratch) const = 0;

    const Scene& scene_;
    const LightOp& shown_;
    std::shared_ptr<const State> state_;
};

/// Completes the kind of such a node: what it shows is what others keep (RunTraits::freezes).
inline Kind picture_kind(const std::string& shows, const std::string& help_of_node, Kind kind) {
    kind.params.insert(kind.params.begin(),
                       {.name = "of", .type = ParamType::node, .help = help_of_node, .choices = {shows}});
    kind.light.paths = always({});
    kind.run.prepares = true;
    return kind;
}

/// The parameter `size` of those that draw dots.
inline Param dot_size(const std::string& more_help = "") {
    return {.name = "size",
            .type = ParamType::number,
            .help = "radius of the dots; 0: a three-hundredth of the scene's radius" + more_help,
            .unit = "scene units",
            .initial = Value{0.0},
            .least = 0};
}
inline float dot_size(const NodeContext& here) {
    const auto size = static_cast<float>(here.number("size"));
    return size == 0 ? here.scene().radius() / 300 : size;
}

}  // namespace lightnet
