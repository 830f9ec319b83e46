// Photon mapping: light that was sent from the lamps beforehand, and kept where it met surfaces.
#include <algorithm>
#include <cassert>
#include <memory>
#include <vector>

#include "core/estimate/gather_each.hpp"
#include "core/estimate/photon_tree.hpp"
#include "core/estimate/shooting.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"
#include "core/network/light/services.hpp"
#include "core/scene/lamps/lights.hpp"

namespace lightnet {
namespace {

// Lets each lot go as soon as it is copied.
PhotonTree::Photons taken_out_of(std::vector<Mapped<Photon>>& lots, const Services& services) {
    PhotonTree::Photons all;
    std::size_t count = 0;
    for (const auto& lot : lots) count += lot.size();
    all.reserve(count + PhotonTree::room);
    for (; !lots.empty(); lots.pop_back()) {
        services.look();
        all.insert(all.end(), lots.back().begin(), lots.back().end());
    }
    return all;
}

/// Jensen 1996, "Global illumination using photon maps". The map is shot on all places before the first question, and
/// frozen. Answers are as blurred as the `gather` nearest photons lie apart: the bias of the method, which shrinks as
/// `photons` grow. At edges light is not lost, but spread over the surface that there is (PhotonSpread). Where light is
/// wanted that is smooth, IrradianceCache or FinalGather over a map of all paths hides the blur.
///
/// At points in media it answers from beams instead: what light passes on its way (BeamTree).
class PhotonMap final : public LightOp {
public:
    explicit PhotonMap(const NodeContext& here)
        : scene_(here.scene()),
          shooting_(Shooting::with_error(here)),
          beams_(shooting_of_beams(here, shooting_)),
          gather_(static_cast<std::size_t>(here.integer("gather"))),
          radius_(gather_radius(here)) {}

    void prepare(Services& services) override {
        if (!may_keep_any(scene_, shooting_.paths)) {
            tree_ = services.once<PhotonTree>([] { return PhotonTree(std::span<const Photon>{}); });
            return;
        }
        if (beams_.emitted > 0) {
            services.doing("shoots beams through media");
            beam_tree_ = take_beams(services, scene_, beams_)[0];
        }
        services.doing("tries where to aim");
        const auto aim = take_aim(services, scene_, shooting_);
        services.doing("tries how far photons lie apart");
        const PhotonSpread spread = take_spread(services, scene_, shooting_, *aim, gather_, radius_);
        services.doing("shoots photons");
        auto lots = shoot_near(services, scene_, shooting_, *aim, spread, radius_);
        services.doing("builds its tree");
        tree_ = services.once<PhotonTree>(
            [&](Builders& builders) { return PhotonTree(taken_out_of(lots, services), builders); });
    }

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        assert(tree_ && "nobody asks before it is prepared");
        if (tree_->size() == 0 && !beam_tree_) return;
        Nearest scratch;
        gather_each(scene_, questions, [&](std::uint32_t i, const Gathering& at) {
            const auto groups = answers.subspan(i * scene_.lights().groups(), scene_.lights().groups());
            if (!at.point.is_in_space())
                tree_->radiance(
                    {at.point, at.bsdf, at.outgoing, at.lobes, window_of(scene_, questions[i], photon_window)}, radius_,
                    gather_, scratch, groups);
            else if (beam_tree_)
                beam_tree_->radiance(at, radius_, gather_, scratch, groups);
        });
    }

    Frozen frozen() const override { return Frozen(tree_); }

private:
    const Scene& scene_;
    Shooting shooting_, beams_;
    std::size_t gather_;
    float radius_;  // m
    std::shared_ptr<const PhotonTree> tree_;
    std::shared_ptr<const BeamTree> beam_tree_;  // null: there are no media
};

std::vector<Param> photon_map_params() {
    auto params = shooting_params(0, "light paths that leave the lamps; 0: as many as the error wants");
    params.push_back({.name = "gather",
                      .type = ParamType::integer,
                      .help = "how many of the nearest photons, or beams, an answer takes; 0: all within the radius",
                      .unit = "photons",
                      .initial = Value{60.0},
                      .least = 0,
                      .most = 65536});
    params.push_back(gather_radius("how far they may be away"));
    params.push_back(beams_param(10000, "light paths of which the ways through media are kept, where there are any"));
    return params;
}

}  // namespace

Kind photon_map_kind() {
    return {
        .name = "PhotonMap",
        .help = "photon mapping, light sent from the lamps beforehand: caustics, or an approximation of all light",
        .params = photon_map_params(),
        .light = {.space = true, .lamps = true, .groups = true, .paths = paths_of_photons},
        .run = {.prepares = true,
                .freezes = "photons",
                .landmarks = [](const NodeContext& here) { return landmarks_of(here.scene(), Shooting::of(here)); }},
        .reads = reading(scene_of_light | ScenePart::names),
        .make_light = [](const NodeContext& here) { return std::make_unique<PhotonMap>(here); },
    };
}

}  // namespace lightnet
