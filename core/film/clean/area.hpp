// Cleans one area of a picture.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "core/film/clean/choice.hpp"
#include "core/film/clean/guide.hpp"
#include "core/film/clean/moved.hpp"
#include "core/film/picture.hpp"

namespace lightnet::cleaning {

/// What is cleaned.
struct Noisy {
    const Picture& picture;
    std::vector<const PictureLayer*> halves;  // of its layers, in the same order; empty: there are none
    Guide guide;
    std::uint32_t step = 0;  // pixels from a centre of regression to the next, in the whole picture
};

/// What is clean of a picture: the core of an area, as far as it is in the picture.
struct CleanArea {
    Place place;
    std::uint32_t width = 0, height = 0;
    std::vector<std::vector<Rgb>> layers;  // of the beauty, where the picture has no layers; row by row
    std::vector<SquaredError> expected;
    Moved moved;                    // where the samples are in two halves
    std::vector<float> brightness;  // of each pixel, likewise
};

struct AreaScratch;

/// Cleans areas of a picture, on any threads at once. Their scratch, some 20 MB and 2 MB for each layer, goes from one
/// area to the next, so that the system need not find memory for each.
class AreaCleaner {
public:
    explicit AreaCleaner(const Noisy& noisy);
    ~AreaCleaner();
    /// Makes the core of the area that begins `rim` to the left of and above `core`. Depends on nothing but pixels up
    /// to `rim` + `halo` around it.
    CleanArea clean(Place core);

private:
    std::unique_ptr<AreaScratch> idle_scratch();

    const Noisy& noisy_;
    std::mutex idle_mutex_;
    std::vector<std::unique_ptr<AreaScratch>> idle_;
};

}  // namespace lightnet::cleaning
