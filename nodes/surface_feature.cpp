// Features of what the eye sees, by which noise is told from detail when a picture is cleaned.
#include <memory>
#include <string>

#include "core/base/math/samples.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {
namespace {

/// Answers as if a feature of the surface were light that it sends out: what mirrors and glass let through of it is
/// seen in them, and rough surfaces behind one in proportion to what they send.
class SurfaceFeature final : public LightOp {
public:
    explicit SurfaceFeature(const NodeContext& here)
        : scene_(here.scene()),
          eye_(transform_point(here.scene().seen_from().to_world, {0, 0, 0})),
          key_(here.key()),
          of_(here.text("of")) {}

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        for (std::size_t i = 0; i < questions.size(); ++i) {
            const SurfacePoint point = scene_.surface(questions[i]);
            answers[i] = of_ == "albedo"   ? albedo(point, questions[i])
                         : of_ == "normal" ? normal(point, questions[i])
                                           : depth(point);
        }
    }

private:
    // The mean of many samples' weights is the albedo for light that leaves towards the eye.
    Rgb albedo(const SurfacePoint& point, const Query& question) const {
        Samples samples(child(question.stream, key_), question.sample);
        const float choice = samples.next();
        const auto sample = scene_.bsdf(point).sample(question.outgoing, choice, samples.next_2d(), question.lobes);
        return sample ? sample->weight : Rgb{};
    }
    static Rgb normal(const SurfacePoint& point, const Query& question) {
        const Vec3 n = dot(point.normal, question.outgoing) < 0 ? -point.shading.z : point.shading.z;
        return {n.x, n.y, n.z};
    }
    Rgb depth(const SurfacePoint& point) const {
        const float far = length(point.position - eye_);
        return {far, far, far};
    }

    const Scene& scene_;
    Vec3 eye_;
    Key key_;
    std::string of_;
};

}  // namespace

Kind surface_feature_kind() {
    return {
        .name = "SurfaceFeature",
        .help =
            "an AOV, no light: a feature of the first surface that is no mirror or glass, times what of it reaches "
            "the eye; 'clean' of a film shows them",
        .params = {{.name = "of",
                    .type = ParamType::text,
                    .help =
                        "albedo: of rough lobes, towards the eye; normal: in the world, towards the eye; depth: the "
                        "distance from the eye",
                    .choices = {"albedo", "normal", "depth"}}},
        .light = {.paths = always({})},
        .reads = reading(ScenePart::camera | ScenePart::geometry | ScenePart::materials | ScenePart::media),
        .make_light = [](const NodeContext& here) { return std::make_unique<SurfaceFeature>(here); },
    };
}

}  // namespace lightnet
