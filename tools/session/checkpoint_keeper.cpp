#include "tools/session/checkpoint_keeper.hpp"

#include <fmt/format.h>

#include <span>
#include <system_error>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/spare_threads.hpp"
#include "core/base/words_of.hpp"

namespace lightnet {

using Clock = Pace::Clock;

namespace {

double bytes_in(const FilmState& film) {
    std::size_t bytes = std::span(film.sums).size_bytes() + std::span(film.spreads).size_bytes();
    for (const auto& part : film.parts)
        for (const auto& [block, sum] : part.waiting) bytes += std::span(sum.pixels).size_bytes();
    return static_cast<double>(bytes);
}

}  // namespace

CheckpointKeeper::CheckpointKeeper(Film& film, const std::string& exr, std::map<std::string, std::string> recipe,
                                   std::chrono::seconds period)
    : film_(film), file_(checkpoint_beside(exr)), last_{std::move(recipe), {}}, pace_(period, Clock::now()) {}

bool CheckpointKeeper::take_up(const std::function<void(FilmState)>& restore) {
    const auto refuse = [&](const std::string& why) { throw UserError({file_.string(), 0}, why); };
    try {
        auto found = read_checkpoint(file_);
        if (!found) return false;
        if (const auto other = differences(found->of, last_.of); !other.empty())
            refuse("is the checkpoint of another picture (" + other + ")");
        if (const auto theirs = found->film.samples, ours = film_.format().samples; theirs > ours)
            refuse(
                fmt::format("is of {} samples per pixel, and only {} are asked for: ask for as many or more with "
                            "--samples, or leave --resume out to begin anew",
                            theirs, ours));
        restore(std::move(found->film));
    } catch (const Error& error) {
        refuse(std::string("can't be gone on from: ") + error.what());
    }
    return true;
}

bool CheckpointKeeper::recall(const std::function<void(FilmState)>& restore) {
    auto found = memo_->find(film_.format().samples);
    if (!found) return false;
    const bool as_many = found->samples == film_.format().samples;
    restore(std::move(*found));
    known_ = as_many && film_.complete();
    return true;
}

void CheckpointKeeper::recall_lights(const Graph& graph, const Registry& registry) {
    if (film_.samples_begun() == 0) lights_ = memo_->find_lights(film_.format(), graph, registry);
}

void CheckpointKeeper::remember() const {
    if (memo_ && !known_) memo_->keep(film_);
}

std::string CheckpointKeeper::save_if_due(std::uint64_t blocks) {
    const auto now = Clock::now();
    std::string complaint;
    if (!pace_.due(now)) return complaint;
    pace_.put_off(now);
    if (saved_ == blocks || lights_.are_shown()) return complaint;
    if (saving_.valid()) {
        if (saving_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return complaint;
        try {
            end_saving();
            // Saving takes at most a small part of the time.
            pace_.put_off(now, 20 * std::chrono::duration<double>(seconds_per_byte_ * bytes_in(last_.film)));
        } catch (const std::exception& error) {
            complaint = words_of(error);
        }
    }
    saved_ = blocks;
    film_.state(last_.film);
    saving_ = in_background([this] {
        const auto begun = Clock::now();
        write_checkpoint(file_, last_);
        return std::chrono::duration<double>(Clock::now() - begun).count();
    });
    return complaint;
}

void CheckpointKeeper::end_saving() {
    const double seconds = saving_.get(), bytes = bytes_in(last_.film);
    if (bytes > 0) seconds_per_byte_ = seconds / bytes;
}

bool CheckpointKeeper::save(std::uint64_t blocks, std::optional<std::chrono::duration<double>> most) {
    bool good = saved_ > 0;
    try {
        if (saving_.valid()) end_saving();
    } catch (const std::exception&) {  // now it may be written
        good = false;
    }
    if (good && saved_ == blocks && std::filesystem::exists(file_)) return true;
    film_.state(last_.film);
    const std::chrono::duration<double> expected(seconds_per_byte_ * bytes_in(last_.film));
    if (most && expected > *most && std::filesystem::exists(file_)) return false;
    write_checkpoint(file_, last_);
    return true;
}

void CheckpointKeeper::begin_anew() {
    remove();
    saving_ = {};
    saved_ = 0;
    known_ = false;
}

void CheckpointKeeper::remove() {
    if (saving_.valid()) saving_.wait();
    std::error_code ignored;
    std::filesystem::remove(file_, ignored);
}

}  // namespace lightnet
