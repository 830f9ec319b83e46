#include "core/readers/pbrt/hair.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

namespace lightnet::pbrt {
namespace {

constexpr float unlimited = 1e9f;

/// A number or a texture; where it is the same everywhere it must lie between two others.
TextureId number_within(Parameters& parameters, Textures& textures, const char* name, float fallback, float least,
                        float most) {
    const auto given = textures.maybe_number(parameters, name);
    if (!given) return textures.constant({fallback, fallback, fallback});
    const auto everywhere = textures.constant_value(*given);
    const std::string range =
        most < unlimited ? fmt::format("{} to {}", least, most) : fmt::format("{} or more", least);
    if (everywhere && !(everywhere->r >= least && everywhere->r <= most))
        parameters.error(fmt::format("'{}' of hair is {}, not {}", name, range, everywhere->r));
    return *given;
}

/// pbrt takes the first of these that is given, and the rest is not looked at.
void set_colour(HairMaterial& hair, Parameters& parameters, Textures& textures) {
    using Colour = HairMaterial::Colour;
    const auto pigment = [&](const char* name, float fallback) {
        return number_within(parameters, textures, name, fallback, 0, unlimited);
    };
    const auto without = [&](const char* taken, std::initializer_list<const char*> others) {
        for (const char* other : others)
            if (parameters.find(other)) parameters.warn(fmt::format("'{}' is left out beside '{}'", other, taken));
    };
    const char* reflectance = parameters.find("reflectance") ? "reflectance" : "color";
    if (parameters.find("sigma_a")) {
        hair.colour = textures.colour(parameters, "sigma_a", {}, Use::index);
        without("sigma_a", {"reflectance", "color", "eumelanin", "pheomelanin"});
    } else if (parameters.find(reflectance)) {
        hair.means = Colour::reflectance;
        hair.colour = textures.colour(parameters, reflectance, {});
        without(reflectance, {"eumelanin", "pheomelanin"});
    } else {
        const bool given = parameters.find("eumelanin") || parameters.find("pheomelanin");
        hair.means = Colour::melanin;
        hair.colour = pigment("eumelanin", given ? 0 : 1.3f);
        hair.pheomelanin = pigment("pheomelanin", 0);
    }
}

}  // namespace

HairMaterial hair_material(Parameters& parameters, const MaterialSources& sources) {
    Textures& textures = sources.textures;
    HairMaterial hair;
    set_colour(hair, parameters, textures);
    hair.eta = number_within(parameters, textures, "eta", 1.55f, 1, unlimited);
    hair.along = number_within(parameters, textures, "beta_m", 0.3f, 0, 1);
    hair.around = number_within(parameters, textures, "beta_n", 0.3f, 0, 1);
    hair.tilt = number_within(parameters, textures, "alpha", 2, -90, 90);
    hair.across_by_v = true;
    return hair;
}

}  // namespace lightnet::pbrt
