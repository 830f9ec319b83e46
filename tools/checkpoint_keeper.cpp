#include "tools/checkpoint_keeper.hpp"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/spare_threads.hpp"

namespace lightnet {

using Clock = Pace::Clock;

CheckpointKeeper::CheckpointKeeper(Film& film, const std::string& exr, std::map<std::string, std::string> recipe,
                                   std::chrono::seconds period)
    : film_(film), file_(checkpoint_beside(exr)), last_{std::move(recipe), {}}, pace_(period, Clock::now()) {}

bool CheckpointKeeper::take_up() {
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
        film_.restore(std::move(found->film));
    } catch (const Error& error) {
        refuse(std::string("can't be gone on from: ") + error.what());
    }
    return true;
}

std::string CheckpointKeeper::save_if_due(std::uint64_t blocks) {
    const auto now = Clock::now();
    std::string complaint;
    if (!pace_.due(now)) return complaint;
    pace_.put_off(now);
    if (saved_ == blocks) return complaint;
    if (saving_.valid()) {
        if (saving_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return complaint;
        try {
            // Saving takes at most a small part of the time.
            pace_.put_off(now, 20 * std::chrono::duration<double>(saving_.get()));
        } catch (const std::exception& error) {
            complaint = error.what();
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

void CheckpointKeeper::save(std::uint64_t blocks) {
    if (saving_.valid()) saving_.wait();
    if (saved_ == blocks && std::filesystem::exists(file_)) return;
    film_.state(last_.film);
    write_checkpoint(file_, last_);
}

void CheckpointKeeper::begin_anew() {
    remove();
    saving_ = {};
    saved_ = 0;
}

void CheckpointKeeper::remove() {
    if (saving_.valid()) saving_.wait();
    std::error_code ignored;
    std::filesystem::remove(file_, ignored);
}

}  // namespace lightnet
