#include "core/film/clean/guide.hpp"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <optional>
#include <utility>

#include "core/base/math/columns.hpp"
#include "core/base/math/exponential.hpp"
#include "core/film/clean/pieces.hpp"
#include "core/film/clean_layers.hpp"

namespace lightnet::cleaning {
namespace {

constexpr std::size_t rows_at_once = 16;

float channel_of(const Rgb& colour, std::size_t channel) {
    return channel == 0 ? colour.r : channel == 1 ? colour.g : colour.b;
}

/// A number per pixel, in both halves of the samples.
struct InHalves {
    Sheet first, second;
};

// Calls work(y) for each row, on all cores.
template <class Work>
void each_row(std::size_t height, const Work& work) {
    parallel_for(
        height,
        [&](std::size_t first, std::size_t last) {
            for (std::size_t y = first; y < last; ++y) work(static_cast<std::int64_t>(y));
        },
        rows_at_once);
}

// Calls value(pixel) for each, and brings it to a sheet.
template <class Value>
Sheet sheet_of(std::uint32_t width, std::uint32_t height, const Value& value) {
    Sheet sheet(width, height);
    each_row(height, [&](std::int64_t y) {
        float* const row = sheet.at(0, y);
        for (std::size_t x = 0; x < width; ++x) row[x] = value(static_cast<std::size_t>(y) * width + x);
    });
    sheet.extend(width, height);
    return sheet;
}

const PictureLayer* layer_called(const std::vector<PictureLayer>& layers, const std::string& name) {
    const auto found = std::find_if(layers.begin(), layers.end(), [&](const auto& l) { return l.name == name; });
    return found == layers.end() ? nullptr : &*found;
}

// The sum of the layers, without gains; none: some have no half.
std::optional<std::vector<Rgb>> second_half(const Picture& picture) {
    std::vector<Rgb> sum(std::size_t{picture.width} * picture.height);
    std::atomic<bool> differ{false};
    for (const auto& layer : picture.layers) {
        const auto* half = layer_called(picture.shown, half_of(layer.name));
        if (!half) return std::nullopt;
        parallel_for(sum.size(), [&](std::size_t first, std::size_t last) {
            bool here = false;
            for (std::size_t i = first; i < last; ++i) {
                sum[i] += half->pixels[i];
                here = here || half->pixels[i] != layer.pixels[i] * 0.5f;
            }
            if (here) differ = true;
        });
    }
    if (!differ || picture.layers.empty()) return std::nullopt;  // of one sample both halves are alike
    return sum;
}

std::vector<Rgb> without_gains(const Picture& picture) {
    if (picture.layers.empty()) return picture.beauty;
    std::vector<Rgb> sum(std::size_t{picture.width} * picture.height);
    parallel_for(sum.size(), [&](std::size_t first, std::size_t last) {
        for (const auto& layer : picture.layers)
            for (std::size_t i = first; i < last; ++i) sum[i] += layer.pixels[i];
    });
    return sum;
}

// Half of the squared difference of two means, which is the variance of each, over some pixels.
Sheet variance_between(const InHalves& halves, std::uint32_t width, std::uint32_t height, std::uint32_t radius) {
    return smoothed(width, height, radius, [&](std::int64_t y, float* row) {
        const float *const first = halves.first.at(0, y), *const second = halves.second.at(0, y);
        for (std::size_t x = 0; x < width; ++x) row[x] = (first[x] - second[x]) * (first[x] - second[x]) * 0.5f;
        return row;
    });
}

// Without halves: what the four neighbours don't foretell (Immerkær 1996, "Fast Noise Variance Estimation", in the
// simplest form). Edges count as noise, too.
Sheet variance_by_neighbours(const Sheet& sheet, std::uint32_t width, std::uint32_t height) {
    return smoothed(width, height, 2, [&](std::int64_t y, float* row) {
        for (std::int64_t x = 0; x < std::int64_t{width}; ++x) {
            const float around =
                0.25f * (*sheet.at(x - 1, y) + *sheet.at(x + 1, y) + *sheet.at(x, y - 1) + *sheet.at(x, y + 1));
            const float apart = *sheet.at(x, y) - around;
            row[x] = apart * apart * 0.8f;  // whose variance is 5/4 of one pixel's
        }
        return row;
    });
}

constexpr std::int64_t feature_reach = 1;  // pixels to each side over which a feature's noise is taken away

/// Non-local means of the channels of a feature over 3 × 3 pixels, of some rows of one half, by the weights of the
/// other (Rousselle et al. 2012, eq. 4, with neighbourhoods of 3 × 3).
struct FeatureRows {
    struct Channel {
        const Sheet *values, *weighed_by, *variance;
        std::vector<float> sums;
    };
    std::vector<Channel> channels;
    const Sheet& inside;
    std::size_t width, rows, first;
    std::vector<float> apart, weights, all;
    std::int64_t dx = 0, dy = 0;

    FeatureRows(const Sheet& within, std::size_t across, std::size_t from, std::size_t to)
        : inside(within), width(across), rows(to - from), first(from) {
        apart.resize((rows + 2) * (width + 2)), weights.resize(width), all.resize(rows * width);
    }

