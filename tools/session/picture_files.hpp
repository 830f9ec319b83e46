// The picture of a run as files.
#pragma once

#include <chrono>
#include <functional>
#include <future>
#include <set>
#include <string>
#include <utility>

#include "core/base/spare_threads.hpp"
#include "core/film/picture.hpp"
#include "core/film/tone.hpp"
#include "tools/pictures/picture_notes.hpp"
#include "tools/request/run_request.hpp"
#include "tools/session/film_steps.hpp"
#include "tools/session/run_account.hpp"

namespace lightnet {

/// How the PNG is to show the picture, and how it does.
struct ShownInPng {
    PngRequest request = PictureView::plain;
    bool exposed = false;     // it has an exposure which somebody has chosen
    Brightness brightness{};  // of the picture that was written last
    double stops = 0;         // by which the PNG is brighter than that
};

/// Each file is written whole or not at all, and none of others is replaced. One thread's.
class PictureFiles {
public:
    /// Both outlive it.
    PictureFiles(const FilmSteps& steps, RunAccount& account) : steps_(steps), account_(account) {}

    /// What the files say of the picture beside its pixels.
    void describe(PictureWords words) { words_ = std::move(words); }
    /// What the scene's film makes of radiance.
    void expose(float scale) { scale_ = scale; }
    float scale() const { return scale_; }
    void show_png(const ShownInPng& png) { png_ = png; }
    /// Where the picture goes as arrays of NumPy; "": nowhere.
    void keep_arrays(const std::string& npz) { arrays_ = npz; }
    /// While something takes long (a large file, a picture to be cleaned), calls `attend` all the time: hosts that hear
    /// nothing for seconds take the run for gone. Null: there are none. It must not throw.
    void attend_by(std::function<void()> attend) { attend_ = std::move(attend); }
    /// Does `work` elsewhere, if there is somebody to be attended to.
    template <class Work>
    auto apart(const Work& work) const;

    /// As it would be written.
    Picture now() const;
    /// x.exr, x.png beside it, and the arrays. `quickly`: for whoever waits for it, and looks at it at once. Throws
    /// Error, also when files of others are there.
    void write(const std::string& exr, bool quickly = false);
    /// x.clean.exr and its PNG, beside the noisy picture, which stays. Throws Error.
    void write_clean(const std::string& exr);
    /// This run has written it.
    bool wrote(const std::string& exr) const { return written_.contains(exr); }
    /// Is the file there, and what write() would write?
    bool is_there(const std::string& exr) const;

    const ShownInPng& png() const { return png_; }

private:
    const FilmSteps& steps_;
    RunAccount& account_;
    PictureWords words_;
    float scale_ = 1;
    ShownInPng png_;
    std::string arrays_;
    std::function<void()> attend_;
    std::set<std::string> written_;  // pictures
    bool said_overflow_ = false;
};

template <class Work>
auto PictureFiles::apart(const Work& work) const {
    constexpr std::chrono::milliseconds often(20);
    if (!attend_) return work();
    auto done = in_background(work);
    while (done.wait_for(often) != std::future_status::ready) attend_();
    return done.get();
}

}  // namespace lightnet
