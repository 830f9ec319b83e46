// The picture so far, as it is shown while a run goes on.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/request/run_request.hpp"
#include "tools/session/film_steps.hpp"
#include "tools/session/picture_files.hpp"
#include "tools/session/run_account.hpp"
#include "tools/support/pace.hpp"

namespace lightnet {

/// A picture that can't be shown is no reason to lose it: that is said, and the run goes on. One thread's.
class PictureSoFar {
public:
    /// All outlive it.
    PictureSoFar(const FilmSteps& steps, PictureFiles& files, RunAccount& account)
        : steps_(steps), files_(files), account_(account) {}

    /// From now on, writes what is there every so many seconds.
    void preview(const std::string& exr, double seconds);
    /// Writes it, if it is time to.
    void look();
    /// Writes what is there now. "": it is written; else why not.
    std::string preview_now(const std::string& exr);
    /// What was written last is a preview.
    bool is_preview() const { return is_preview_; }
    void is_whole() { is_preview_ = false; }

    /// From now on, the picture is written after each step, the first of which is coarse, and that is said.
    void show_steps(const std::string& exr, std::function<void(const PictureShown&)> shown);
    /// Of the coarse look: these layers are not in it.
    void look_without(std::vector<std::string> layers) { without_ = std::move(layers); }
    /// A step is over.
    void step();
    /// Says that the picture is written, which took `writing` seconds of the phase; none: nobody wants to know.
    void tell_shown(bool finished, double writing = 0);

private:
    struct Preview {
        std::string exr;
        Pace pace;
        bool said = false;
    };
    std::string write_preview();

    const FilmSteps& steps_;
    PictureFiles& files_;
    RunAccount& account_;
    std::optional<Preview> preview_;
    bool is_preview_ = false;
    std::string step_exr_;
    std::function<void(const PictureShown&)> shown_;  // none: steps are not written
    double step_ = 0;                                 // samples, of the last step
    std::vector<std::string> without_;                // layers that the coarse look lacks
};

}  // namespace lightnet
