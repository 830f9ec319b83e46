#include "tools/race/race_text.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace lightnet {

std::string table_of(const std::vector<Lap>& laps) {
    std::size_t widest = 4;
    for (const auto& lap : laps) widest = std::max(widest, lap.name.size());
    const bool compared = !laps.empty() && laps.front().error;
    std::string text = fmt::format("{:<{}}  {:>6}  {:>9}  {:>9}", "name", widest, "seed", "samples", "seconds");
    if (compared) text += fmt::format("  {:>10}  {:>7}  {:>8}", "relMSE", "FLIP", "bias");
    text += '\n';
    for (const auto& lap : laps) {
        text += fmt::format("{:<{}}  {:>6}  {:>9.6g}  {:>9.2f}", lap.name, widest, lap.seed, lap.samples, lap.seconds);
        if (const auto& error = lap.error)
            text += fmt::format("  {:>10.4g}  {:>7.4f}  {:>8.4f}", error->relative_square, error->flip, error->bias);
        text += '\n';
    }
    return text;
}

std::string csv_of(const std::vector<Lap>& laps) {
    std::string text{laps_beginning};
    for (const auto& lap : laps) {
        const auto name = lap.name.find_first_of(",\"\n") == lap.name.npos ? lap.name : '"' + lap.name + '"';
        for (const auto& point : lap.curve)
            text += fmt::format("{},{},{:g},{:.3f},{:.6g},{:.6g},,,\n", name, lap.seed, point.samples, point.seconds,
                                point.relative_square, point.square);
        text += fmt::format("{},{},{:g},{:.3f},", name, lap.seed, lap.samples, lap.seconds);
        if (const auto& error = lap.error)
            text += fmt::format("{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", error->relative_square, error->square,
                                error->flip, error->blocks, error->bias);
        else
            text += ",,,,\n";
    }
    return text;
}

}  // namespace lightnet
