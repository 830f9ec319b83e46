// Ambient occlusion: the openness of a point's surroundings.
#include <limits>

#include "core/base/math/samples.hpp"
#include "core/base/math/sampling.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {
namespace {

/// Ambient occlusion: answers with the share of cosine-weighted directions, on the side of the surface that is asked
/// about, in which nothing is near: 1 in the open, 0 in a closed corner, in all channels and whatever the material.
class AmbientOcclusion final : public LightOp {
public:
    explicit AmbientOcclusion(const NodeContext& here)
        : scene_(here.scene()),
          key_(here.key()),
          samples_(static_cast<std::uint32_t>(here.integer("samples"))),
          distance_(static_cast<float>(here.number("distance"))) {
        if (distance_ == 0) distance_ = std::numeric_limits<float>::infinity();
    }

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        for (std::size_t i = 0; i < questions.size(); ++i) {
            const float open = openness(questions[i]);
            answers[i] = {open, open, open};
        }
    }

private:
    float openness(const Query& question) const {
        const SurfacePoint point = scene_.surface(question);
        const Vec3 up = dot(question.outgoing, point.normal) < 0 ? -point.normal : point.normal;
        const Frame frame = Frame::around(up);
        const Key stream = child(question.stream, key_);
        std::uint32_t open = 0;
        for (std::uint32_t i = 0; i < samples_; ++i) {
            Samples samples(stream, question.sample * samples_ + i);
            const Vec3 direction = frame.to_world(cosine_hemisphere(samples.next_2d()));
            open += !scene_.occluded({point.origin_towards(up), direction, distance_, point.time});
        }
        return float(open) / float(samples_);
    }

    const Scene& scene_;
    Key key_;
    std::uint32_t samples_;
    float distance_;
};

}  // namespace

Kind ambient_occlusion_kind() {
    return {
        .name = "AmbientOcclusion",
        .help = "ambient occlusion: how open the surroundings of a point are, 1 where nothing is near",
        .params =
            {
                {.name = "samples",
                 .type = ParamType::integer,
                 .help = "directions per question",
                 .unit = "samples",
                 .initial = Value{16.0},
                 .least = 1,
                 .most = 65536},
                {.name = "distance",
                 .type = ParamType::number,
                 .help = "how far away a surface still counts; 0: any distance",
                 .unit = "scene units",
                 .initial = Value{0.0},
                 .least = 0},
            },
        .light = {.paths = always({})},
        .reads = reading(ScenePart::geometry),
        .make_light = [](const NodeContext& here) { return std::make_unique<AmbientOcclusion>(here); },
    };
}

}  // namespace lightnet
