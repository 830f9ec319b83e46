// How densely the photons of a map lie.
#include <memory>
#include <vector>

#include "core/base/math/sampling.hpp"
#include "core/estimate/photon_tree.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {
namespace {

/// Photons per area, whatever they carry: (k - 1) / (π r²), r the distance of the k-th nearest; where fewer lie within
/// the radius, those per its disc. Tells whether a map has photons enough where it matters.
class PhotonDensity final : public LightOp {
public:
    explicit PhotonDensity(const NodeContext& here)
        : scene_(here.scene()),
          map_(here.taken("of")),
          gather_(static_cast<std::size_t>(here.integer("gather"))),
          radius_(static_cast<float>(here.number("radius"))) {
        if (radius_ == 0) radius_ = 0.05f * scene_.radius();
    }

    void prepare(Services&) override { photons_ = map_.frozen().as<PhotonTree>(); }

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        if (!photons_) return;  // others rehearse
        Nearest scratch;
        for (std::size_t i = 0; i < questions.size(); ++i) {
            const SurfacePoint point = scene_.surface(questions[i]);
            const auto found = photons_->find({point.position, point.normal, radius_, gather_}, scratch);
            const bool enough = found.size() == gather_ && found.back().distance2 > 0;
            const float r2 = enough ? found.back().distance2 : radius_ * radius_;
            const float density = float(enough ? gather_ - 1 : found.size()) / (pi * r2);
            answers[i] = {density, density, density};
        }
    }

private:
    const Scene& scene_;
    const LightOp& map_;
    std::size_t gather_;
    float radius_;  // m
    std::shared_ptr<const PhotonTree> photons_;
};

}  // namespace

Kind photon_density_kind() {
    return {
        .name = "PhotonDensity",
        .help = "a picture of a photon map, no light: how many photons there are per square metre",
        .params = {{.name = "of", .type = ParamType::node, .help = "the map", .choices = {"photons"}},
                   {.name = "gather",
                    .type = ParamType::integer,
                    .help = "how many of the nearest photons are counted",
                    .unit = "photons",
                    .initial = Value{50.0},
                    .least = 2,
                    .most = 65536},
                   {.name = "radius",
                    .type = ParamType::number,
                    .help = "how far they may be away; 0: a twentieth of the scene's radius",
                    .unit = "m",
                    .initial = Value{0.0},
                    .least = 0}},
        .light = {.paths = always({})},
        .run = {.prepares = true},
        .make_light = [](const NodeContext& here) { return std::make_unique<PhotonDensity>(here); },
    };
}

}  // namespace lightnet
