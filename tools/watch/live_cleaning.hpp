// The picture so far without its noise, for those who watch a run.
#pragma once

#include <chrono>
#include <cstddef>
#include <future>
#include <optional>
#include <vector>

#include "core/film/clean/clean.hpp"
#include "core/film/film.hpp"
#include "tools/support/pace.hpp"

namespace lightnet {

/// Cleans what is there of a film beside the run, as soon as all of its pixels have samples, and then again and again
/// in a tenth of the time, as a draft. For the run's thread; cleaning has threads of its own. A film without halves has
/// nothing of this.
class LiveCleaning {
public:
    explicit LiveCleaning(const FilmFormat& format);

    /// How many colours a pixel has beside FilmFormat::views(): its layers, cleaned.
    std::size_t colours() const { return colours_; }
    /// Begins to clean, if it's time. True: since the last look something was cleaned, so that all pixels are others.
    bool look(const Film& film);
    /// Cleans a film as the last thing, as `lightnet clean` does. False: there is nothing to be cleaned.
    bool finish(const Film& film);
    /// Film::so_far() of an area, and behind each pixel's colours those of its layers, cleaned; as they are, where
    /// nothing is cleaned yet.
    std::vector<Rgb> so_far(const Film& film, const Tile& area) const;

private:
    using Clock = std::chrono::steady_clock;
    struct Cleaned {
        std::optional<Picture> picture;  // none: there was no memory for it
        std::chrono::duration<double> took{};
    };
    static Cleaned cleaned(Picture noisy, CleanQuality quality);
    void begin(const Film& film);

    std::size_t colours_;
    Pace pace_;
    std::optional<Picture> cleaned_;
    std::future<Cleaned> at_work_;
    bool outdated_ = false;  // what is at work is: the film was begun anew
};

}  // namespace lightnet
