#include "core/readers/common/measurements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/readers/common/spectra.hpp"
#include "core/readers/common/tensor_file.hpp"
#include "core/readers/files/files.hpp"

namespace lightnet {
namespace {

[[noreturn]] void not_measured(const std::string& what) { throw Error("measured material: " + what); }

std::vector<float> ascending(const TensorFile& file, const char* name) {
    auto numbers = file.floats(name, 1);
    if (std::ranges::adjacent_find(numbers, std::greater_equal{}) != numbers.end())
        not_measured(fmt::format("the numbers of '{}' do not ascend", name));
    return numbers;
}

/// The grid of which a field holds `tables`; its last two dimensions.
GridSize grid_of(const TensorFile& file, const char* name, std::vector<std::size_t> tables) {
    const auto& shape = file.field(name, tables.size() + 2).shape;
    if (!std::equal(tables.begin(), tables.end(), shape.begin()))
        not_measured(fmt::format("'{}' has not as many tables as there are directions or wavelengths", name));
    const std::size_t high = shape[tables.size()], wide = shape[tables.size() + 1];
    if (wide < 2 || high < 2 || wide > (1u << 16) || high > (1u << 16))
        not_measured(fmt::format("'{}' has a grid of {} by {}", name, wide, high));
    return {static_cast<std::uint32_t>(wide), static_cast<std::uint32_t>(high)};
}

std::vector<float> not_below_zero(std::vector<float> numbers) {
    for (float& x : numbers) x = std::max(x, 0.0f);
    return numbers;
}

/// What each wavelength adds to a colour: that of a spectrum which is 1 there, and 0 at all others.
std::vector<Rgb> colours_of(const std::vector<float>& wavelengths) {
    std::vector<SpectrumPoint> spectrum;
    for (const float w : wavelengths) spectrum.push_back({w, 0});
    std::vector<Rgb> colours;
    for (auto& point : spectrum) {
        point.value = 1;
        colours.push_back(surface_colour(spectrum).rgb);
        point.value = 0;
    }
    return colours;
}

/// Tables of `channels`, one behind the other, made into tables of colours.
std::vector<Rgb> joined_channels(const std::vector<float>& numbers, const std::vector<Rgb>& channels,
                                 std::size_t nodes) {
    const std::size_t tables = numbers.size() / nodes / channels.size();
    std::vector<Rgb> colours(tables * nodes);
    for (std::size_t table = 0; table < tables; ++table)
        for (std::size_t c = 0; c < channels.size(); ++c) {
            const float* from = &numbers[(table * channels.size() + c) * nodes];
            Rgb* to = &colours[table * nodes];
            for (std::size_t i = 0; i < nodes; ++i) to[i] += channels[c] * from[i];
        }
    return colours;
}

void read_colours(const TensorFile& file, Measurement::Numbers& numbers) {
    const bool in_rgb = !file.has("spectra") && file.has("rgb");
    const char* name = in_rgb ? "rgb" : "spectra";
    const std::vector<Rgb> channels =
        in_rgb ? std::vector<Rgb>{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}} : colours_of(ascending(file, "wavelengths"));
    const GridSize grid = grid_of(file, name, {numbers.azimuths.size(), numbers.angles.size(), channels.size()});
    if (grid.wide != numbers.light_grid.wide || grid.high != numbers.light_grid.high)
        not_measured(fmt::format("'{}' and 'luminance' have different grids", name));
    numbers.colours = joined_channels(file.floats(name, 5), channels, grid.nodes());
    if (!std::ranges::all_of(numbers.colours, [](const Rgb& c) { return finite(c); }))
        not_measured(fmt::format("a colour of '{}' is not finite", name));
}

/// How often the azimuths that were measured go around.
std::uint32_t folds_of(const std::vector<float>& azimuths) {
    if (azimuths.size() <= 2) return 1;
    const double folds = std::rint(2 * std::numbers::pi / (double{azimuths.back()} - double{azimuths.front()}));
    if (folds == 1 || folds == 2 || folds == 4) return static_cast<std::uint32_t>(folds);
    not_measured("the azimuths of 'phi_i' are neither all around, nor a half or a quarter of that");
}

}  // namespace

std::shared_ptr<const Measurement> read_measurement(std::span<const std::byte> bytes) {
    const TensorFile file(bytes);
    Measurement::Numbers numbers;
    numbers.azimuths = ascending(file, "phi_i"), numbers.angles = ascending(file, "theta_i");
    numbers.folds = folds_of(numbers.azimuths);
    const std::vector<std::size_t> directions{numbers.azimuths.size(), numbers.angles.size()};
    numbers.facet_grid = grid_of(file, "ndf", {}), numbers.facets = not_below_zero(file.floats("ndf", 2));
    numbers.area_grid = grid_of(file, "sigma", {}), numbers.areas = not_below_zero(file.floats("sigma", 2));
    numbers.seen_grid = grid_of(file, "vndf", directions), numbers.seen = not_below_zero(file.floats("vndf", 4));
    numbers.light_grid = grid_of(file, "luminance", directions);
    numbers.light = not_below_zero(file.floats("luminance", 4));
    read_colours(file, numbers);
    const auto& jacobian = file.field("jacobian", 1);
    if (jacobian.type != TensorFile::Type::uint8) not_measured("'jacobian' is not one byte");
    numbers.times_facets = jacobian.bytes[0] != std::byte{0};
    return std::make_shared<const Measurement>(std::move(numbers));
}

std::shared_ptr<const Measurement> Measurements::get(const std::string& path, const SourceLine& where,
                                                     const std::function<Bytes()>& read) {
    const auto [entry, fresh] = known_.try_emplace(path);
    if (fresh) try {
            entry->second.measured = read_measurement(*read());
        } catch (const MissingHere&) {
            throw;
        } catch (const Error& problem) {
            entry->second.problem = problem.what();
        }
    if (!entry->second.measured)
        report_.warn(where,
                     fmt::format("measured material '{}': {}: grey is taken instead", path, entry->second.problem));
    return entry->second.measured;
}

}  // namespace lightnet
