// pbrt's media whose density changes in space.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "core/base/suggestion.hpp"
#include "core/readers/common/grid_file.hpp"
#include "core/readers/common/inverse.hpp"
#include "core/readers/pbrt/glow.hpp"
#include "core/readers/pbrt/media.hpp"
#include "core/scene/textures/noise.hpp"

namespace lightnet::pbrt {
namespace {

std::optional<Box> box_of(Parameters& parameters) {
    const auto corner = [&](const char* name, Vec3 fallback) {
        const auto given = parameters.triples(name, Type::point3);
        return given.empty() ? fallback : given[0];
    };
    Box box;
    box.add(corner("p0", {0, 0, 0}));
    box.add(corner("p1", {1, 1, 1}));
    const Vec3 size = box.size();
    if (finite(box.low) && finite(size) && size.x > 0 && size.y > 0 && size.z > 0) return box;
    parameters.error("'p0' and 'p1' span no box");
    return std::nullopt;
}

// From world space to the unit cube that a box of the medium's own space is.
std::optional<Matrix> to_cube(const Box& box, const Matrix& to_world) {
    Matrix unit;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        unit.m[axis][axis] = 1 / double(box.size()[axis]);
        unit.m[axis][3] = -double(box.low[axis]) / double(box.size()[axis]);
    }
    const auto to_own = inverse(to_world);
    return to_own ? std::optional(unit * *to_own) : std::nullopt;
}

// The numbers of a grid, x fastest, as the file lists them. None: they aren't given, or reported.
std::shared_ptr<const VolumeGrid> grid_of(Parameters& parameters, const char* name, std::uint32_t channels) {
    const Parameter* given = parameters.find(name);
    if (!given) return nullptr;
    VolumeGrid grid;
    grid.fades = true;
    grid.channels = channels;
    double points = 1;
    const std::array<const char*, 3> sides{"nx", "ny", "nz"};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const int size = parameters.integer(sides[axis], 1);
        grid.size[axis] = static_cast<std::uint32_t>(std::max(size, 1));
        points *= std::max(size, 1);
    }
    if (points * channels != double(given->numbers.size())) {
        parameters.error(fmt::format("'{}' has {} numbers where nx, ny and nz ask for {:.0f}", name,
                                     given->numbers.size(), points * channels));
        return nullptr;
    }
    grid.values = given->numbers;
    return std::make_shared<const VolumeGrid>(std::move(grid));
}

// pbrt's slopes of its noise.
Vec3 slopes(Vec3 p) {
    constexpr float step = 0.01f;
    const float here = noise(p);
    return Vec3{noise({p.x + step, p.y, p.z}) - here, noise({p.x, p.y + step, p.z}) - here,
                noise({p.x, p.y, p.z + step}) - here} /
           step;
}

// The density of pbrt's cloud, 0 … 1; y is up.
struct CloudShape {
    float density, wispiness, frequency;

    float at(Vec3 p) const {
        Vec3 place = p * frequency;
        float height = 0.05f * wispiness, octave = 10;
        for (int i = 0; i < 2 && wispiness > 0; ++i, height *= 0.5f, octave *= 1.99f)
            place = place + slopes(place * octave) * height;
        float sum = 0, share = 0.5f;
        octave = 1;
        for (int i = 0; i < 5; ++i, share *= 0.5f, octave *= 1.99f) sum += share * noise(place * octave);
        const float low = std::clamp((1 - p.y) * 4.5f * density * sum, 0.0f, 1.0f);
        return std::clamp(low + 2 * std::max(0.0f, 0.5f - p.y), 0.0f, 1.0f);
    }
};

/// One number for all of space.
Rgb alike(float value) { return {value, value, value}; }

constexpr std::string_view glow_at_points =
    "what a medium emits by its temperature is worked out at the points of its density, and linear between them";

/// How a temperature of a file becomes one in kelvin.
Heat heat_of(Parameters& parameters, VolumeField grid) {
    const float offset = parameters.number("temperatureoffset", parameters.number("temperaturecutoff", 0));
    return {std::move(grid), offset, parameters.number("temperaturescale", 1)};
}

}  // namespace

/// Media whose density changes in space.
bool Media::gridded(const std::string& type, const Matrix& to_world, Parameters& parameters, Medium& medium) {
    if (type == "nanovdb") return nanovdb(to_world, parameters, medium);
    const auto box = box_of(parameters);
    const auto to_grid = box ? to_cube(*box, to_world) : std::nullopt;
    if (box && !to_grid) parameters.error("the transform of a medium is singular");
    if (!to_grid) return false;
    for (VolumeField* field : {&medium.extinction, &medium.albedo, &medium.emission}) field->to_grid = *to_grid;
    if (type == "rgbgrid") return coloured_grid(parameters, medium);
    coloured(parameters, medium, {1, 1, 1}, {1, 1, 1});
    if (type == "cloud")
        cloud(parameters, medium, *box);
    else
        medium.extinction.grid = grid_of(parameters, "density", 1);
    if (!medium.extinction.grid) return false;
    if (!is_black(medium.albedo.value)) medium.albedo.grid = medium.extinction.grid;
    return type == "cloud" || shine_of_grid(parameters, medium);
}

