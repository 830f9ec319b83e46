// Cleaned frames of a sequence that help each other.
#include "core/film/clean/across.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <random>
#include <string>

#include "core/base/math/vec.hpp"
#include "core/film/clean/clean.hpp"
#include "core/film/gains.hpp"

namespace lightnet::clean_across_test {
namespace {

using testing::HasSubstr;
using Truth = std::function<Rgb(float x, float y)>;

constexpr std::uint32_t side = 40;

PictureLayer shown(const std::string& name, const std::string& letters, const Rgb& value) {
    return {name, std::vector<Rgb>(std::size_t{side} * side, value), {1, 1, 1}, letters};
}

/// A frame after cleaning: two layers, of which one has a third of the light, off by evenly spread noise of deviation
/// `error`, in parts of the root of value² + 0.01, which it tells; and vectors of `motion` pixels to the next frame.
Picture cleaned(const Truth& truth, float error, Vec2 motion, std::uint32_t seed) {
    std::mt19937 random(seed);
    Picture picture{side, side, {}, {{"direct", {}}, {"bounce", {}}}};
    for (std::uint32_t y = 0; y < side; ++y)
        for (std::uint32_t x = 0; x < side; ++x) {
            Rgb value = truth(float(x), float(y));
            const auto off = [&](float c) {
                const float even = (static_cast<float>(random() >> 8) * 0x1p-24f - 0.5f) * std::sqrt(12.0f);
                return c + even * error * std::sqrt(c * c + 0.01f);
            };
            value = {off(value.r), off(value.g), off(value.b)};
            picture.layers[0].pixels.push_back(value * (2 / 3.0f));
            picture.layers[1].pixels.push_back(value * (1 / 3.0f));
        }
    picture.shown = {shown("motion", letters_of_motion, {motion.x, motion.y, 0}),
                     shown(clean_error, usual_letters, {error, error, error})};
    picture.notes.texts[cleaned_note] = "by hand";
    make_beauty(picture);
    return picture;
}

/// Mean square difference from the truth, but for the border.
double error_of(const Picture& picture, const Truth& truth) {
    double sum = 0, count = 0;
    for (std::uint32_t y = 4; y + 4 < side; ++y)
        for (std::uint32_t x = 4; x + 4 < side; ++x, ++count) {
            const Rgb d = picture.beauty[y * side + x] - truth(float(x), float(y));
            sum += double{d.r} * d.r + double{d.g} * d.g + double{d.b} * d.b;
        }
    return sum / count;
}

float told(const Picture& picture) { return picture.shown.back().pixels[side * 20 + 20].r; }

Rgb waves(float x, float y) { return {0.5f + 0.3f * std::sin(0.4f * x), 0.4f + 0.2f * std::sin(0.3f * y), 0.6f}; }

/// Of three frames, with noise of their own; the middle one is that of the truth. Motion goes upwards by positive y.
std::map<int, Picture> three(const Truth& truth, Vec2 motion, float error = 0.1f) {
    std::map<int, Picture> frames;
    for (int frame = 1; frame <= 3; ++frame) {
        const float by = float(frame - 2);
        const auto there = [&, by](float x, float y) { return truth(x - by * motion.x, y + by * motion.y); };
        frames.emplace(frame, cleaned(there, error, motion, 7u * std::uint32_t(frame)));
    }
    return frames;
}

TEST(CleanAcross, TakesNoiseAwayWhereNothingMoves) {
    const auto frames = three(waves, {});
    const auto joined = joined_across(frames, 2);
    const double alone = error_of(frames.at(2), waves), both = error_of(joined, waves);
    EXPECT_LT(both, 0.5 * alone) << "of three frames a third is to be had";
    EXPECT_GT(both, 0.3 * alone);
    const double expected = told(joined) / told(frames.at(2));
    EXPECT_NEAR(expected * expected, both / alone, 0.35 * both / alone) << "and says so";
    EXPECT_THAT(joined.notes.texts.at(cleaned_note), HasSubstr("joined with the frames beside it"));
}

TEST(CleanAcross, FollowsWhatMoves) {
    const auto frames = three(waves, {2.5f, -1.25f});
    EXPECT_LT(error_of(joined_across(frames, 2), waves), 0.5 * error_of(frames.at(2), waves));
    auto lost = frames;
    for (auto& [number, frame] : lost)
        for (auto& pixel : frame.shown[0].pixels) pixel = {};
    EXPECT_GT(error_of(joined_across(lost, 2), waves), 1.2 * error_of(joined_across(frames, 2), waves))
        << "it is by the vectors";
}

TEST(CleanAcross, LeavesWhatIsSeenInOneFrameAlone) {
    auto frames = three(waves, {}, 0.02f);
    const Truth spot = [](float x, float y) {
        return x > 14 && x < 24 && y > 14 && y < 24 ? Rgb{2, 0, 0} : waves(x, y);
    };
    frames.at(2) = cleaned(spot, 0.02f, {}, 14);
    EXPECT_LT(error_of(joined_across(frames, 2), spot), 1.1 * error_of(frames.at(2), spot));
}

TEST(CleanAcross, SaysThatNoiseWhichFramesShareIsStillThere) {
    std::map<int, Picture> frames;
    for (int frame = 1; frame <= 3; ++frame) frames.emplace(frame, cleaned(waves, 0.1f, {}, 7));
    const auto joined = joined_across(frames, 2);
    EXPECT_NEAR(error_of(joined, waves) / error_of(frames.at(2), waves), 1, 1e-3);
    EXPECT_NEAR(told(joined) / told(frames.at(2)), 1, 1e-3);
}

TEST(CleanAcross, KeepsSumsAndKnowsOfNoGains) {
    const auto frames = three(waves, {1.5f, 0});
    const auto joined = joined_across(frames, 2);
    for (std::size_t i = 0; i < joined.beauty.size(); ++i)
        ASSERT_EQ(joined.beauty[i], joined.layers[0].pixels[i] + joined.layers[1].pixels[i]);
    auto mixed_before = frames;
    const std::vector<Gain> gains{{"direct", {0.5f, 2, 1}}};
    for (auto& [number, frame] : mixed_before) mix(frame, gains);
    const auto before = joined_across(mixed_before, 2);
    auto after = joined;
    mix(after, gains);
    EXPECT_EQ(before.beauty, after.beauty);
    EXPECT_EQ(before.layers, after.layers);
    EXPECT_EQ(before.shown, after.shown);
}

TEST(CleanAcross, GoesAsFarAsFramesFitTogether) {
    auto frames = three(waves, {});
    const auto alone = joined_across({{2, frames.at(2)}}, 2);
    EXPECT_EQ(alone.beauty, frames.at(2).beauty);
    auto other = frames;
    other.at(1).layers[0].name = other.at(3).layers[0].name = "another";
    EXPECT_EQ(joined_across(other, 2).beauty, alone.beauty);
    frames.emplace(5, frames.at(3));
    EXPECT_EQ(joined_across(frames, 5).beauty, frames.at(5).beauty) << "frame 4 is missing";
}

TEST(CleanAcross, TakesNoNumbersThatAreNone) {
    auto frames = three(waves, {});
    frames.at(1).layers[0].pixels[side * 20 + 20] = {std::numeric_limits<float>::infinity(), 0, 0};
    for (const int frame : {1, 2})
        frames.at(frame).shown[0].pixels[side * 21 + 20].r = std::numeric_limits<float>::quiet_NaN();
    for (const Rgb& pixel : joined_across(frames, 2).beauty) ASSERT_TRUE(std::isfinite(pixel.r + pixel.g + pixel.b));
}

TEST(CleanAcross, NeedsVectorsAndErrors) {
    Picture frame = cleaned(waves, 0.1f, {}, 1);
    EXPECT_EQ(fault_across(frame), "");
    auto without = frame;
    without.shown.pop_back();
    EXPECT_THAT(fault_across(without), HasSubstr("render it with --clean"));
    without = frame;
    without.shown.erase(without.shown.begin());
    EXPECT_THAT(fault_across(without), HasSubstr("show SurfaceFact { of = \"motion\" }"));
    frame.layers.clear();
    EXPECT_THAT(fault_across(frame), HasSubstr("has no layers"));
}

}  // namespace
}  // namespace lightnet::clean_across_test
