// Where the photons of a map lie.
#include <algorithm>
#include <memory>
#include <vector>

#include "core/estimate/photon_tree.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {
namespace {

/// A dot of the photon's colour around each photon that a map has frozen, black between them: a picture of the map, not
/// of light.
class PhotonPositions final : public LightOp {
public:
    explicit PhotonPositions(const NodeContext& here)
        : scene_(here.scene()), map_(here.taken("of")), size_(static_cast<float>(here.number("size"))) {
        if (size_ == 0) size_ = scene_.radius() / 300;
    }

    void prepare(Services&) override { photons_ = map_.frozen().as<PhotonTree>(); }

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        if (!photons_) return;  // others rehearse
        Nearest scratch;
        for (std::size_t i = 0; i < questions.size(); ++i) {
            const SurfacePoint point = scene_.surface(questions[i]);
            const auto found = photons_->find({point.position, point.normal, size_, 1}, scratch);
            if (found.empty()) continue;
            const Rgb flux = (*photons_)[found.front().index].flux;
            answers[i] = flux / max_component(flux);
        }
    }

private:
    const Scene& scene_;
    const LightOp& map_;
    float size_;  // m
    std::shared_ptr<const PhotonTree> photons_;
};

}  // namespace

Kind photon_positions_kind() {
    return {
        .name = "PhotonPositions",
        .help = "a picture of a photon map, no light: a dot around each of its photons",
        .params = {{.name = "of", .type = ParamType::node, .help = "the map", .choices = {"photons"}},
                   {.name = "size",
                    .type = ParamType::number,
                    .help = "radius of the dots; 0: a three-hundredth of the scene's radius",
                    .unit = "m",
                    .initial = Value{0.0},
                    .least = 0}},
        .light = {.paths = always({})},
        .run = {.prepares = true},
        .make_light = [](const NodeContext& here) { return std::make_unique<PhotonPositions>(here); },
    };
}

}  // namespace lightnet
