// The fold by which samples of a pixel become one: colours are added, ids are merged.
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "core/base/math/rgb.hpp"

namespace lightnet {

/// Ids that are seen in a pixel: for each a colour that holds the id, for how many samples it was seen, and 0. The
/// most frequent one first, and of equal ones that of the smaller bits; what is left is black.
inline Rgb seen_id(float id, float samples = 1) { return {id, samples, 0}; }

/// Adds other ids to such a list. It keeps its length: what was seen least goes where there are more. Samples are
/// counted exactly as long as they are fewer than 2^24.
void add_ids(std::span<Rgb> ids, std::span<const Rgb> more);

/// Such a list to look at: each id has a colour of its own, the part of `samples` that sees none is black. Linear.
Rgb false_colour(std::span<const Rgb> ids, float samples);

/// Which colours of a pixel are ids.
struct IdColours {
    std::size_t first = 0, count = 0;
};

/// Adds colours of pixels to colours of pixels, and ids to ids. Whatever is added up in a fixed order has so the same
/// bits each time. A value.
class Addition {
public:
    /// No ids.
    Addition() = default;
    /// `colours`: of a pixel.
    Addition(std::size_t colours, std::vector<IdColours> ids) : colours_(colours), ids_(std::move(ids)) {}

    /// Both are of the same pixels.
    void operator()(std::span<Rgb> sums, std::span<const Rgb> more) const;

private:
    std::size_t colours_ = 0;
    std::vector<IdColours> ids_;
};

/// Lists of ids are at most this long.
inline constexpr std::size_t most_ids = 32;

}  // namespace lightnet
