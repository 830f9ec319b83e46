#include "tools/explain/error_by_paths.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <future>
#include <numeric>
#include <string>
#include <vector>

#include "core/base/spare_threads.hpp"
#include "core/film/fireflies.hpp"
#include "core/run/serial/serial.hpp"

namespace lightnet {
namespace {

constexpr std::uint32_t most_units = 8;        // into which a pixel's samples are parted, to see how they differ
constexpr std::uint32_t most_of_pixel = 4096;  // samples: the first ones
constexpr double least_looks = 16;             // pixels

/// What some samples of a pixel have brought, on average: of each kind, of other nodes, and all together.
struct Unit {
    LightByKind kinds{};
    double all = 0;
};

/// Samples of single pixels, taken apart.
class Prism {
public:
    Prism(const PixelRecount::Source& source, const Lookers& lookers)
        : source_(source), run_(*source.network, lookers.pause) {
        run_.prepare(source.made_from, lookers.cache);
        for (const auto& layer : source.format.layers) layers_.push_back(layer_of(layer));
    }

    /// Of so many samples from the first one on.
    Unit unit(std::uint32_t x, std::uint32_t y, std::uint32_t first, std::uint32_t samples) {
        Unit unit;
        for (const std::uint32_t end = first + samples; first < end;) {
            const Tile tile{x, y, 1, 1, first, std::min(samples_per_block, end - first)};
            watch_.take();
            const auto colours = run_.render(tile);
            add(colours, watch_.take(), 1.0 / samples, unit);
            first += tile.samples;
        }
        return unit;
    }

private:
    enum class Of : std::uint8_t { lamps, direct, paths };

    Of layer_of(const std::string& name) const {
        if (name.starts_with("emission")) return Of::lamps;
        for (const Node& node : source_.network->graph.nodes)
            if (node.kind == "DirectLighting" && (name == node.name || name.starts_with(node.name + ".")))
                return Of::direct;
        return Of::paths;
    }

    void add(const std::vector<Rgb>& colours, const LightByKind& told, double part, Unit& to) const {
        const double all_told = std::accumulate(told.begin(), told.end(), 0.0);
        const auto& gains = source_.format.gains;
        for (std::size_t k = 0; k < layers_.size(); ++k) {
            if (layers_[k] == Of::lamps) continue;
            const Rgb gain = k < gains.size() ? gains[k] : Rgb{1, 1, 1};
            const double light = part * double{luminance(gain * colours[k])} * source_.scale;
            to.all += light;
            if (layers_[k] == Of::direct)
                to.kinds[static_cast<std::size_t>(PathKind::direct)] += light;
            else if (all_told > 0)
                for (std::size_t kind = 0; kind < told.size(); ++kind) to.kinds[kind] += light * told[kind] / all_told;
        }
    }

    const PixelRecount::Source& source_;
    PathKindWatch watch_;
    SerialRun run_;
    std::vector<Of> layers_;
};

/// What the samples of a pixel say of its error: the square of that of their mean, and what of it is each kind's.
struct Spread {
    double all = 0;
    LightByKind kinds{};
};

Spread spread_of(const std::vector<Unit>& units) {
    Unit mean;
    const double count = double(units.size());
    for (const Unit& unit : units) {
        mean.all += unit.all / count;
        for (std::size_t k = 0; k < path_kinds; ++k) mean.kinds[k] += unit.kinds[k] / count;
    }
    Spread spread;
    for (const Unit& unit : units) {
        const double off = (unit.all - mean.all) / (count * (count - 1));
        spread.all += (unit.all - mean.all) * off;
        for (std::size_t k = 0; k < path_kinds; ++k) spread.kinds[k] += (unit.kinds[k] - mean.kinds[k]) * off;
    }
    return spread;
}

/// Chooses pixels: half of the looks go to all alike, half to where they differ from their neighbours.
class Chances {
public:
    explicit Chances(const std::vector<double>& off) : off_(off), sum_(std::accumulate(off.begin(), off.end(), 0.0)) {}

