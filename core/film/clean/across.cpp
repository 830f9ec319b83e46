#include "core/film/clean/across.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "core/base/math/vec.hpp"
#include "core/film/clean/clean.hpp"
#include "core/film/clean/pieces.hpp"

namespace lightnet {
namespace {

constexpr std::size_t rows_of_piece = 16;
// Of the way back to a point of the frame before: each step takes what is left of it by as much as motion differs
// there.
constexpr int steps_back = 4;
// Of differences, in parts of what noise makes of them: beyond that a frame counts for nothing.
constexpr float too_far_apart = 1000;

const PictureLayer* layer_of(const Picture& picture, const auto& wanted) {
    const auto found = std::ranges::find_if(picture.shown, wanted);
    return found == picture.shown.end() ? nullptr : &*found;
}
const PictureLayer* motion_of(const Picture& picture) {
    return layer_of(picture, [](const PictureLayer& layer) { return layer.letters == letters_of_motion; });
}
const PictureLayer* error_of(const Picture& picture) {
    return layer_of(picture, [](const PictureLayer& layer) { return layer.name == clean_error; });
}

/// Four pixels around a point between their middles, and what each counts.
struct Between {
    std::size_t at[4];
    float weight[4];

    Rgb of(const std::vector<Rgb>& pixels) const {
        Rgb sum;
        for (int i = 0; i < 4; ++i) sum += pixels[at[i]] * weight[i];
        return sum;
    }
};

/// A frame as it is looked up.
class Frame {
public:
    explicit Frame(const Picture& picture) : picture_(picture), motion_(motion_of(picture)), error_(error_of(picture)) {
        sum_.assign(std::size_t{picture.width} * picture.height, {});
        for (const auto& layer : picture.layers)
            for (std::size_t i = 0; i < sum_.size(); ++i) sum_[i] += layer.pixels[i];
    }
    const Picture& picture() const { return picture_; }
    const Rgb& sum(std::size_t pixel) const { return sum_[pixel]; }
    const std::vector<Rgb>& sums() const { return sum_; }
    const std::vector<Rgb>& errors() const { return error_->pixels; }
    /// Around a place in pixels, of which (0, 0) is the middle of the upper left one. None: it lies outside.
    std::optional<Between> around(Vec2 place) const {
        const auto width = std::int64_t{picture_.width}, height = std::int64_t{picture_.height};
        if (!(place.x > -0.5f && place.y > -0.5f && place.x < float(width) - 0.5f && place.y < float(height) - 0.5f))
            return std::nullopt;
        const float left = std::floor(place.x), top = std::floor(place.y), dx = place.x - left, dy = place.y - top;
        const auto index = [&](std::int64_t x, std::int64_t y) {
            return std::size_t(std::clamp<std::int64_t>(y, 0, height - 1) * width +
                               std::clamp<std::int64_t>(x, 0, width - 1));
        };
        const auto x = std::int64_t(left), y = std::int64_t(top);
        return Between{{index(x, y), index(x + 1, y), index(x, y + 1), index(x + 1, y + 1)},
                       {(1 - dx) * (1 - dy), dx * (1 - dy), (1 - dx) * dy, dx * dy}};
    }
    /// Where what is there will be in the next frame.
    std::optional<Vec2> later(Vec2 place) const {
        const auto way = around(place);
        if (!way) return std::nullopt;
        const Rgb pixels = way->of(motion_->pixels);  // upwards, where rows go down
        return Vec2{place.x + pixels.r, place.y - pixels.g};
    }
    /// Where in this frame the point was that is there in the next.
    std::optional<Vec2> earlier(Vec2 place) const {
        Vec2 from = place;
        for (int step = 0; step < steps_back; ++step) {
            const auto reached = later(from);
            if (!reached) return std::nullopt;
            from = {from.x + place.x - reached->x, from.y + place.y - reached->y};
        }
        return from;
    }

private:
    const Picture& picture_;
    const PictureLayer *motion_, *error_;
    std::vector<Rgb> sum_;  // of the layers, without gains
};

/// What a value is expected to be off by, squared: see clean_error.
float squared_error(float value, float expected) { return expected * expected * (value * value + 0.01f); }

/// One pixel of the frame that is made, and what the others say of it.
class Joining {
public:
    Joining(const std::map<int, Frame>& frames, int which) : frames_(frames), own_(frames.at(which)), which_(which) {}

