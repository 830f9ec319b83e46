// The radiance that a guide has learnt, as a picture.
#include <memory>

#include "core/estimate/light_guide.hpp"
#include "core/estimate/picture_of.hpp"

namespace lightnet {
namespace {

/// The mean radiance that arrives at a surface, by its cosine, as a guide has learnt it: luminance. Light of
/// lamps and skies counts by the share that MIS leaves to directions. Of both sides, that on the side of the normal if
/// the guide knows it. Black where it knows nothing, and everywhere if paths are not guided as that would not pay.
class GuideRadiance final : public PictureOf<LightGuide> {
public:
    using PictureOf::PictureOf;

private:
    Rgb colour(const LightGuide& guide, const SurfacePoint& point, Nearest&) const override {
        for (const Vec3 outgoing : {point.normal, -point.normal})
            if (const auto* cell = guide.find(point.position, GuideSide::of(point.normal, point.shading.z, outgoing)))
                return {cell->radiance, cell->radiance, cell->radiance};
        return {};
    }
};

}  // namespace

Kind guide_radiance_kind() {
    return picture_kind("light directions", "the guide",
                        {
                            .name = "GuideRadiance",
                            .help = "an AOV, no light: the mean radiance that a guide takes to arrive, W·sr⁻¹·m⁻²",
                            .reads = reading(ScenePart::geometry),
                            .make_light = [](const NodeContext& here) { return std::make_unique<GuideRadiance>(here); },
                        });
}

}  // namespace lightnet
