// Keeps the books of a run: the film, its checkpoint, its files, and the account that is given of it.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/film/film.hpp"
#include "core/network/graph/hosts.hpp"
#include "tools/pictures/error_curve.hpp"
#include "tools/session/checkpoint_keeper.hpp"
#include "tools/session/film_steps.hpp"
#include "tools/session/picture_files.hpp"
#include "tools/session/picture_so_far.hpp"
#include "tools/session/run_account.hpp"

namespace lightnet {

/// One thread's. Tiles come in, files go out.
class RunRecorder {
public:
    /// `tile`: pixels along a side.
    RunRecorder(FilmFormat format, ProgressMode progress, std::uint32_t tile, RunReport report,
                std::optional<Progress::Series> series = {});
    RunRecorder(const RunRecorder&) = delete;
    RunRecorder& operator=(const RunRecorder&) = delete;

    RunAccount& account() { return account_; }
    PictureFiles& files() { return files_; }
    PictureSoFar& so_far() { return so_far_; }
    const FilmSteps& steps() const { return steps_; }

    /// What the scene's film makes of radiance. Before the first tile.
    void expose(float scale);
    /// The run is to end so many seconds after it began; 0: when it is done.
    void limit_time(double seconds);
    /// Says at the end how far the picture is from a reference.
    void compare_with(ErrorCurve curve);
    /// From now on, a step for each group of blocks, each of which is shown.
    void show_steps(const std::string& exr, std::function<void(const PictureShown&)> shown);
    /// Shows those who watch what is new, to be called several times a second.
    void show(const Watcher::Hosts& hosts);

    /// The tiles to be rendered next, when those before are there. None: there is no more to do, or no time.
    std::vector<Tile> next_step();
    /// Pixels of a tile. Returns the tiles that are wanted now, beside those that are wanted anyhow.
    std::vector<Tile> take(const Tile& tile, std::span<const Rgb> pixels);
    /// Of all samples, 0 to 1.
    double share_done() const {
        return all_blocks_ ? static_cast<double>(blocks_) / static_cast<double>(all_blocks_) : 0;
    }
    /// Nothing more is rendered: what is there is the picture. In words: "37 samples per pixel of 64, on average"; "":
    /// nothing is there.
    std::string end_early();
    /// All that is there is in doubt: the film is empty again, and so is the checkpoint beside it.
    void begin_anew();

    /// From now on the film is saved beside `exr` from time to time, in the background. `recipe` is what the picture
    /// depends on; `memo`: where it is kept when it is finished, null: nowhere.
    void keep_checkpoint(const std::string& exr, std::map<std::string, std::string> recipe, std::chrono::seconds period,
                         std::unique_ptr<FilmMemo> memo = nullptr);
    /// Takes up what an earlier run left there, if anything and if that is wanted; else what the memo has. Throws
    /// UserError when what was left there was another picture's. Returns the graph of which tiles are wanted: that one,
    /// or what the memo leaves of it.
    Graph take_up_checkpoint(bool resume, const Graph& graph, const Registry& registry);
    /// There is something worth to be kept.
    bool keeps_checkpoint() { return checkpoint_ && blocks_ > 0 && !checkpoint_->lights().are_shown(); }
    /// Saves what is there now; false: nothing was worth it. Where that would take longer than `most`, what was saved
    /// last stays, which is said.
    bool save_checkpoint(std::optional<std::chrono::duration<double>> most = {});
    /// Of a picture that is finished: the checkpoint stays, so that a later run may add samples, or is removed. A disk
    /// that refuses it only costs a warning.
    void end_checkpoint(bool stays);

    /// Writes x.exr, and what belongs beside it, each whole or not at all. Throws Error, also when files of others are
    /// there.
    void write_picture(const std::string& exr);
    /// Writes the report beside `exr`: x.run.json; or x.run.failed.json, where that is the picture of an earlier run.
    /// `trace`: where, with it, goes what all places were busy with; "": nowhere.
    void write_report(const std::string& exr, const std::string& outcome, const std::string& trace = {});

private:
    std::filesystem::path report_file(const std::string& exr, const std::string& outcome) const;
    void note_error(Pace::Clock::time_point now);
    std::uint64_t work_shown() const;

    FilmSteps steps_;
    std::uint64_t all_blocks_;  // of tiles
    RunAccount account_;
    PictureFiles files_{steps_, account_};
    PictureSoFar so_far_{steps_, files_, account_};
    std::optional<ErrorCurve> curve_;
    std::optional<CheckpointKeeper> checkpoint_;
    std::uint64_t blocks_ = 0, repeated_ = 0;
};

}  // namespace lightnet
