#include "tools/run_book.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>

#include "core/error.hpp"
#include "core/film/checkpoint.hpp"
#include "core/film/exr.hpp"
#include "core/film/png.hpp"

namespace lightnet {
namespace {

using Clock = std::chrono::steady_clock;

std::filesystem::path next_to(const std::string& exr, const std::string& name) {
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
    const auto now = Clock::now();
    progress_.update(tiles_, now);
    if (keeping_ && now >= keeping_->next) save_in_background(now);
}

void RunBook::keep_checkpoint(const std::string& exr, std::map<std::string, std::string> recipe,
                              std::chrono::seconds period) {
    keeping_ = Keeping{checkpoint_beside(exr), std::move(recipe), period, Clock::now() + period, {}, 0};
}

void RunBook::take_up_checkpoint() {
    const auto& file = keeping_->file;
    auto found = read_checkpoint(file);
    if (!found) return say("there is no " + file.string() + "; beginning at the beginning");
    if (const auto other = differences(found->of, keeping_->recipe); !other.empty())
        throw UserError({file.string(), 0}, "is the checkpoint of another picture (" + other + ")");
    film_.restore(std::move(found->film));
    say(fmt::format("going on from {}", file.string()));
}

void RunBook::found(std::uint64_t tiles) {
    tiles_ = keeping_->saved = tiles;
    if (tiles) progress_.found_done(tiles, Clock::now());
}

void RunBook::save_in_background(Clock::time_point now) {
    keeping_->next = now + keeping_->period;
    if (keeping_->saved == tiles_) return;
    if (keeping_->saving.valid()) {
        if (keeping_->saving.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
        try {
            // Saving takes at most a small part of the time.
            const auto pause = std::chrono::duration<double>(20 * keeping_->saving.get());
            keeping_->next =
                now + std::max<Clock::duration>(keeping_->period, std::chrono::ceil<Clock::duration>(pause));
        } catch (const std::exception& error) {
            warn(std::string("no checkpoint: ") + error.what());
        }
    }
    keeping_->saved = tiles_;
    keeping_->saving = std::async(std::launch::async,
                                  [file = keeping_->file, checkpoint = Checkpoint{keeping_->recipe, film_.state()}] {
                                      const auto begun = Clock::now();
                                      write_checkpoint(file, checkpoint);
                                      return std::chrono::duration<double>(Clock::now() - begun).count();
                                  });
}

bool RunBook::save_checkpoint() {
    if (!keeping_ || tiles_ == 0) return false;
    if (keeping_->saving.valid()) keeping_->saving.wait();
    if (keeping_->saved != tiles_ || !std::filesystem::exists(keeping_->file))
        write_checkpoint(keeping_->file, {keeping_->recipe, film_.state()});
    return true;
}

void RunBook::remove_checkpoint() {
    if (!keeping_) return;
    if (keeping_->saving.valid()) keeping_->saving.wait();
    std::error_code ignored;
    std::filesystem::remove(keeping_->file, ignored);
    keeping_.reset();
}

void RunBook::use(const HostState& host) {
    const auto& machine = host.machine;
    report_.hosts.push_back({host.name, host.state, machine.name, machine.cpu, machine.isa, machine.version,
                             machine.cores, machine.memory, host.places});
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
    lightnet::write_report(next_to(exr, "run.json"), report_);
}

}  // namespace lightnet
