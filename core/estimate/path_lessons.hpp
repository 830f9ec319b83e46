// Records that a guide learns from, made of paths once they have ended.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/base/math/rgb.hpp"
#include "core/estimate/light_guide.hpp"

namespace lightnet {

/// What paths find on their way, for a guide. Light that a surface scatters on is taken from what the guide knows of
/// the surface, where it does, and not from where a single path went on to: Dahm & Keller 2017, "Learning Light
/// Transport the Reinforced Way". So one round of paths carries light one surface farther, with little noise.
class Lessons {
public:
    /// Of so many paths, from now on.
    void begin(std::size_t paths) {
        paths_ = paths;
        lessons_.clear();
        found_.clear();
        surfaces_.assign(paths, 0);
    }
    /// A path goes on in a direction that brings `weight` times the light that it finds. `scattered`: what the surface
    /// scatters of what the guide knows to arrive; below 0: it does not know.
    void add(std::size_t path, const std::optional<GuideStep>& step, Rgb weight, float scattered) {
        lessons_.push_back({path, found_.size(), weight, scattered, step, 0});
        ++surfaces_[path];
    }
    /// All paths have been at their next surface. Takes what they found there.
    void take(std::vector<Rgb>& sums, std::vector<Rgb>& totals) {
        for (std::size_t i = 0; i < paths_; ++i) totals[i] += sums[i];
        found_.push_back(sums);
        sums.assign(paths_, Rgb{});
    }
    /// All paths have ended.
    void end(std::vector<GuideRecord>& records) {
        later_.assign(paths_, Rgb{});
        scattered_.assign(paths_, -1.0f);
        std::size_t last = lessons_.size();
        for (std::size_t round = found_.size(); round-- > 0;) {
            for (; last > 0 && lessons_[last - 1].round == round; --last) finish(lessons_[last - 1]);
            for (std::size_t i = 0; i < paths_; ++i) later_[i] += found_[round][i];
        }
        for (const Lesson& lesson : lessons_)
            if (lesson.step && lesson.radiance >= 0) {
                records.emplace_back(*lesson.step, lesson.radiance);
                if (!records.back().sound()) records.pop_back();
            }
    }
    std::size_t surfaces(std::size_t path) const { return surfaces_[path]; }

private:
    struct Lesson {
        std::size_t path, round;
        Rgb weight;
        float scattered;
        std::optional<GuideStep> step;
        float radiance;
    };
    void finish(Lesson& lesson) {
        const auto arrived = [&](const Rgb& found) {
            const auto part = [](float light, float times) { return times > 0 ? light / times : 0; };
            const Rgb& w = lesson.weight;
            return luminance({part(found.r, w.r), part(found.g, w.g), part(found.b, w.b)});
        };
        float& scattered = scattered_[lesson.path];
        if (lesson.round + 1 < found_.size())
            lesson.radiance = scattered < 0 ? arrived(later_[lesson.path])
                                            : arrived(found_[lesson.round + 1][lesson.path]) + scattered;
        scattered = lesson.scattered;
    }

    std::size_t paths_ = 0;
    std::vector<Lesson> lessons_;          // in the order of rounds
    std::vector<std::vector<Rgb>> found_;  // by round, of each path
    std::vector<std::size_t> surfaces_;    // of each path
    // of each path, from its end back to here: what it found, and what its last surface scatters
    std::vector<Rgb> later_;
    std::vector<float> scattered_;
};

}  // namespace lightnet
