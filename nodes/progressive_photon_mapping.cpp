// Many maps of photons, each with a smaller radius than the one before: caustics that get sharp.
#include <cassert>
#include <cmath>
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

/// Knaus & Zwicker 2011, "Progressive photon mapping: a probabilistic approach". Each pass has photons of its own, and
/// a radius that follows from its number alone; sample s of a pixel looks at pass s modulo `passes`, so that a picture
/// of as many samples is the mean of all passes. Noise and bias both vanish as passes and samples grow.
class ProgressivePhotonMapping final : public LightOp {
public:
    explicit ProgressivePhotonMapping(const NodeContext& here) : scene_(here.scene()), shooting_(Shooting::of(here)) {
        const double first = here.number("radius"), alpha = here.number("alpha");
        double squared = std::pow(first > 0 ? first : 0.013 * scene_.radius(), 2);
        const auto passes = static_cast<std::size_t>(here.integer("passes"));
        for (std::size_t pass = 1; pass <= passes; ++pass) {
            radii_.push_back(float(std::sqrt(squared)));
            squared *= (double(pass) + alpha) / (double(pass) + 1);  // equation 15
        }
    }

    void prepare(Services& services) override {
        const auto aim = take_aim(services, scene_, shooting_);
        const auto photons = shoot(services, scene_, shooting_, *aim, radii_.size());
        const std::size_t each = shards_each(shooting_), places = services.whereabouts().places;
        for (std::size_t pass = 0; pass < radii_.size(); ++pass)
            passes_.push_back(services.once<PhotonTree>([&] {
                std::vector<Photon> own;
                for (std::size_t i = pass * each; i < (pass + 1) * each; ++i)
                    own.insert(own.end(), photons.shard(i).begin(), photons.shard(i).end());
                return PhotonTree(own, places);
            }));
    }

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        assert(passes_.size() == radii_.size() && "nobody asks before it is prepared");
        Nearest scratch;
        gather_each(scene_, questions, [&](std::uint32_t i, const Gathering& at) {
            const std::size_t pass = questions[i].sample % radii_.size();
            answers[i] = passes_[pass]->radiance({at.point, at.bsdf, at.outgoing, at.lobes}, radii_[pass], 0, scratch);
        });
    }

private:
    const Scene& scene_;
    Shooting shooting_;
    std::vector<float> radii_;  // m, of each pass
    std::vector<std::shared_ptr<const PhotonTree>> passes_;
};

std::vector<Param> progressive_photon_mapping_params() {
    auto params = shooting_params(100000, "ways of light that leave the lamps in each pass");
    params.push_back({.name = "passes",
                      .type = ParamType::integer,
                      .help = "maps, each for one sample of a pixel in turn: as many as samples, or a part of them",
                      .unit = "passes",
                      .initial = Value{64.0},
                      .least = 1,
                      .most = 65536});
    params.push_back({.name = "alpha",
                      .type = ParamType::number,
                      .help = "how slowly the radius shrinks: 1 keeps it",
                      .initial = Value{0.6666666666666666},
                      .least = 0.01,
                      .most = 1});
    params.push_back({.name = "radius",
                      .type = ParamType::number,
                      .help = "within which photons of the first pass count; 0: 0.013 of the scene's radius",
                      .unit = "m",
                      .initial = Value{0.0},
                      .least = 0});
    return params;
}

}  // namespace

Kind progressive_photon_mapping_kind() {
    return {
        .name = "ProgressivePhotonMapping",
        .help = "light that was sent from the lamps in many passes, each sharper: caustics without bias in the end",
        .prepares = true,
        .paths = paths_of_photons,
        .params = progressive_photon_mapping_params(),
        .make_light = [](const NodeContext& here) { return std::make_unique<ProgressivePhotonMapping>(here); },
    };
}

}  // namespace lightnet
