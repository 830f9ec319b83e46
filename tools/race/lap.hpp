// One run among several that are held against each other: how long it took, and how far its picture is from a
// reference.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/base/temporary_folder.hpp"
#include "core/film/picture.hpp"
#include "tools/request/run_request.hpp"

namespace lightnet {

/// How far the picture of a run was at one time.
struct LapPoint {
    double samples = 0, seconds = 0, relative_square = 0, square = 0;
};

/// How far its last picture is from the reference, as `lightnet compare` has it.
struct LapError {
    double relative_square = 0, square = 0, blocks = 0, flip = 0;
    double bias = 0;  // how far from 1 the ratio of the means is, in the worst channel
};

/// What became of a run. A value.
struct Lap {
    std::string name;  // of what runs
    std::uint64_t seed = 0;
    double samples = 0;  // per pixel, on average
    double seconds = 0;  // for preparing and rendering
    std::vector<LapPoint> curve{};
    std::optional<LapError> error{};  // none: there is no reference
    std::string png{}, flip_png{};    // bytes of the picture, and of its FLIP; "": not wanted
};

/// What is to be run, and what it is called.
struct Contestant {
    std::string name;
    RunRequest request;
};

/// Runs things one after the other, in a folder of its own that is gone afterwards.
class Track {
public:
    /// `run` renders, and returns an exit code. `reference`: file; "": none. Throws UserError where it can't be read.
    Track(std::function<int(const RunRequest&)> run, const std::string& reference);
    Track(const Track&) = delete;
    Track& operator=(const Track&) = delete;

    /// `pictures`: keeps them. Throws Error where the run fails, and Interrupted where it is told to end.
    Lap lap(const Contestant& contestant, std::uint64_t seed, bool pictures);
    /// As a PNG shows it; "": there is none.
    std::string reference_png() const;

    /// The user has told a run to end.
    struct Interrupted {};

private:
    void measure(Lap& lap, const Picture& picture, bool pictures) const;

    std::function<int(const RunRequest&)> run_;
    std::string reference_;
    TemporaryFolder folder_{"race"};
    std::optional<Picture> truth_;
};

/// The middle one of those of all seeds; of an even number the mean of the two in the middle.
double median(std::vector<double> values);

}  // namespace lightnet
