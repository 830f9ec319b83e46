// Mitsuba's hair.
#include <fmt/format.h>

#include "core/readers/mitsuba/bsdfs.hpp"
#include "core/readers/mitsuba/colours.hpp"

namespace lightnet::mitsuba {
namespace {

constexpr float unlimited = 1e9f;

float number_of_hair(Properties& properties, const char* name, float fallback, float least, float most) {
    const float value = properties.number(name, fallback);
    if (value >= least && value <= most) return value;
    const std::string range =
        most < unlimited ? fmt::format("{} to {}", least, most) : fmt::format("{} or more", least);
    properties.context().error(*properties.find(name),
                               fmt::format("'{}' of {} is {}, not {}", name, properties.owner(), range, value));
    return fallback;
}

}  // namespace

Material Bsdfs::hair(Properties& properties) {
    const auto constant = [&](const char* name, float fallback, float least, float most) {
        return context_.assets.grey(number_of_hair(properties, name, fallback, least, most));
    };
    HairMaterial model;
    const Node* absorption = properties.find("sigma_a");
    const Node* pigment = properties.has("eumelanin") ? properties.find("eumelanin") : properties.find("pheomelanin");
    const float scale = properties.number("scale", 1);
    if (absorption && pigment)
        context_.error(*pigment, "hair has either pigments ('eumelanin', 'pheomelanin') or an absorption ('sigma_a')");
    if (absorption) {
        Texture scaled = context_.assets.scene().textures[textures_.of(*absorption)];
        scaled.scale *= number_of_hair(properties, "scale", scale, 0, unlimited);
        model.colour = context_.assets.add(scaled);
    } else {
        model.means = HairMaterial::Colour::melanin;
        model.colour = constant("eumelanin", 1.3f, 0, unlimited);
        model.pheomelanin = constant("pheomelanin", 0.2f, 0, unlimited);
        if (scale != 1) context_.warn(*properties.find("scale"), "'scale' is left out: it is of 'sigma_a' alone");
    }
    const float eta = index_of(properties, "int_ior", "amber") / index_of(properties, "ext_ior", "air");
    if (!(eta > 1)) context_.error(properties.node(), "'int_ior' of hair must be above its 'ext_ior'");
    model.eta = context_.assets.grey(eta);
    model.along = constant("longitudinal_roughness", 0.3f, 0, 1);
    model.around = constant("azimuthal_roughness", 0.3f, 0, 1);
    model.tilt = constant("scale_tilt", 2, -90, 90);
    return {"", model};
}

}  // namespace lightnet::mitsuba