/// 'Le' of a uniform grid, or its 'temperature', each times 'Lescale', which may be a grid.
bool Media::shine_of_grid(Parameters& parameters, Medium& medium) {
    VolumeField& emission = medium.emission;
    const Parameter* scale = parameters.find("Lescale");
    const auto scales = scale && scale->numbers.size() > 1 ? grid_of(parameters, "Lescale", 1) : nullptr;
    if (const auto heat = grid_of(parameters, "temperature", 1)) {
        if (!is_black(emission.value)) parameters.error("'Le' and 'temperature' exclude each other");
        parameters.warn(std::string(glow_at_points));
        emission.value = medium.extinction.value - medium.albedo.value;
        emission.grid = glowing(medium.extinction, heat_of(parameters, {{1, 1, 1}, heat, medium.extinction.to_grid}));
    } else if (!is_black(emission.value)) {
        emission.grid = medium.extinction.grid;
    }
    if (!emission.grid)
        emission.value = {};
    else if (scales)
        emission.grid = product_of(*emission.grid, *scales);
    if (!scales) emission.value *= scale && scale->numbers.size() > 1 ? 1 : parameters.number("Lescale", 1);
    return true;
}

bool Media::coloured_grid(Parameters& parameters, Medium& medium) {
    const Rgb scale = alike(parameters.number("scale", 1));
    const auto absorbed = grid_of(parameters, "sigma_a", 3), scattered = grid_of(parameters, "sigma_s", 3),
               light = grid_of(parameters, "Le", 3);
    if (!absorbed && !scattered) return false;
    VolumeGrid sum = absorbed ? *absorbed : *scattered;
    if (absorbed && scattered)
        for (std::size_t i = 0; i < sum.values.size(); ++i) sum.values[i] += scattered->values[i];
    medium.extinction.grid = std::make_shared<const VolumeGrid>(std::move(sum));
    medium.extinction.value = scale;
    medium.albedo.grid = scattered;
    medium.albedo.value = scattered ? scale : Rgb{};
    if (light && !absorbed) parameters.error("what emits ('Le') must absorb: 'sigma_a' is missing");
    if (!light || !absorbed) return true;
    medium.emission.grid = product_of(*absorbed, *light);
    medium.emission.value = scale * parameters.number("Lescale", 1);
    return true;
}

/// The density of a file, and what its temperature emits.
bool Media::nanovdb(const Matrix& to_world, Parameters& parameters, Medium& medium) {
    const std::string file = parameters.file("filename");
    if (file.empty()) parameters.error("parameter 'filename' is missing");
    const auto bytes = file.empty() ? std::nullopt : sources_.read(file, parameters.where());
    coloured(parameters, medium, {1, 1, 1}, {1, 1, 1});
    const Rgb absorbed = medium.extinction.value - medium.albedo.value;
    if (!is_black(medium.emission.value)) parameters.warn("'Le' is left out: a 'nanovdb' shines by its temperature");
    medium.emission.value = {};
    const auto to_own = inverse(to_world);
    if (!to_own) parameters.error("the transform of a medium is singular");
    if (!bytes || !to_own) return false;
    const auto field = [&](const SparseGrid& grid) {
        return VolumeField{{1, 1, 1}, grid.grid, grid.to_grid * *to_own};
    };
    try {
        const auto density = read_grid(**bytes, "density"), heat = read_grid(**bytes, "temperature");
        if (!density) {
            parameters.error(
                fmt::format("'{}' has no grid 'density'{}", file, did_you_mean("density", names_of_grids(**bytes))));
            return false;
        }
        for (VolumeField* of : {&medium.extinction, &medium.albedo, &medium.emission}) {
            const Rgb value = of->value;
            *of = field(*density);
            of->value = value;
        }
        if (is_black(medium.albedo.value)) medium.albedo.grid = nullptr;
        const Heat hot = heat_of(parameters, heat ? field(*heat) : VolumeField());
        const float scale = parameters.number("LeScale", 1);
        medium.emission.grid = heat ? glowing(medium.extinction, hot) : nullptr;
        if (!medium.emission.grid) return true;
        medium.emission.value = absorbed * scale;
        parameters.warn(std::string(glow_at_points));
    } catch (const Error& problem) {
        parameters.error(fmt::format("'{}': {}", file, problem.what()));
        return false;
    }
    return true;
}

void Media::cloud(Parameters& parameters, Medium& medium, const Box& box) {
    const CloudShape shape{parameters.number("density", 1), parameters.number("wispiness", 1),
                           parameters.number("frequency", 5)};
    constexpr std::uint32_t points = 128;
    VolumeGrid grid;
    grid.size = {points, points, points};
    const Vec3 size = box.size();
    for (std::uint32_t z = 0; z < points; ++z)
        for (std::uint32_t y = 0; y < points; ++y)
            for (std::uint32_t x = 0; x < points; ++x)
                grid.values.push_back(
                    shape.at(box.low + Vec3{(float(x) + 0.5f) / points * size.x, (float(y) + 0.5f) / points * size.y,
                                            (float(z) + 0.5f) / points * size.z}));
    medium.extinction.grid = std::make_shared<const VolumeGrid>(std::move(grid));
}

}  // namespace lightnet::pbrt
