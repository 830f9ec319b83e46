// The error of a picture by kinds of light paths: which of them make it.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "core/film/picture.hpp"
#include "core/scene/path_kinds.hpp"
#include "tools/explain/pixel_account.hpp"

namespace lightnet {

/// A value.
struct ErrorByPaths {
    double error = 0;          // relative square of the picture: the mean of variance / (light² + .01), in luminance
    LightByKind shares{};      // of it; what other nodes than those that follow or look for light make is in none
    std::uint32_t pixels = 0;  // that were looked at
};

/// Who looks. A value.
struct Lookers {
    ResultCache* cache = nullptr;  // of what nodes prepare, which each thread wants; null: none
    unsigned threads = 1;          // where the system has so many
    /// Is called often, by any of them, and may throw to end the work. None: nothing does.
    std::function<void()> pause{};
};

/// Computes some pixels of a picture again, so that the paths of each are known; more of them where it seems to be off.
/// As answers are pure functions of their questions, those are the picture's own paths. What each kind adds to the
/// difference from sample to sample is its part. What is seen of lamps themselves doesn't count.
/// `part`: of the picture's samples that are computed again, for which it takes hardly more than that part of its time;
/// of 16 pixels at least. None: the picture has no noise, or one sample of each pixel, or its nodes have to prepare for
/// each pass. The same, whatever threads there are.
std::optional<ErrorByPaths> error_by_paths(const Picture& picture, const PixelRecount::Source& source, double part,
                                           const Lookers& lookers);

}  // namespace lightnet