    struct Share {
        const Frame* frame;
        Between around;
        float weight, alike;  // how much it counts; 1: the noise of both is the same, 0: it has nothing in common
    };
    std::vector<Share> shares(std::uint32_t x, std::uint32_t y) const {
        std::vector<Share> shares;
        for (const int by : {-1, 1}) {
            std::optional<Vec2> place = Vec2{float(x), float(y)};
            for (int number = which_ + by; frames_.contains(number); number += by) {
                const Frame& frame = frames_.at(number);
                place = by > 0 ? frames_.at(number - 1).later(*place) : frame.earlier(*place);
                const auto around = place ? frame.around(*place) : std::nullopt;
                if (!around) break;
                const float apart = difference(x, y, frame, *place);
                if (!(apart < too_far_apart)) continue;  // no number, where a foreign file holds one that is none
                shares.push_back({&frame, *around, 1 / (1 + apart * apart), std::max(0.0f, 1 - apart)});
            }
        }
        return shares;
    }

private:
    // Mean over 3 x 3 pixels of the squared difference, in parts of what noise is expected to make of it: 1 where both
    // show the same with noise of their own.
    float difference(std::uint32_t x, std::uint32_t y, const Frame& other, Vec2 there) const {
        const auto width = std::int64_t{own_.picture().width}, height = std::int64_t{own_.picture().height};
        float sum = 0, count = 0;
        for (std::int64_t j = -1; j <= 1; ++j)
            for (std::int64_t i = -1; i <= 1; ++i) {
                const std::int64_t px = std::int64_t{x} + i, py = std::int64_t{y} + j;
                if (px < 0 || py < 0 || px >= width || py >= height) continue;
                const auto around = other.around({there.x + float(i), there.y + float(j)});
                if (!around) continue;
                const auto pixel = std::size_t(py * width + px);
                const Rgb here = own_.sum(pixel), far = around->of(other.sums());
                const float expected = own_.errors()[pixel].r, expected_far = around->of(other.errors()).r;
                for (const auto& [a, b] :
                     {std::pair(here.r, far.r), std::pair(here.g, far.g), std::pair(here.b, far.b)}) {
                    const float noise = squared_error(a, expected) + squared_error(b, expected_far);
                    sum += (a - b) * (a - b) / (noise + 1e-12f);
                    count += 1;
                }
            }
        return count > 0 ? sum / count : too_far_apart;
    }

    const std::map<int, Frame>& frames_;
    const Frame& own_;
    int which_;
};

bool fit_together(const Picture& a, const Picture& b) {
    const auto same_name = [](const PictureLayer& one, const PictureLayer& other) { return one.name == other.name; };
    return a.width == b.width && a.height == b.height && a.x == b.x && a.y == b.y &&
           std::ranges::equal(a.layers, b.layers, same_name) && fault_across(b).empty();
}

}  // namespace

std::string fault_across(const Picture& cleaned) {
    if (cleaned.layers.empty()) return "has no layers";
    if (!motion_of(cleaned))
        return "has no vectors to the next frame: show SurfaceFact { of = \"motion\" } in its graph";
    if (!error_of(cleaned))
        return "says nothing of its error, as its samples were not in two halves: render it with --clean";
    return "";
}

// DECISIONS: frames-joined-after-cleaning
Picture joined_across(const std::map<int, Picture>& pictures, int which) {
    const Picture& own = pictures.at(which);
    std::map<int, Frame> frames;
    for (const auto& [number, picture] : pictures)
        if (fit_together(own, picture)) frames.emplace(number, picture);
    Picture made = own;
    const auto error = std::ranges::find(made.shown, std::string(clean_error), &PictureLayer::name);
    const Joining joining(frames, which);
    cleaning::in_large_pieces(
        own.height,
        [&](std::size_t first, std::size_t last) {
            for (std::size_t y = first; y < last; ++y)
                for (std::size_t x = 0; x < own.width; ++x) {
                    const auto shares = joining.shares(std::uint32_t(x), std::uint32_t(y));
                    const std::size_t pixel = y * own.width + x;
                    float all = 1, in_common = 1, of_their_own = 0;
                    for (const auto& share : shares) {
                        all += share.weight;
                        in_common += share.weight * share.alike;
                        of_their_own += share.weight * share.weight * (1 - share.alike * share.alike);
                    }
                    for (std::size_t l = 0; l < made.layers.size(); ++l) {
                        Rgb sum = own.layers[l].pixels[pixel];
                        for (const auto& share : shares)
                            sum += share.around.of(share.frame->picture().layers[l].pixels) * share.weight;
                        made.layers[l].pixels[pixel] = sum / all;
                    }
                    const float left = std::min(1.0f, std::sqrt(in_common * in_common + of_their_own) / all);
                    error->pixels[pixel] = error->pixels[pixel] * left;
                }
        },
        rows_of_piece);
    made.notes.texts[cleaned_note] += "; joined with the frames beside it";
    make_beauty(made);
    return made;
}

}  // namespace lightnet
