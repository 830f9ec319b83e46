// The positions of an irradiance cache's records, as a picture.
#include <memory>

#include "core/estimate/irradiance_octree.hpp"
#include "core/estimate/picture_of.hpp"

namespace lightnet {
namespace {

/// A dot of the irradiance's colour around each record that a cache has frozen, black between them: an image of the
/// cache, not of light. Both sides of a surface show in one.
class RecordPositions final : public PictureOf<IrradianceOctree> {
public:
    explicit RecordPositions(const NodeContext& here) : PictureOf(here), size_(dot_size(here)) {}

private:
    Rgb colour(const IrradianceOctree& records, const SurfacePoint& point, Nearest&) const override {
        const auto* record = records.nearest(point.position, point.normal, size_);
        if (!record) return {};
        const float most = max_component(record->irradiance);
        return most > 0 ? record->irradiance / most : Rgb{0.25f, 0.25f, 0.25f};
    }

    float size_;  // m
};

}  // namespace

Kind record_positions_kind() {
    return picture_kind(
        "irradiance records", "the cache",
        {
            .name = "RecordPositions",
            .help = "an AOV, no light: a dot around each record of an irradiance cache",
            .params = {dot_size(". No further than the record itself reaches")},
            .reads = reading(ScenePart::geometry),
            .make_light = [](const NodeContext& here) { return std::make_unique<RecordPositions>(here); },
        });
}

}  // namespace lightnet
