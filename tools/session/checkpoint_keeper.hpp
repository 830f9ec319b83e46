// Keeps the film of a run on disk, so that a later run can go on from it.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "core/film/checkpoint.hpp"
#include "core/film/film.hpp"
#include "tools/session/film_memo.hpp"
#include "tools/session/known_lights.hpp"
#include "tools/support/pace.hpp"

namespace lightnet {

/// One thread's. `blocks`: how many the film has now.
class CheckpointKeeper {
public:
    /// The file lies beside `exr`. `recipe` is what the picture depends on. The film outlives its keeper.
    CheckpointKeeper(Film& film, const std::string& exr, std::map<std::string, std::string> recipe,
                     std::chrono::seconds period);

    const std::filesystem::path& file() const { return file_; }
    /// Hands on what an earlier run left there; false: nothing. Throws UserError when that was another picture's, or
    /// doesn't fit.
    bool take_up(const std::function<void(FilmState)>& restore);
    /// Finished pictures are looked for there, and kept.
    void remember_in(std::unique_ptr<FilmMemo> memo) { memo_ = std::move(memo); }
    bool remembers() const { return memo_ != nullptr; }
    /// Hands on the film of an earlier run, wherever that picture went; false: there is none that fits.
    bool recall(const std::function<void(FilmState)>& restore);
    /// Looks for lights of the graph, where nothing else is there.
    void recall_lights(const Graph& graph, const Registry& registry);
    /// Those that were found. Nothing is saved while the film shows something of them.
    KnownLights& lights() { return lights_; }
    /// Keeps the film, which is finished, unless all of it was recalled.
    void remember() const;
    /// So many blocks are in the file already.
    void found(std::uint64_t blocks) { saved_ = blocks; }
    /// Saves in the background, when that is due. What was wrong with the last time; "": nothing.
    std::string save_if_due(std::uint64_t blocks);
    /// Saves now, unless that has been done. False: that would take longer than `most`, so that what was saved last is
    /// left as it is. Throws Error.
    bool save(std::uint64_t blocks, std::optional<std::chrono::duration<double>> most = {});
    /// Waits for what is being saved, and removes the file.
    void remove();
    /// Waits for what is being saved, and removes the file; the film, empty again, is saved from now on.
    void begin_anew();

private:
    void end_saving();

    Film& film_;
    std::filesystem::path file_;
    std::unique_ptr<FilmMemo> memo_;  // null: nothing is remembered
    bool known_ = false;              // it has all of the film
    KnownLights lights_;              // that were recalled
    Checkpoint last_;                 // being saved, or what was; its room is used again
    Pace pace_;
    std::future<double> saving_;   // seconds that it took
    double seconds_per_byte_ = 0;  // the last time; 0: not known
    std::uint64_t saved_ = 0;      // blocks
};

}  // namespace lightnet
