#include "core/readers/pbrt/lights.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "core/base/suggestion.hpp"
#include "core/readers/common/light_profile.hpp"
#include "core/readers/common/turns.hpp"
#include "core/readers/pbrt/older_light.hpp"
#include "core/readers/pbrt/pictured_lights.hpp"
#include "core/readers/pbrt/transforms.hpp"
#include "core/scene/bare_lights/environment.hpp"
#include "core/scene/bare_lights/slide_light.hpp"

namespace lightnet::pbrt {
namespace {

constexpr float float_pi = std::numbers::pi_v<float>;

/// pbrt-v4's number; pbrt-v3 has a colour. None: reported.
std::optional<Rgb> scale_of(Parameters& parameters, const Sources& sources) {
    if (!sources.older()) {
        const float scale = parameters.number("scale", 1);
        if (scale < 0) parameters.error("'scale' must not be negative");
        return Rgb{1, 1, 1} * std::max(scale, 0.0f);
    }
    const Parameter* given = parameters.find("scale");
    if (given && given->type == Type::number) parameters.warn_type(*given, "rgb");
    if (!given || given->type == Type::number) return Rgb{1, 1, 1};
    const auto colour = light_of(*given, sources);
    return colour ? std::optional(colour->rgb) : std::nullopt;
}

/// pbrt-v4 gives a light of rgb the luminance that the numbers say, and any other spectrum luminance 1; then `scale`.
std::optional<Rgb> strength(Parameters& parameters, const Sources& sources, const char* name) {
    Rgb colour{1, 1, 1};
    if (sources.older()) parameters.ignore({"samples", "nsamples"});  // how it is sampled
    if (const Parameter* given = parameters.find(name)) {
        const auto found = light_of(*given, sources);
        if (!found) return std::nullopt;
        colour = found->rgb;
    }
    const auto scale = scale_of(parameters, sources);
    if (!scale) return std::nullopt;
    const Rgb strength = colour * *scale;
    if (finite(strength)) return strength;
    parameters.error("the light is infinitely bright");
    return std::nullopt;
}

/// Not of pbrt, whose files name no light; pbrt lets it pass in an Attribute statement.
LampLabel label_of(Parameters& parameters) { return {parameters.text("name", "")}; }

/// An image and a colour exclude each other; in pbrt-v3 they are multiplied.
std::string picture_file(Parameters& parameters, const char* colour, const Sources& sources) {
    if (sources.older()) return parameters.file("mapname");
    const std::string file = parameters.file("filename");
    if (!file.empty() && *colour && parameters.find(colour))
        parameters.error(fmt::format("'{}' and 'filename' exclude each other", colour));
    return file;
}

Vec3 point(Parameters& parameters, const char* name, Vec3 fallback) {
    const auto given = parameters.triples(name, Type::point3);
    if (given.size() == 1) return given[0];
    if (!given.empty()) parameters.error(fmt::format("'{}' must be one point", name));
    return fallback;
}

/// Power in watts, if it is given and makes sense.
std::optional<float> power_of(Parameters& parameters) {
    const float power = parameters.number("power", -1);
    return power > 0 ? std::optional(power) : std::nullopt;
}

/// What the makers of lights have in common.
struct Making {
    Parameters& parameters;
    Textures& textures;
    const Sources& sources;
    const Matrix& to_world;
    SceneData& scene;
    LampLabel label;
};

std::optional<float> power_of(const Making& making) {
    return making.sources.older() ? std::nullopt : power_of(making.parameters);
}
/// What only pbrt-v4 has.
std::optional<float> illuminance_of(const Making& making) {
    const float lux = making.sources.older() ? -1 : making.parameters.number("illuminance", -1);
    return lux > 0 ? std::optional(lux) : std::nullopt;
}

/// Where the axis of a light goes in the world. None: reported.
std::optional<Vec3> axis_of(const Making& making, Vec3 from, Vec3 to) {
    const Vec3 axis = transform_direction(making.to_world, to - from);
    const float size = length(axis);
    if (size > 0 && std::isfinite(size)) return axis / size;
    making.parameters.error("'from' and 'to' are the same");
    return std::nullopt;
}

void point_light(const Making& making) {
    auto colour = strength(making.parameters, making.sources, "I");
    const Vec3 from = transform_point(making.to_world, point(making.parameters, "from", {}));
    if (const auto power = power_of(making); power && colour) *colour *= *power / (4 * float_pi);
    if (colour) making.scene.lights.push_back(PointLight{from, *colour, making.label, {}, turn_of(making.to_world)});
}

void spot_light(const Making& making) {
    auto& parameters = making.parameters;
    auto colour = strength(parameters, making.sources, "I");
    const Vec3 from = point(parameters, "from", {}), to = point(parameters, "to", {0, 0, 1});
    const auto axis = axis_of(making, from, to);
    const float outer = parameters.number("coneangle", 30), width = parameters.number("conedeltaangle", 5);
    if (!(outer > 0 && outer <= 180 && width >= 0 && width <= 2 * outer)) {
        parameters.error(
            "'coneangle' must be above 0 and at most 180 degrees, and 'conedeltaangle' from 0 to twice that");
        return;
    }
    const float inner = std::fabs(outer - width);  // pbrt knows it by its cosine alone
    SpotLight light;
    light.position = transform_point(making.to_world, from);
    if (making.sources.older()) light.falloff = SpotLight::Falloff::fourth_power;
    light.inner = inner * float_pi / 180, light.outer = outer * float_pi / 180;
    if (const auto power = power_of(making); power && colour) {
        const float start = std::cos(light.inner), end = std::cos(light.outer);
        *colour *= *power / (2 * float_pi * ((1 - start) + (start - end) / 2));
    }
    if (!colour || !axis) return;
    light.axis = *axis, light.intensity = *colour, light.label = making.label;
    light.luminaire = turn_of(making.to_world * hung(normalize(to - from)));
    making.scene.lights.push_back(light);
}

void distant_light(const Making& making) {
    auto colour = strength(making.parameters, making.sources, "L");
    const Vec3 from = point(making.parameters, "from", {}), to = point(making.parameters, "to", {0, 0, 1});
    const auto axis = axis_of(making, from, to);
    if (const auto lux = illuminance_of(making); lux && colour) *colour *= *lux;
    if (colour && axis) making.scene.lights.push_back(DirectionalLight{*axis, *colour, making.label});
}

/// What the matrix of a picture around a light turns, and perhaps mirrors.
Matrix turn_of(const Making& making) {
    if (!uniform_scale(making.to_world)) making.parameters.warn("an environment is turned, but not stretched");
    return turn_of(making.to_world);
}

// pbrt's rectangle, whose corners are in world space whatever the transform; light comes in against the cross product
// of the sides from its first corner to the last and to the second.
std::optional<Portal> portal_of(Parameters& parameters) {
    if (!parameters.find("portal")) return {};
    const auto corners = parameters.triples("portal", Type::point3);
    constexpr float square = 1e-3f;  // cosine to a right angle
    const auto nearly_0 = [](Vec3 a, Vec3 b) { return std::fabs(dot(a, b)) <= square * length(a) * length(b); };
    if (corners.size() == 4) {
        const Portal portal{corners[0], corners[3] - corners[0], corners[1] - corners[0]};
        const Vec3 across = corners[2] - corners[1] - portal.side;
        const bool flat = length(across) <= square * length(portal.side);
        if (flat && nearly_0(portal.side, portal.other) && length(cross(portal.side, portal.other)) > 0) return portal;
    }
    parameters.error("'portal' is not four corners of a rectangle, one after the other");
    return {};
}

void infinite_light(const Making& making) {
    auto& parameters = making.parameters;
    EnvironmentData environment;
    environment.to_world = turn_of(making);
    const auto colour = strength(parameters, making.sources, "L");
    const std::string file = picture_file(parameters, "L", making.sources);
    if (!file.empty()) {
        environment.image = making.textures.pictures().get(file, {}, parameters.where());
        if (!environment.image) return;
        making.textures.pictures().finish();  // its shape tells how it is laid out
        environment.layout =
            making.sources.older() ? EnvironmentData::Layout::latitude_longitude : layout_of(*environment.image);
    }
    if (making.sources.older())
        environment.to_world = environment.to_world * older_sky_axes();
    else
        environment.portal = portal_of(parameters);
    if (!colour) return;
    environment.radiance = *colour;
    if (const auto lux = illuminance_of(making)) {
        // of the upper half, as pbrt takes it
        const float now = environment.image ? upper_illuminance(environment) : float_pi;
        if (now > 0) environment.radiance *= *lux / now;
    }
    making.scene.environments.push_back(environment);
}

/// As pbrt takes the picture of a goniometric light: the same part of all colours into each direction.
std::shared_ptr<const Image> in_grey(const Image& image) {
    std::vector<Rgb> pixels;
    for (std::uint32_t y = 0; y < image.height; ++y)
        for (std::uint32_t x = 0; x < image.width; ++x) {
            const Rgb c = image.colour(x, y);
            pixels.push_back(Rgb{1, 1, 1} * ((c.r + c.g + c.b) / 3));
        }
    return std::make_shared<const Image>(image.width, image.height, pixels);
}

bool names_a_profile(const std::string& file) {
    return file.size() > 4 && same_but_for_case(std::string_view(file).substr(file.size() - 4), ".ies");
}

/// That of a luminaire's maker, which pbrt does not read.
std::optional<EnvironmentData> light_profile(const Making& making, const std::string& file) {
    const auto bytes = making.sources.read(file, making.parameters.where());
    if (!bytes) return std::nullopt;
    try {
        const auto profile = read_light_profile({reinterpret_cast<const char*>((*bytes)->data()), (*bytes)->size()});
        if (const std::string lacks = lacks_of_tilt(profile, false); !lacks.empty()) making.parameters.warn(lacks);
        EnvironmentData pattern = pattern_of(profile, turn_of(making));
        pattern.radiance *= profile.tilt.straight();
        return pattern;
    } catch (const Error& problem) {
        making.parameters.error(fmt::format("'{}': {}", file, problem.what()));
        return std::nullopt;
    }
}

/// The picture by which a goniometric light shines: of pbrt-v4 a square of equal areas whose middle is y; of pbrt-v3 by
/// latitude and longitude, in colour. None: reported, or there is none.
std::optional<EnvironmentData> goniogram(const Making& making) {
    const std::string file = picture_file(making.parameters, "", making.sources);
    if (names_a_profile(file)) return light_profile(making, file);
    const auto image = file.empty() ? nullptr : making.textures.pictures().get(file, {}, making.parameters.where());
    making.textures.pictures().finish();
    if (!image || image->empty()) return std::nullopt;
    EnvironmentData pattern;
    pattern.image = making.sources.older() ? image : in_grey(*image);
    pattern.to_world = turn_of(making);
    if (making.sources.older()) {
        pattern.to_world = pattern.to_world * older_goniometer_axes();
        return pattern;
    }
    if (image->width != image->height)
        making.parameters.error("the picture of a goniometric light is a square of equal areas, as pbrt-v4 has it");
    pattern.layout = EnvironmentData::Layout::equal_area;
    Matrix swap;
    swap.m[1] = {0, 0, 1, 0}, swap.m[2] = {0, 1, 0, 0};
    pattern.to_world = pattern.to_world * swap;
    return pattern;
}

/// Its mean over all directions.
float mean_over_directions(const EnvironmentData& pattern) {
    if (pattern.layout == EnvironmentData::Layout::equal_area) return mean_luminance(*pattern.image);
    return luminance(Environment(pattern).total()) / (4 * float_pi);
}

void goniometric_light(const Making& making) {
    auto colour = strength(making.parameters, making.sources, "I");
    PointLight light{
        transform_point(making.to_world, {}), {}, making.label, goniogram(making), turn_of(making.to_world)};
    if (const auto power = power_of(making); power && colour) {
        const float mean = light.pattern ? mean_over_directions(*light.pattern) : 1;
        *colour *= mean > 0 ? *power / (4 * float_pi * mean) : 0;
    }
    if (!colour) return;
    light.intensity = *colour;
    making.scene.lights.push_back(std::move(light));
}

void projection_light(const Making& making) {
    auto& parameters = making.parameters;
    auto colour = strength(parameters, making.sources, "I");
    const std::string file = picture_file(parameters, "", making.sources);
    if (file.empty())
        parameters.error(making.sources.older() ? "parameter 'mapname' is missing" : "parameter 'filename' is missing");
    const float fov = parameters.number("fov", making.sources.older() ? 45 : 90);
    if (!(fov > 0 && fov < 180)) parameters.error("'fov' must be between 0 and 180 degrees");
    const auto image = file.empty() ? nullptr : making.textures.pictures().get(file, {}, parameters.where());
    making.textures.pictures().finish();
    const auto axis = axis_of(making, {}, {0, 0, 1});
    if (!image || image->empty() || !colour || !axis || !(fov > 0 && fov < 180)) return;
    SpotLight light;
    light.position = transform_point(making.to_world, {});
    light.label = making.label;
    light.axis = *axis;
    light.luminaire = turn_of(making.to_world * hung({0, 0, 1}));
    light.intensity = *colour;
    // the picture's first row is at +y in pbrt-v4, at -y in pbrt-v3
    Matrix rows_down;
    rows_down.m[1][1] = making.sources.older() ? 1 : -1;
    Slide slide{image, turn_of(making) * rows_down};
    // the angle is that of the shorter side
    const float tangent = std::tan(fov / 2 * float_pi / 180), shape = float(image->width) / float(image->height);
    slide.half_width = tangent * std::max(1.0f, shape), slide.half_height = tangent * std::max(1.0f, 1 / shape);
    light.outer = light.inner = std::atan(std::hypot(slide.half_width, slide.half_height)) + 1e-3f;
    light.slide = slide;
    if (const auto power = power_of(making)) {
        const float now = luminance(SlideLight(light).power());
        light.intensity *= now > 0 ? *power * luminance(light.intensity) / now : 0;
    }
    making.scene.lights.push_back(light);
}

using LightMaker = void (*)(const Making&);

const std::map<std::string, LightMaker>& light_makers() {
    static const std::map<std::string, LightMaker> table{
        {"distant", distant_light},   {"exinfinite", infinite_light}, {"goniometric", goniometric_light},
        {"infinite", infinite_light}, {"point", point_light},         {"projection", projection_light},
        {"spot", spot_light}};
    return table;
}

}  // namespace

AreaEmission AreaLight::on(double area) const {
    if (!power || !(area > 0) || !(brightness > 0)) return emission;
    const double sides = emission.two_sided ? 2 : 1;
    AreaEmission scaled = emission;
    scaled.radiance *= float(*power / (sides * area * std::numbers::pi * brightness));
    return scaled;
}

std::optional<AreaLight> make_area_light(const std::string& type, Parameters& parameters, Textures& textures,
                                         const Sources& sources) {
    if (type != "diffuse" && !(type == "area" && sources.older())) {
        parameters.error(fmt::format("unknown area light '{}' (there is 'diffuse')", type));
        parameters.ignore_all();
        return std::nullopt;
    }
    AreaLight light;
    light.emission.two_sided = parameters.boolean("twosided", false);
    if (!sources.older()) light.power = power_of(parameters);
    const auto colour = strength(parameters, sources, "L");
    const std::string file = sources.older() ? "" : picture_file(parameters, "L", sources);
    if (!file.empty()) {
        ImageTexture picture;
        picture.image = textures.pictures().get(file, {}, parameters.where());
        if (picture.image && light.power) {
            textures.pictures().finish();
            light.brightness = mean_luminance(*picture.image);
        }
        if (picture.image) light.emission.texture = textures.add({{1, 1, 1}, std::move(picture), false});
    }
    light.emission.label = label_of(parameters);
    if (!colour) return std::nullopt;
    light.emission.radiance = *colour;
    return light;
}

void add_light(const std::string& type, Parameters& parameters, Textures& textures, const Sources& sources,
               const Matrix& to_world, SceneData& scene) {
    const bool known_there = type != "exinfinite" || sources.older();
    if (const auto maker = light_makers().find(type); maker != light_makers().end() && known_there)
        return maker->second({parameters, textures, sources, to_world, scene, label_of(parameters)});
    std::vector<std::string> known;
    for (const auto& [name, maker] : light_makers()) known.push_back(name);
    parameters.error(fmt::format("unknown light '{}'{}", type, did_you_mean(type, known)));
    parameters.ignore_all();
}

}  // namespace lightnet::pbrt
