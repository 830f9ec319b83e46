#include "tools/session/firefly_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/film/fireflies.hpp"
#include "core/scene/path_kinds.hpp"

namespace lightnet {
namespace {

constexpr double most_of_it = 0.6;  // of the error: who makes so much of it is named
constexpr double nearly_all = 0.8;  // so much of it must get better, as the rest may get worse: see noise-by-paths
constexpr const char* photon_graph = "graphs/progressive.lua";
constexpr double least_seen = 0.0025;  // relative square: below, nobody sees it

// What is seen of lamps is as bright as they are, and no noise.
std::vector<const PictureLayer*> layers_of_surfaces(const Picture& picture) {
    std::vector<const PictureLayer*> layers;
    for (const auto& layer : picture.layers)
        if (!layer.name.starts_with("emission")) layers.push_back(&layer);
    return layers;
}

/// Which light paths make most of the error, and what covers them better.
struct Culprit {
    std::string words;         // "paths LS+D make 97 % of it"; "": nobody is known to
    std::string better;        // graph; "": none is known
    bool is_doubtful = false;  // there is one that may be better
};

bool is_any(const RunReport& report, std::string_view kind) {
    return std::any_of(report.nodes.begin(), report.nodes.end(),
                       [&](const NodeReport& node) { return node.kind.find(kind) != std::string::npos; });
}

Culprit culprit_of(const RunReport& report, std::string_view what) {
    if (!report.noise) return {};
    const auto part = [&](PathKind kind) {
        for (const auto& [word, share] : report.noise->paths)
            if (word == word_of(kind)) return share;
        return 0.0;
    };
    // DECISIONS: noise-by-paths
    // By way of glass or mirrors light is found by chance, and what it lights, seen through them, likewise.
    const double caustic = part(PathKind::caustic), mirrored = part(PathKind::mirrored);
    if (caustic + mirrored >= most_of_it) {
        const auto words = caustic < 0.1 * mirrored ? std::string(word_of(PathKind::mirrored))
                           : mirrored < 0.1 * caustic
                               ? std::string(word_of(PathKind::caustic))
                               : fmt::format("{} and {}", word_of(PathKind::caustic), word_of(PathKind::mirrored));
        return {fmt::format("paths {} make {:.0f} % of {}", words, 100 * std::min(1.0, caustic + mirrored), what),
                is_any(report, "Photon") || caustic + mirrored < nearly_all ? "" : photon_graph,
                !is_any(report, "Photon")};
    }
    for (const auto& [word, share] : report.noise->paths)
        if (share >= most_of_it)
            return {fmt::format("paths {} make {:.0f} % of {}", word, 100 * std::min(1.0, share), what), ""};
    return {};
}

}  // namespace

std::string firefly_words(const Picture& picture, const RunReport& report, const std::string& exr) {
    const auto found = fireflies_in(picture, layers_of_surfaces(picture));
    const Culprit of_noise = culprit_of(report, "the error");
    if (!found || found->brightest.empty()) {
        if (of_noise.better.empty() || report.noise->error < least_seen) return {};
        return fmt::format("noise: {} (relative square {:.2g}): {} covers these better", of_noise.words,
                           report.noise->error, of_noise.better);
    }
    const auto [x, y] = found->brightest.front();
    std::string words = fmt::format("fireflies: {} {} {:.0f} % of the noise", found->pixels,
                                    found->pixels == 1 ? "pixel holds" : "pixels hold", 100 * found->share);
    if (!of_noise.words.empty())
        words += "; " + culprit_of(report, "it").words +
                 (!of_noise.better.empty() ? ": " + of_noise.better + " covers these better"
                  : of_noise.is_doubtful   ? ""
                                           : ": no graph is known that covers these better");
    words += fmt::format("; lightnet explain {} {},{} tells by which light paths", exr, x, y);
    if (of_noise.words.empty() && is_any(report, "PathTracing") && !is_any(report, "Photon"))
        words += "; where they come by way of glass or mirrors (LS+D), a photon map finds them: " +
                 std::string(photon_graph);
    return words;
}

}  // namespace lightnet
