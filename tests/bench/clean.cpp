// What cleaning brings: pictures of scenes with references by path tracing, noisy and cleaned, at several numbers of
// samples and with three seeds. Errors are relative squares (compare.hpp), of pixels and of means over blocks, less the
// reference's own noise, and FLIP.
// Arguments: names of scenes; without any, all of them. LIGHTNET_BENCH_SAMPLES: "4,32" instead of 4, 16, 32 and 128; of
// 1024, if it is among them, is judged that cleaning does no harm.
// LIGHTNET_BENCH_TRUTH: pictures of so many samples of our own take the place of the references, of which those of real
// scenes are noisy or another renderer's; their noise follows from that of fewer samples.
// LIGHTNET_BENCH_PICTURES: a folder that keeps the noisy pictures, which take nearly all of the time, for the next run.
// A row ends in what path tracing alone would have to spend for the cleaned error, as that falls like 1 / samples.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/film/clean/clean.hpp"
#include "core/film/compare.hpp"
#include "core/film/exr.hpp"
#include "core/film/flip.hpp"
#include "tests/bench/figure.hpp"
#include "tests/bench/scene_files.hpp"
#include "tests/support/folder.hpp"
#include "transport/start/child.hpp"

namespace lightnet::bench {
namespace {

const int seeds = repeated(3);
constexpr int judged = 32;        // samples, at which goals are stated
constexpr double times_less = 6;  // the relative square error of the median scene: by so much, at least
constexpr double most_shift = 3e-3;
constexpr int many = 1024;  // samples, at which nothing may get worse
constexpr double most_harm = 1.02;
constexpr double most_untold = 1.5;       // factor between the expected and the true error, in the mean over blocks
constexpr std::uint32_t block_side = 32;  // pixels of them
constexpr std::uint32_t mean_side = 16;   // of blocks whose means must not be further off than the noisy picture's

std::vector<int> sample_counts() {
    if (smoke()) return {4};
    const char* given = std::getenv("LIGHTNET_BENCH_SAMPLES");
    std::istringstream text(given ? given : "4,16,32,128");
    std::vector<int> counts;
    for (std::string one; std::getline(text, one, ',');) counts.push_back(std::stoi(one));
    return counts;
}

/// How far a picture is from the reference.
struct Errors {
    double square = 0, flip = 0, shift = 0, blocks = 0, of_means = 0;
};

Rgb mean_of_block(const Picture& picture, std::uint32_t left, std::uint32_t top) {
    Rgb sum;
    for (std::uint32_t y = top; y < top + mean_side; ++y)
        for (std::uint32_t x = left; x < left + mean_side; ++x)
            sum += picture.beauty[std::size_t{y} * picture.width + x];
    return sum / (mean_side * mean_side);
}

double relative_square_of(const Rgb& value, const Rgb& truth) {
    const auto square = [](float one, float other) {
        return std::pow(double{one} - other, 2) / (double{other} * other + 0.01);
    };
    return (square(value.r, truth.r) + square(value.g, truth.g) + square(value.b, truth.b)) / 3;
}

// Relative square error of the means of whole blocks.
double square_of_means(const Picture& reference, const Picture& picture) {
    double sum = 0, blocks = 0;
    for (std::uint32_t y = 0; y + mean_side <= reference.height; y += mean_side)
        for (std::uint32_t x = 0; x + mean_side <= reference.width; x += mean_side, ++blocks)
            sum += relative_square_of(mean_of_block(picture, x, y), mean_of_block(reference, x, y));
    return sum / blocks;
}

Errors errors_of(const Picture& reference, const Picture& picture, double noise) {
    const Difference found = compare(reference, picture);
    const double shift = std::max(
        {std::abs(found.mean_ratio.r - 1), std::abs(found.mean_ratio.g - 1), std::abs(found.mean_ratio.b - 1)});
    return {std::max(1e-7, found.relative_square - noise), flip(reference.width, reference.beauty, picture.beauty).mean,
            shift, found.block_difference,
            std::max(1e-8, square_of_means(reference, picture) - noise / (mean_side * mean_side))};
}

/// One number of samples of one scene, by seed.
struct Row {
    std::vector<double> noisy, cleaned, noisy_flip, cleaned_flip, noisy_shift, cleaned_shift, noisy_blocks,
        cleaned_blocks, means;
    std::vector<double> seconds, told, told_in_blocks, wrong;
    void add(const Errors& before, const Errors& after) {
        noisy.push_back(before.square), cleaned.push_back(after.square);
        noisy_flip.push_back(before.flip), cleaned_flip.push_back(after.flip);
        noisy_shift.push_back(before.shift), cleaned_shift.push_back(after.shift);
        noisy_blocks.push_back(before.blocks), cleaned_blocks.push_back(after.blocks);
        means.push_back(std::sqrt(after.of_means / before.of_means));
    }
    double times() const {
        std::vector<double> all;
        for (std::size_t i = 0; i < noisy.size(); ++i) all.push_back(noisy[i] / cleaned[i]);
        return median(all);
    }
};

/// The expected error of a cleaned picture, in parts of the one that it has: of all of it, and the geometric mean over
/// blocks, without those of which the reference's own noise hides the error.
struct Told {
    double all = 0, in_blocks = 0;
};

Told told_by(const Picture& cleaned, const Picture& reference, double noise) {
    const auto& told = cleaned.shown.back().pixels;
    double all_told = 0, all_true = 0, logs = 0, blocks = 0;
    for (std::uint32_t top = 0; top < cleaned.height; top += block_side)
        for (std::uint32_t left = 0; left < cleaned.width; left += block_side) {
            double expected = 0, true_error = 0, pixels = 0;
            for (std::uint32_t y = top; y < std::min(top + block_side, cleaned.height); ++y)
                for (std::uint32_t x = left; x < std::min(left + block_side, cleaned.width); ++x, ++pixels) {
                    const std::size_t i = std::size_t{y} * cleaned.width + x;
                    expected += double{told[i].r} * told[i].r;
                    true_error += relative_square_of(cleaned.beauty[i], reference.beauty[i]);
                }
            expected /= pixels, true_error = true_error / pixels - noise;
            all_told += expected * pixels, all_true += true_error * pixels;
            if (true_error <= std::max(1e-7, 0.3 * noise)) continue;
            logs += 0.5 * std::log(expected / true_error), ++blocks;
        }
    return {std::sqrt(all_told / std::max(1e-7, all_true)), blocks > 0 ? std::exp(logs / blocks) : 1};
}

std::string kept_picture(const std::string& scene, int samples, int seed) {
    const char* folder = std::getenv("LIGHTNET_BENCH_PICTURES");
    return folder ? fmt::format("{}/{}.{}.{}.exr", folder, scene, samples, seed) : "";
}

Picture rendered(const std::string& scene, const SceneFiles& files, const Picture& reference, int samples, int seed) {
    const auto kept = kept_picture(scene, samples, seed);
    if (!smoke() && std::filesystem::exists(kept)) return read_exr(kept);
    const test::Folder folder;
    const auto side = [](std::uint32_t pixels) { return std::to_string(sized(pixels, pixels / 8)); };
    const auto out = folder / "x.exr";
    const auto output =
        run_program({LIGHTNET_STARTS_LIGHTNET, "render", files.main().string(), "--clean", "--samples",
                     std::to_string(samples), "--size", side(reference.width) + "x" + side(reference.height), "--seed",
                     std::to_string(seed), "--forget", "--progress", "none", "-o", out},
                    "", std::chrono::minutes(30));
    if (output.code != 0) throw std::runtime_error("lightnet ended badly: " + output.text);
    if (!smoke() && !kept.empty()) std::filesystem::copy_file(out, kept);
    return read_exr(out);
}

/// What pictures are compared with.
struct Truth {
    Picture picture;
    double noise = 0;  // as a relative square error
    int samples = 0;   // of our own; 0: it is the scene's reference, whose noise is known

