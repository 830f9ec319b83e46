// Where the records of an irradiance cache lie.
#include <memory>

#include "core/estimate/irradiance_octree.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {
namespace {

/// A dot of the irradiance's colour around each record that a cache has frozen, black between them: a picture of the
/// cache, not of light. Both sides of a surface show in one.
class RecordPositions final : public LightOp {
public:
    explicit RecordPositions(const NodeContext& here)
        : scene_(here.scene()), cache_(here.taken("of")), size_(static_cast<float>(here.number("size"))) {
        if (size_ == 0) size_ = scene_.radius() / 300;
    }

    void prepare(Services&) override { records_ = cache_.frozen().as<IrradianceOctree>(); }

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        if (!records_) return;  // others rehearse
        for (std::size_t i = 0; i < questions.size(); ++i) {
            const SurfacePoint point = scene_.surface(questions[i]);
            const auto* record = records_->nearest(point.position, point.normal, size_);
            if (!record) continue;
            const float most = max_component(record->irradiance);
            answers[i] = most > 0 ? record->irradiance / most : Rgb{0.25f, 0.25f, 0.25f};
        }
    }

private:
    const Scene& scene_;
    const LightOp& cache_;
    float size_;  // m
    std::shared_ptr<const IrradianceOctree> records_;
};

}  // namespace

Kind record_positions_kind() {
    return {
        .name = "RecordPositions",
        .help = "a picture of an irradiance cache, no light: a dot around each of its records",
        .params = {{.name = "of", .type = ParamType::node, .help = "the cache", .choices = {"irradiance records"}},
                   {.name = "size",
                    .type = ParamType::number,
                    .help = "radius of the dots; 0: a three-hundredth of the scene's radius. No further than the "
                            "record itself reaches",
                    .unit = "m",
                    .initial = Value{0.0},
                    .least = 0}},
        .light = {.paths = always({})},
        .run = {.prepares = true},
        .make_light = [](const NodeContext& here) { return std::make_unique<RecordPositions>(here); },
    };
}

}  // namespace lightnet
