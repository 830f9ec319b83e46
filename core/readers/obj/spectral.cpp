#include "core/readers/obj/spectral.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "core/readers/common/spectra.hpp"
#include "core/readers/files/trimmed.hpp"
#include "core/readers/obj/elsewhere.hpp"

namespace lightnet::obj {
namespace {

/// Throws Error, without the name of the file.
std::vector<SpectrumPoint> curve_in(const std::string& path, Assets& assets) {
    const auto [bytes, problem] = assets.try_read(path);
    if (!bytes) throw Error(problem);
    return read_spd(without_byte_order_mark({reinterpret_cast<const char*>(bytes->data()), bytes->size()}));
}

}  // namespace

std::optional<Rgb> spectral_colour(Lines& line, bool shines, Assets& assets) {
    const SourceLine where = line.where();
    const std::string name(line.word());
    const bool has_factor = !line.left().empty();
    const auto factor = has_factor ? line.number(assets.report()) : std::nullopt;
    const auto left_out = [&](const std::string& why) {
        assets.report().warn(where, fmt::format("a colour by 'spectral' is left out: {}: the picture is as without "
                                                "this line",
                                                why));
        return std::nullopt;
    };
    if (name.empty() || name.front() == '#') return left_out("it names no file");
    const auto path = find_curve(where.file, name, where, assets);
    if (!path) return left_out(fmt::format("there is no file '{}'", name));
    try {
        const auto curve = curve_in(*path, assets);
        if (shines && beyond_srgb(curve))
            assets.report().warn(where, "light by 'spectral' is of a colour that sRGB can't show, and is cut");
        return (shines ? mean_light_of_lines(curve).rgb : surface_colour(curve).rgb) * factor.value_or(1);
    } catch (const MissingHere&) {
        throw;
    } catch (const Error& problem) {
        return left_out(fmt::format("'{}': {}", *path, problem.what()));
    }
}

}  // namespace lightnet::obj