    /// Its noise, as a picture of so many samples shows it, whose own falls alike.
    double noise_beside(const Picture& noisy, int count) const {
        if (!samples) return noise;
        return compare(picture, noisy).relative_square * count / (count + samples);
    }
};

Truth truth_of(const ReferenceScene& scene, const SceneFiles& files) {
    constexpr int seed_of_truth = 1000;
    const Picture reference = read_exr(files.reference());
    const char* samples = std::getenv("LIGHTNET_BENCH_TRUTH");
    if (!samples || smoke()) return {reference, scene.noise, 0};
    const int count = std::stoi(samples);
    return {rendered(scene.name, files, reference, count, seed_of_truth), 0, count};
}

// Pixels whose beauty is not the float32 sum of the layers, each times its gain.
double wrong_sums(const Picture& cleaned) {
    double wrong = 0;
    const auto sums = sum_of(cleaned.layers);
    for (std::size_t i = 0; i < sums.size(); ++i) wrong += sums[i] != cleaned.beauty[i];
    return wrong;
}

Row measured(const ReferenceScene& scene, const SceneFiles& files, const Truth& truth, int samples) {
    const Picture& reference = truth.picture;
    Row row;
    for (int seed = 1; seed <= seeds; ++seed) {
        const Picture noisy = rendered(scene.name, files, reference, samples, seed);
        Cleaned cleaned;
        const double cpu = process_seconds();
        cleaned = clean(noisy);
        row.seconds.push_back((process_seconds() - cpu) / double(noisy.beauty.size()) * 1e6);
        if (smoke()) continue;
        const double noise = truth.noise_beside(noisy, samples);
        row.add(errors_of(reference, noisy, noise), errors_of(reference, cleaned.picture, noise));
        row.wrong.push_back(wrong_sums(cleaned.picture));
        const Told told = told_by(cleaned.picture, reference, noise);
        row.told.push_back(told.all), row.told_in_blocks.push_back(told.in_blocks);
    }
    return row;
}

/// For the judgement over all scenes.
struct Judged {
    std::vector<double> times, flips, shifts, means, harms, sums, untold;
};

void measure(const ReferenceScene& scene, Judged& all) {
    const SceneFiles files(scene);
    if (files.missing()) return not_run("clean." + scene.name, *files.missing());
    const Truth truth = truth_of(scene, files);
    for (const int samples : sample_counts()) {
        const Row row = measured(scene, files, truth, samples);
        if (smoke()) {
            std::printf("clean.%s ran\n", scene.name.c_str());
            continue;
        }
        std::printf(
            "  %s, %d samples: error %.2e to %.2e, %.1f x less (as %.0f samples); FLIP %.4f to %.4f; mean off by "
            "%.2f %% to %.2f %%; blocks %.2f %% to %.2f %%, their means' error times %.2f; tells %.2f of its error, "
            "%.2f "
            "in blocks; %.1f s of a core per Mpixel\n",
            scene.name.c_str(), samples, median(row.noisy), median(row.cleaned), row.times(), samples * row.times(),
            median(row.noisy_flip), median(row.cleaned_flip), 100 * median(row.noisy_shift),
            100 * median(row.cleaned_shift), 100 * median(row.noisy_blocks), 100 * median(row.cleaned_blocks),
            median(row.means), median(row.told), median(row.told_in_blocks), median(row.seconds));
        std::fflush(stdout);
        all.sums.insert(all.sums.end(), row.wrong.begin(), row.wrong.end());
        if (samples == many) all.harms.push_back(median(row.cleaned) / median(row.noisy));
        if (samples != judged) continue;
        all.times.push_back(row.times());
        const double told = median(row.told_in_blocks);
        all.untold.push_back(std::max(told, 1 / told));
        all.flips.push_back(median(row.cleaned_flip) / median(row.noisy_flip));
        all.means.push_back(median(row.means));
        all.shifts.push_back(std::max(0.0, median(row.cleaned_shift) - median(row.noisy_shift)));
    }
}

void judge(const Judged& all) {
    if (smoke() || all.sums.empty()) return;
    const auto greatest = [](const std::vector<double>& of) {
        return std::vector{*std::max_element(of.begin(), of.end())};
    };
    quantity("clean.wrong_sums", greatest(all.sums), "pixels", 0, false);
    if (!all.harms.empty())
        quantity("clean.harm", greatest(all.harms), "times the error at 1024 samples", most_harm, false);
    if (all.times.empty()) return;
    quantity("clean.times_less", all.times, "relative square error at 32 samples, by scene", times_less, true);
    quantity("clean.worst_scene", {*std::min_element(all.times.begin(), all.times.end())}, "times less", 1 / 1.05,
             true);
    quantity("clean.worst_flip", greatest(all.flips), "of the noisy picture's", 1, false);
    quantity("clean.worst_means", greatest(all.means), "of the noisy picture's error, over blocks of 16 x 16 pixels", 1,
             false);
    quantity("clean.untold", greatest(all.untold), "between expected and true error, worst scene", most_untold, false);
    figure("clean.mean_shift", greatest(all.shifts), most_shift, false);
}

void measure_all(const std::vector<std::string>& names) {
    Judged all;
    for (const ReferenceScene& scene : reference_scenes())
        if (names.empty() || std::find(names.begin(), names.end(), scene.name) != names.end()) measure(scene, all);
    judge(all);
}

}  // namespace
}  // namespace lightnet::bench

int main(int count, char** words) {
    return lightnet::bench::run("clean", [&] { lightnet::bench::measure_all({words + 1, words + count}); });
}
