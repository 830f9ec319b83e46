// The account of a pixel: its samples, computed again alone.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/film/film.hpp"
#include "core/film/picture.hpp"
#include "core/network/graph/kind.hpp"
#include "core/run/assembly/account.hpp"
#include "core/run/assembly/assembly.hpp"
#include "core/run/assembly/prepared.hpp"
#include "tools/explain/past_run.hpp"

namespace lightnet {

struct ExplainedSample {
    std::uint32_t sample = 0;
    std::vector<Rgb> colours;  // exposed, without gains: per layer, then per picture that is shown beside them
    Rgb beauty;                // sum of the layers, with their gains
    Account account;
};

/// A value, but for the network, which is constant.
struct PixelAccount {
    std::shared_ptr<const Network> network;
    FilmFormat format;
    std::uint32_t x = 0, y = 0, samples = 0;
    Picture pixel;                       // of one pixel: all its samples, added up as its film did
    std::optional<bool> equal;           // to that of the picture, in all bits of all layers; none: not compared
    std::vector<ExplainedSample> parts;  // the brightest first
};

/// A network whose pixels are computed again, one after the other. One thread's.
class PixelRecount {
public:
    struct Source {
        std::shared_ptr<const Network> network;
        FilmFormat format;
        MadeFrom made_from;
        float scale = 1;  // what the film makes of radiance
    };
    /// Has nodes prepare, which takes as long as in a run, where the results are not in `cache` (null: nowhere).
    /// `pause` is called often, and may throw to end the work.
    PixelRecount(Source source, std::unique_ptr<ResultCache> cache, std::function<void()> pause = {});
    ~PixelRecount();
    PixelRecount(const PixelRecount&) = delete;
    PixelRecount& operator=(const PixelRecount&) = delete;

    /// Of the first so many samples of a pixel.
    PixelAccount account(std::uint32_t x, std::uint32_t y, std::uint32_t samples);

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

/// Computes the samples of pixel (x, y) of `picture` again, on the calling thread. Throws UserError when the picture
/// has no such pixel, or is none of this run, Error when its scene can't be read any more.
PixelAccount account_for(const Picture& picture, const PastRun& past, std::uint32_t x, std::uint32_t y,
                         const Registry& registry);

}  // namespace lightnet