    double of(std::size_t pixel) const {
        const double alike = 1 / double(off_.size());
        return sum_ > 0 ? 0.5 * alike + 0.5 * off_[pixel] / sum_ : alike;
    }
    /// use(pixel, how many looks) of so many in all, which are spread evenly.
    template <class Use>
    void choose(std::size_t looks, Use&& use) const {
        double before = 0;
        std::size_t next = 0;
        for (std::size_t pixel = 0; pixel < off_.size() && next < looks; ++pixel) {
            before += of(pixel);
            std::size_t here = 0;
            while (next < looks && (double(next) + 0.5) / double(looks) < before) ++next, ++here;
            if (here > 0) use(pixel, here);
        }
    }

private:
    const std::vector<double>& off_;
    double sum_;
};

std::vector<const PictureLayer*> layers_of_things(const Picture& picture) {
    std::vector<const PictureLayer*> layers;
    for (const auto& layer : picture.layers)
        if (!layer.name.starts_with("emission")) layers.push_back(&layer);
    return layers;
}

/// A pixel that is looked at, and for how much it counts.
struct Look {
    std::size_t pixel = 0;
    std::uint32_t samples = 0;
    double weight = 0;
    Spread found{};
};

void look(Look& at, const Picture& picture, Prism& prism) {
    const auto units = std::min(most_units, at.samples);
    std::vector<Unit> found;
    const auto x = picture.x + std::uint32_t(at.pixel % picture.width);
    const auto y = picture.y + std::uint32_t(at.pixel / picture.width);
    for (std::uint32_t u = 0; u < units; ++u) {
        const auto first = u * at.samples / units, last = (u + 1) * at.samples / units;
        found.push_back(prism.unit(x, y, first, last - first));
    }
    at.found = spread_of(found);
}

// Threads take one after the other; what they find is added up in the order of the pixels.
void look_at_pixels(std::vector<Look>& looks, const Picture& picture, const PixelRecount::Source& source,
                    const Lookers& lookers) {
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
        Prism prism(source, lookers);
        for (std::size_t i = next++; i < looks.size(); i = next++) look(looks[i], picture, prism);
    };
    std::vector<std::future<void>> others;
    for (std::size_t i = 1; i < std::min<std::size_t>(lookers.threads, looks.size()); ++i)
        others.push_back(in_background(work));
    const auto all_ended = [&] {
        for (auto& other : others) other.wait();
    };
    try {
        work();
    } catch (...) {
        next = looks.size();
        all_ended();
        throw;
    }
    all_ended();
    for (auto& other : others) other.get();
}

}  // namespace

std::optional<ErrorByPaths> error_by_paths(const Picture& picture, const PixelRecount::Source& source, double part,
                                           const Lookers& lookers) {
    const auto pixels = std::size_t{picture.width} * picture.height;
    const auto samples_at = [&](std::size_t i) {
        return picture.samples.empty() ? source.format.samples : std::uint32_t(picture.samples[i]);
    };
    if (pixels == 0 || source.network->has_passes() || picture.layers.size() != source.format.layers.size())
        return std::nullopt;
    const auto beside = beside_neighbours(picture, layers_of_things(picture));
    const double wanted =
        part * double(pixels) * source.format.samples / std::min(source.format.samples, most_of_pixel);
    const Chances chances(beside.off);
    const auto count = std::size_t(std::max(least_looks, wanted));
    std::vector<Look> looks;
    chances.choose(count, [&](std::size_t pixel, std::size_t looks_there) {
        const auto samples = std::min(most_of_pixel, samples_at(pixel));
        if (samples < 2) return;
        const double weight = double(looks_there) / double(count) /
                              (chances.of(pixel) * double(pixels) * beside.squares[pixel]) * samples /
                              samples_at(pixel);
        looks.push_back({pixel, samples, weight});
    });
    look_at_pixels(looks, picture, source, lookers);
    ErrorByPaths found;
    for (const auto& [pixel, samples, weight, spread] : looks) {
        if (!std::isfinite(spread.all * weight)) continue;
        found.error += weight * spread.all;
        for (std::size_t k = 0; k < path_kinds; ++k) found.shares[k] += weight * spread.kinds[k];
        ++found.pixels;
    }
    if (!(found.error > 0)) return std::nullopt;
    for (double& share : found.shares) share /= found.error;
    return found;
}

}  // namespace lightnet
