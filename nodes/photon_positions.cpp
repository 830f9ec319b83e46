// The positions of a map's photons, as a picture.
#include <memory>

#include "core/estimate/photon_tree.hpp"
#include "core/estimate/picture_of.hpp"

namespace lightnet {
namespace {

/// A dot of the photon's colour around each photon that a map has frozen, black between them: an image of the map, not
/// of light.
class PhotonPositions final : public PictureOf<PhotonTree> {
public:
    explicit PhotonPositions(const NodeContext& here) : PictureOf(here), size_(dot_size(here)) {}

private:
    Rgb colour(const PhotonTree& photons, const SurfacePoint& point, Nearest& scratch) const override {
        const auto found = photons.find({point.position, point.normal, size_, 1}, scratch);
        if (found.empty()) return {};
        const Rgb flux = photons[found.front().index].flux;
        return flux / max_component(flux);
    }

    float size_;  // m
};

}  // namespace

Kind photon_positions_kind() {
    return picture_kind(
        "photons", "the map",
        {
            .name = "PhotonPositions",
            .help = "an AOV, no light: a dot around each photon of a map",
            .params = {dot_size()},
            .reads = reading(ScenePart::geometry),
            .make_light = [](const NodeContext& here) { return std::make_unique<PhotonPositions>(here); },
        });
}

}  // namespace lightnet
