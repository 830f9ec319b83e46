// The density of a map's photons, as a picture.
#include <memory>

#include "core/base/math/sampling.hpp"
#include "core/estimate/photon_tree.hpp"
#include "core/estimate/picture_of.hpp"
#include "core/estimate/shooting.hpp"

namespace lightnet {
namespace {

/// Photons per area, whatever they carry: (k - 1) / (π r²), r the distance of the k-th nearest; where fewer lie within
/// the radius, those per its disc. Tells whether a map has photons enough where it matters.
class PhotonDensity final : public PictureOf<PhotonTree> {
public:
    explicit PhotonDensity(const NodeContext& here)
        : PictureOf(here), gather_(static_cast<std::size_t>(here.integer("gather"))), radius_(gather_radius(here)) {}

private:
    Rgb colour(const PhotonTree& photons, const SurfacePoint& point, Nearest& scratch) const override {
        const auto found = photons.find({point.position, point.normal, radius_, gather_}, scratch);
        const bool enough = found.size() == gather_ && found.back().distance2 > 0;
        const float r2 = enough ? found.back().distance2 : radius_ * radius_;
        const float density = float(enough ? gather_ - 1 : found.size()) / (pi * r2);
        return {density, density, density};
    }

    std::size_t gather_;
    float radius_;  // m
};

}  // namespace

Kind photon_density_kind() {
    return picture_kind("photons", "the map",
                        {
                            .name = "PhotonDensity",
                            .help = "an AOV, no light: how many photons of a map there are per square scene unit",
                            .params = {{.name = "gather",
                                        .type = ParamType::integer,
                                        .help = "how many of the nearest photons are counted",
                                        .unit = "photons",
                                        .initial = Value{50.0},
                                        .least = 2,
                                        .most = 65536},
                                       gather_radius("how far away photons are counted")},
                            .reads = reading(ScenePart::geometry),
                            .make_light = [](const NodeContext& here) { return std::make_unique<PhotonDensity>(here); },
                        });
}

}  // namespace lightnet
