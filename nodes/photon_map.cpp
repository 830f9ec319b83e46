// Light that was sent from the lamps beforehand, and kept where it met surfaces.
#include <algorithm>
#include <cassert>
#include <memory>
#include <vector>

#include "core/estimate/photon_tree.hpp"
#include "core/estimate/shooting.hpp"
#include "core/estimate/stops.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"
#include "core/network/light/services.hpp"

namespace lightnet {
namespace {

// Lets each lot go as soon as it is copied.
PhotonTree::Photons taken_out_of(std::vector<Mapped<Photon>>& lots) {
    PhotonTree::Photons all;
    std::size_t count = 0;
    for (const auto& lot : lots) count += lot.size();
    all.reserve(count + PhotonTree::room);
    for (; !lots.empty(); lots.pop_back()) all.insert(all.end(), lots.back().begin(), lots.back().end());
    return all;
}

/// Jensen 1996, "Global illumination using photon maps". The map is shot on all places before the first question, and
/// frozen. Answers are as blurred as the `gather` nearest photons lie apart, and darker within that distance of a
/// surface's edge: the bias of the method, which shrinks as `photons` grow. Where light is wanted that is smooth,
/// IrradianceCache or FinalGather over a map of all paths hides it.
class PhotonMap final : public LightOp {
public:
    explicit PhotonMap(const NodeContext& here)
        : scene_(here.scene()),
          shooting_(Shooting::of(here)),
          gather_(static_cast<std::size_t>(here.integer("gather"))),
          radius_(static_cast<float>(here.number("radius"))) {
        if (radius_ == 0) radius_ = 0.05f * scene_.radius();
    }

    void prepare(Services& services) override {
        const auto aim = take_aim(services, scene_, shooting_);
        auto lots = shoot_near(services, scene_, shooting_, *aim, radius_);
        const std::size_t places = services.whereabouts().places;
        tree_ = services.once<PhotonTree>([&] { return PhotonTree(taken_out_of(lots), places); });
    }

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        assert(tree_ && "nobody asks before it is prepared");
        Nearest scratch;
        gather_each(scene_, questions, [&](std::uint32_t i, const Gathering& at) {
            answers[i] = tree_->radiance({at.point, at.bsdf, at.outgoing, at.lobes}, radius_, gather_, scratch);
        });
    }

    Frozen frozen() const override { return Frozen(tree_); }

private:
    const Scene& scene_;
    Shooting shooting_;
    std::size_t gather_;
    float radius_;  // m
    std::shared_ptr<const PhotonTree> tree_;
};

std::vector<Param> photon_map_params() {
    auto params = shooting_params(200000, "ways of light that leave the lamps");
    params.push_back({.name = "gather",
                      .type = ParamType::integer,
                      .help = "how many of the nearest photons an answer looks at; 0: all within the radius",
                      .unit = "photons",
                      .initial = Value{60.0},
                      .least = 0,
                      .most = 65536});
    params.push_back({.name = "radius",
                      .type = ParamType::number,
                      .help = "how far they may be away; 0: a twentieth of the scene's radius",
                      .unit = "m",
                      .initial = Value{0.0},
                      .least = 0});
    return params;
}

}  // namespace

Kind photon_map_kind() {
    return {
        .name = "PhotonMap",
        .help = "light that was sent from the lamps beforehand: caustics, or a rough picture of all light",
        .prepares = true,
        .freezes = "photons",
        .paths = paths_of_photons,
        .landmarks = [](const NodeContext& here) { return landmarks_of(here.scene(), Shooting::of(here)); },
        .params = photon_map_params(),
        .make_light = [](const NodeContext& here) { return std::make_unique<PhotonMap>(here); },
    };
}

}  // namespace lightnet
