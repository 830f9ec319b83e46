// Direct light of the environment.
#include <algorithm>
#include <vector>

#include "core/base/math/samples.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"
#include "core/scene/lamps/lights.hpp"
#include "core/scene/scene.hpp"
#include "core/scene/scene_media.hpp"

namespace lightnet {
namespace {

/// Samples directions by the BSDF. What is in the way counts as black, even if it shines: that is what lamps bring.
class SkyLight final : public LightOp {
public:
    explicit SkyLight(const NodeContext& here)
        : scene_(here.scene()), key_(here.key()), samples_(static_cast<std::uint32_t>(here.integer("samples"))) {}

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        std::fill(answers.begin(), answers.end(), Rgb{});
        if (!scene_.lights().has_environment()) return;
        SkyRays rays;
        for (std::size_t i = 0; i < questions.size(); ++i) add_rays(questions[i], i, rays);
        rays.occluded.resize(rays.rays.size());
        scene_.occluded(rays.rays, rays.occluded);
        for (std::size_t k = 0; k < rays.rays.size(); ++k)
            if (!rays.occluded[k])
                answers[rays.askers[k] * scene_.lights().groups() + scene_.lights().environment_group()] +=
                    rays.light[k];
    }

private:
    struct SkyRays {
        std::vector<Ray> rays;
        std::vector<Rgb> light;  // that they bring if nothing is in the way
        std::vector<std::size_t> askers;
        std::vector<std::uint8_t> occluded;
    };

    void add_rays(const Query& question, std::size_t asker, SkyRays& rays) const {
        const SurfacePoint point = scene_.surface(question);
        const Bsdf bsdf = scene_.bsdf(point);
        const Key stream = child(question.stream, key_);
        for (std::uint32_t i = 0; i < samples_; ++i) {
            Samples samples(stream, question.sample * samples_ + i);
            const float choice = bsdf.chooses() ? samples.next() : samples.skip();
            const auto sample = bsdf.sample(question.outgoing, choice, samples.next_2d(), question.lobes);
            if (!sample) continue;
            const Ray ray = point.ray_towards(sample->incoming);
            rays.rays.push_back(ray);
            Rgb light = sample->weight * scene_.lights().environment(ray) / float(samples_);
            if (scene_.has_media()) light *= scene_.media().transmittance(ray, samples.next_2d());
            rays.light.push_back(light);
            rays.askers.push_back(asker);
        }
    }

    const Scene& scene_;
    Key key_;
    std::uint32_t samples_;
};

}  // namespace

Kind environment_kind() {
    return {
        .name = "Environment",
        .help = "direct light of the environment, without that of lamps; a part of DirectLighting",
        .params = {{.name = "samples",
                    .type = ParamType::integer,
                    .help = "directions per question",
                    .unit = "samples",
                    .initial = Value{1.0},
                    .least = 1,
                    .most = 65536}},
        .light = {.space = true, .lamps = true, .groups = true, .paths = always({"B(D|V)"})},
        .reads = reading(scene_of_light),
        .make_light = [](const NodeContext& here) { return std::make_unique<SkyLight>(here); },
    };
}

}  // namespace lightnet