    [[gnu::always_inline]] void work() {
        std::fill(apart.begin(), apart.end(), 0.0f);
        for (const Channel& channel : channels)
            for (std::size_t y = 0; y < rows + 2; ++y) row_of_distances(channel, y);
        for (std::size_t y = 0; y < rows; ++y) {
            row_of_weights(y);
            for (Channel& channel : channels) row_of_sums(channel, y);
        }
    }

private:
    [[gnu::always_inline]] std::int64_t row(std::size_t y) const { return static_cast<std::int64_t>(first + y); }

    // What noise explains of a difference is taken from it.
    [[gnu::always_inline]] void row_of_distances(const Channel& channel, std::size_t y) {
        const float* const here = channel.weighed_by->at(-1, row(y) - 1);
        const float* const there = channel.weighed_by->at(dx - 1, row(y) - 1 + dy);
        const float* const noise_here = channel.variance->at(-1, row(y) - 1);
        const float* const noise_there = channel.variance->at(dx - 1, row(y) - 1 + dy);
        float* const out = apart.data() + y * (width + 2);
        for (std::size_t x = 0; x < width + 2; ++x) {
            const float off = here[x] - there[x], p = noise_here[x], q = noise_there[x];
            out[x] += (off * off - (p + (p < q ? p : q))) / (1e-10f + p + q);
        }
    }
    [[gnu::always_inline]] void row_of_weights(std::size_t y) {
        const float scale = 1 / (9 * static_cast<float>(channels.size()));
        const float *const above = apart.data() + y * (width + 2), *const here = above + width + 2,
                           *const below = here + width + 2;
        const float* const in = inside.at(dx, row(y) + dy);
        float* const sum = all.data() + y * width;
        for (std::size_t x = 0; x < width; ++x) {
            const float far = (above[x] + above[x + 1] + above[x + 2] + here[x] + here[x + 1] + here[x + 2] + below[x] +
                               below[x + 1] + below[x + 2]) *
                              scale;
            const float weight = exponential(far > 0 ? -far : 0.0f) * in[x];
            weights[x] = far < 5 ? weight : 0;
            sum[x] += weights[x];
        }
    }
    [[gnu::always_inline]] void row_of_sums(Channel& channel, std::size_t y) {
        const float* const here = channel.values->at(0, row(y));
        const float* const there = channel.values->at(dx, row(y) + dy);
        float* const sum = channel.sums.data() + y * width;
        for (std::size_t x = 0; x < width; ++x) sum[x] += weights[x] * (there[x] - here[x]);
    }
};

/// A channel of a feature, and the variance of either half.
struct NoisyFeature {
    InHalves halves;
    Sheet variance;
};

// Of one half, in place of what `cleaned` has.
void take_noise_from(const std::vector<NoisyFeature>& noisy, const Guide& guide, std::vector<InHalves>& cleaned,
                     Sheet InHalves::*half, Sheet InHalves::*other, std::size_t from, std::size_t to) {
    FeatureRows rows(guide.inside, guide.width, from, to);
    for (const auto& channel : noisy)
        rows.channels.push_back({&(channel.halves.*half), &(channel.halves.*other), &channel.variance,
                                 std::vector<float>((to - from) * guide.width)});
    for (rows.dy = -feature_reach; rows.dy <= feature_reach; ++rows.dy)
        for (rows.dx = -feature_reach; rows.dx <= feature_reach; ++rows.dx) work_in_lanes(rows);
    for (std::size_t c = 0; c < noisy.size(); ++c)
        for (std::size_t y = from; y < to; ++y) {
            const float* const here = (noisy[c].halves.*half).at(0, static_cast<std::int64_t>(y));
            float* const out = (cleaned[c].*half).at(0, static_cast<std::int64_t>(y));
            for (std::size_t x = 0; x < guide.width; ++x) {
                const std::size_t i = (y - from) * guide.width + x;
                out[x] = here[x] + rows.channels[c].sums[i] / rows.all[i];
            }
        }
}

// Its channels are filtered with the same weights.
void add_without_noise(const std::vector<NoisyFeature>& noisy, Guide& guide) {
    std::vector<InHalves> cleaned(noisy.size(), {Sheet(guide.width, guide.height), Sheet(guide.width, guide.height)});
    in_large_pieces(
        guide.height,
        [&](std::size_t from, std::size_t to) {
            take_noise_from(noisy, guide, cleaned, &InHalves::first, &InHalves::second, from, to);
            take_noise_from(noisy, guide, cleaned, &InHalves::second, &InHalves::first, from, to);
        },
        rows_at_once);
    for (const auto& [first, second] : cleaned) {
        const auto &one = first, &other = second;
        Feature feature{Sheet(guide.width, guide.height), {}};
        each_row(guide.height, [&](std::int64_t y) {
            const float *const a = one.at(0, y), *const b = other.at(0, y);
            float* const value = feature.value.at(0, y);
            for (std::size_t x = 0; x < guide.width; ++x) value[x] = (a[x] + b[x]) * 0.5f;
        });
        feature.value.extend(guide.width, guide.height);
        feature.noise = smoothed(guide.width, guide.height, 1, [&](std::int64_t y, float* row) {
            const float *const a = one.at(0, y), *const b = other.at(0, y);
            for (std::size_t x = 0; x < guide.width; ++x) row[x] = (a[x] - b[x]) * (a[x] - b[x]) * 0.25f;
            return row;
        });
        guide.features.push_back(std::move(feature));
    }
}

// So that all features have numbers of about 1.
float range_of(const PictureLayer& layer, std::size_t channel) {
    float least = largest, most = -largest;
    std::mutex range_mutex;
    parallel_for(layer.pixels.size(), [&](std::size_t first, std::size_t last) {
        float lower = largest, upper = -largest;
        for (std::size_t i = first; i < last; ++i) {
            const float value = sound(channel_of(layer.pixels[i], channel));
            lower = std::min(lower, value), upper = std::max(upper, value);
        }
        const std::lock_guard lock(range_mutex);
        least = std::min(least, lower), most = std::max(most, upper);
    });
    return most - least;
}

// `channels`: so many of the layer's.
void add_feature(const Picture& picture, const PictureLayer& layer, std::size_t channels, Guide& guide) {
    const auto* half = layer_called(picture.shown, half_of(layer.name));
    std::vector<NoisyFeature> noisy;
    for (std::size_t channel = 0; channel < channels; ++channel) {
        const float range = range_of(layer, channel);
        if (!(range > 0)) continue;  // it tells nothing apart
        const auto whole_at = [&](std::size_t i) { return sound(channel_of(layer.pixels[i], channel)) / range; };
        if (!half) {
            guide.features.push_back(
                {sheet_of(guide.width, guide.height, whole_at), Sheet::of_zeros(guide.width, guide.height)});
            continue;
        }
        const auto half_at = [&](std::size_t i) { return sound(channel_of(half->pixels[i], channel)) / range; };
        InHalves halves{
            sheet_of(guide.width, guide.height, [&](std::size_t i) { return 2 * (whole_at(i) - half_at(i)); }),
            sheet_of(guide.width, guide.height, [&](std::size_t i) { return 2 * half_at(i); })};
        Sheet variance = variance_between(halves, guide.width, guide.height, 2);
        noisy.push_back({std::move(halves), std::move(variance)});
    }
    if (!noisy.empty()) add_without_noise(noisy, guide);
}

// Those that a run with `clean` makes, or else what a user shows under such a name.
void add_features(const Picture& picture, Guide& guide) {
    for (const auto& name : feature_layers()) {
        const auto* layer = layer_called(picture.shown, name);
        if (!layer) layer = layer_called(picture.shown, name.substr(name.find('_') + 1));
        if (layer) add_feature(picture, *layer, name == feature_layers().back() ? 1 : 3, guide);
    }
}

// Of the mean of 3 x 3 pixels of one half, from what it is for single ones over more of them.
Sheet variance_of_means(const InHalves& halves, bool differ, std::uint32_t width, std::uint32_t height) {
    Sheet variance =
        differ ? variance_between(halves, width, height, 3) : variance_by_neighbours(halves.first, width, height);
    variance.scale(1.0f / 9);
    return variance;
}

void add_colours(const Picture& picture, Guide& guide) {
    const std::uint32_t width = guide.width, height = guide.height;
    const auto whole = without_gains(picture);
    const auto second = second_half(picture);
    guide.halves = second.has_value();
    for (std::size_t c = 0; c < 3; ++c) {
        const auto all = [&](std::size_t i) { return channel_of(whole[i], c); };
        const auto part = [&](std::size_t i) { return second ? channel_of((*second)[i], c) : 0.5f * all(i); };
        InHalves halves{sheet_of(width, height, [&](std::size_t i) { return sound(2 * (all(i) - part(i))); }),
                        sheet_of(width, height, [&](std::size_t i) { return sound(2 * part(i)); })};
        guide.variance[c] = variance_of_means(halves, guide.halves, width, height);
        guide.means[0][c] = smoothed(halves.first, width, height, 1);
        guide.means[1][c] = smoothed(halves.second, width, height, 1);
        guide.half[0][c] = std::move(halves.first), guide.half[1][c] = std::move(halves.second);
    }
}

}  // namespace

Guide take_guide(Picture& picture) {
    Guide guide;
    guide.width = picture.width, guide.height = picture.height;
    guide.inside = Sheet::of_zeros(guide.width, guide.height);
    for (std::uint32_t y = 0; y < guide.height; ++y) std::fill_n(guide.inside.at(0, y), guide.width, 1.0f);
    add_features(picture, guide);
    for (const auto& name : feature_layers())
        std::erase_if(picture.shown,
                      [&](const auto& layer) { return layer.name == name || layer.name == half_of(name); });
    add_colours(picture, guide);
    return guide;
}

}  // namespace lightnet::cleaning
