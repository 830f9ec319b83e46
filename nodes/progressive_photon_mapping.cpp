// Maps of photons without end, each with a smaller radius than the one before: caustics that get sharp.
#include <cmath>
#include <memory>
#include <vector>

#include "core/estimate/gather_each.hpp"
#include "core/estimate/photon_tree.hpp"
#include "core/estimate/shooting.hpp"
#include "core/film/tile.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"
#include "core/network/light/services.hpp"
#include "core/scene/lamps/lights.hpp"

namespace lightnet {
namespace {

/// Knaus & Zwicker 2011, "Progressive photon mapping: a probabilistic approach". Sample s of every pixel has a map of
/// its own, with photons and a radius that follow from s alone, so that a picture is the mean of as many maps as it has
/// samples. Noise and bias both vanish as samples grow; at edges light is not lost (PhotonSpread). It is made anew for
/// each pass, and has the maps of that one. Others than the renderer ask about samples of their own: they get the maps
/// of the pass in turn. At points in media beams answer, whose radius shrinks alike: both blur in two dimensions
/// (Jarosz et al. 2011, "Progressive photon beams"). On what moves photons count within a window of time, which narrows
/// as the radius shrinks.
class ProgressivePhotonMapping final : public LightOp {
public:
    explicit ProgressivePhotonMapping(const NodeContext& here)
        : scene_(here.scene()),
          shooting_(Shooting::of(here)),
          beams_(shooting_of_beams(here, shooting_)),
          first_map_(std::uint64_t{here.pass()} * samples_per_block) {
        const double first = here.number("radius"), alpha = here.number("alpha");
        const double first_squared = std::pow(first > 0 ? first : 0.013 * scene_.radius(), 2);
        double squared = first_squared;
        for (std::uint64_t map = 0; map < first_map_ + samples_per_block; ++map) {
            if (map >= first_map_) {
                radii_.push_back(float(std::sqrt(squared)));
                windows_.push_back(photon_window * float(std::sqrt(squared / first_squared)));
            }
            squared *= (double(map) + 1 + alpha) / (double(map) + 2);  // equation 15
        }
    }

    void prepare(Services& services) override {
        if (beams_.emitted > 0) beam_maps_ = take_beams(services, scene_, beams_, first_map_, samples_per_block);
        const auto aim = take_aim(services, scene_, shooting_);
        const auto photons = shoot(services, scene_, shooting_, *aim, {first_map_, radii_});
        const std::size_t each = shards_each(shooting_);
        for (std::size_t map = 0; map < samples_per_block; ++map)
            maps_.push_back(services.once<PhotonTree>([&](Builders& builders) {
                std::vector<Photon> own;
                for (std::size_t i = map * each; i < (map + 1) * each; ++i)
                    own.insert(own.end(), photons.shard(i).begin(), photons.shard(i).end());
                return PhotonTree(own, builders);
            }));
    }

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        if (maps_.empty()) return;  // others rehearse
        Nearest scratch;
        gather_each(scene_, questions, [&](std::uint32_t i, const Gathering& at) {
            const std::size_t map = questions[i].sample % samples_per_block;
            const auto groups = answers.subspan(i * scene_.lights().groups(), scene_.lights().groups());
            if (!at.point.is_in_space())
                maps_[map]->radiance(
                    {at.point, at.bsdf, at.outgoing, at.lobes, window_of(scene_, questions[i], windows_[map])},
                    radii_[map], 0, scratch, groups);
            else if (!beam_maps_.empty())
                beam_maps_[map]->radiance(at, radii_[map], 0, scratch, groups);
        });
    }

private:
    const Scene& scene_;
    Shooting shooting_, beams_;
    std::uint64_t first_map_;
    std::vector<float> radii_;    // m, of each map of the pass
    std::vector<float> windows_;  // of each, a part of the shutter's time
    std::vector<std::shared_ptr<const PhotonTree>> maps_;
    std::vector<std::shared_ptr<const BeamTree>> beam_maps_;  // none: there are no media
};

std::vector<Param> progressive_photon_mapping_params() {
    auto params = shooting_params(100000, "light paths that leave the lamps for each sample of the pixels");
    params.push_back({.name = "alpha",
                      .type = ParamType::number,
                      .help = "how slowly the radius shrinks: 1 keeps it",
                      .initial = Value{0.6666666666666666},
                      .least = 0.01,
                      .most = 1});
    params.push_back({.name = "radius",
                      .type = ParamType::number,
                      .help = "within which photons of the first sample count; 0: 0.013 of the scene's radius",
                      .unit = "scene units",
                      .initial = Value{0.0},
                      .least = 0});
    params.push_back(beams_param(1000, "light paths of each sample of which the ways through media are kept"));
    return params;
}

}  // namespace

Kind progressive_photon_mapping_kind() {
    return {
        .name = "ProgressivePhotonMapping",
        .help = "progressive photon mapping: each sample has photons of its own, and is sharper than the one before",
        .params = progressive_photon_mapping_params(),
        .gone = {{"passes",
                  "each sample of a pixel has photons of its own now: 'samples' of the renderer says how many"}},
        .light = {.space = true, .lamps = true, .groups = true, .paths = paths_of_photons},
        .run = {.prepares = true, .passes = true},
        .reads = reading(scene_of_light | ScenePart::names),
        .make_light = [](const NodeContext& here) { return std::make_unique<ProgressivePhotonMapping>(here); },
    };
}

}  // namespace lightnet
