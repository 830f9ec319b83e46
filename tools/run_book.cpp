#include "tools/run_book.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>

#include "core/film/exr.hpp"
#include "core/film/png.hpp"

namespace lightnet {
namespace {

using Clock = std::chrono::steady_clock;

std::filesystem::path beside(const std::string& exr, const std::string& name) {
    return std::filesystem::path(exr).replace_filename(name);
}

}  // namespace

RunBook::RunBook(FilmFormat format, ProgressMode progress, std::uint64_t tiles, RunReport report)
    : film_(std::move(format)),
      report_(std::move(report)),
      progress_(tiles, Progress::style_of_stderr(progress), std::cerr, Clock::now()) {}

void RunBook::end_phase(Clock::time_point now) {
    if (phase_begun_) report_.phases.back().seconds = std::chrono::duration<double>(now - *phase_begun_).count();
    phase_begun_.reset();
}

void RunBook::phase(const std::string& name) {
    const auto now = Clock::now();
    end_phase(now);
    report_.phases.push_back({name, 0});
    phase_begun_ = now;
    progress_.phase(name, now);
}

void RunBook::warn(const std::string& text) {
    report_.warnings.push_back(text);
    progress_.say("warning: " + text);
}

void RunBook::take(const Tile& tile, std::span<const Rgb> pixels) {
    film_.add(tile, pixels) ? ++tiles_ : ++repeated_;
    progress_.update(tiles_, Clock::now());
}

void RunBook::use(const Plan& plan, const Graph& graph) {
    report_.places.clear();
    for (std::uint32_t place = 0; place < plan.places.size(); ++place) {
        PlaceReport entry{plan.places[place].host, plan.places[place].index, {}};
        for (std::size_t node = 0; node < plan.places_of.size(); ++node)
            if (std::count(plan.places_of[node].begin(), plan.places_of[node].end(), place))
                entry.nodes.push_back(graph.nodes[node].name);
        report_.places.push_back(std::move(entry));
    }
}

void RunBook::write_picture(const std::string& exr, float scale) {
    const auto picture = film_.picture(scale);
    for (std::size_t layer = 0; layer < film_.lost().size(); ++layer)
        if (const auto lost = film_.lost()[layer])
            warn(fmt::format("{} colours of layer '{}' were not finite and count as black", lost,
                             film_.format().layers[layer]));
    const auto png = std::filesystem::path(exr).replace_extension(".png");
    write_exr(exr, picture);
    write_png(png, picture);
    report_.outputs = {exr, png.string()};
    report_.settings["tone of the PNG"] = std::string(png_tone);
}

void RunBook::write_report(const std::string& exr, const std::string& outcome) {
    const auto now = Clock::now();
    end_phase(now);
    progress_.finish(now);
    report_.outcome = outcome;
    report_.counters = counters_.named();
    report_.counters["repeated_tiles"] = repeated_;
    lightnet::write_report(beside(exr, "run.json"), report_);
}

}  // namespace lightnet
