// A map of where light has to leave its lamps to be of use, learnt from trials.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/base/math/samples.hpp"

namespace lightnet {

/// The numbers that Scene::emit() takes: which light, where on it, and in which direction.
using EmissionNumbers = std::array<float, 5>;

/// A light path that was tried, and was of use. Small, as many travel: its numbers are cut off.
class Trial {
public:
    Trial() = default;
    /// `weight`: 1 over the density with which `numbers` were chosen; `gain`: how much of its light was of use, W.
    Trial(const EmissionNumbers& numbers, float weight, float gain) : worth_(std::sqrt(weight) * gain) {
        for (std::size_t i = 0; i < numbers.size(); ++i) steps_[i] = static_cast<std::uint16_t>(numbers[i] / step);
    }
    float number(std::size_t i) const { return step * (static_cast<float>(steps_[i]) + 0.5f); }
    /// Weight × gain².
    double square() const { return double{worth_} * worth_; }

    static constexpr float step = 0x1p-16f;

private:
    std::array<std::uint16_t, 5> steps_{};
    std::uint16_t nothing_ = 0;  // no byte is left to chance
    float worth_ = 0;
};
static_assert(sizeof(Trial) == 16);

/// A density over the cube of all emission numbers: high where trials gained much, and nowhere less than a fixed share
/// of the even one, so that light chosen by it and weighted with 1 / density is right whatever the trials saw. After
/// Jensen 1996, "Global illumination using photon maps" (projection maps); the cells are those of an adaptive partition
/// (Jadach 2003, "Foam"). Immutable.
class Aim {
public:
    /// Everywhere alike.
    Aim() : Aim(std::span<const Trial>{}) {}
    explicit Aim(std::span<const Trial> trials);

    struct Choice {
        EmissionNumbers numbers;
        float weight;  // 1 / density
    };
    /// Uses four dimensions.
    Choice choose(Samples& samples) const;
    std::size_t cells() const { return cells_.size(); }

private:
    struct Cell {
        EmissionNumbers low{0, 0, 0, 0, 0}, high{1, 1, 1, 1, 1};
        double gain = 0;  // root of volume × Σ weight × gain²
        double volume() const;
    };
    void divide(const Cell& cell, std::span<Trial> trials, int depth);
    static std::pair<std::size_t, float> border_in(const Cell& cell, std::span<const Trial> trials, double least);
    static double gain_of(const Cell& cell, std::span<const Trial> trials);

    std::vector<Cell> cells_;
    std::vector<float> ends_;  // running shares
};

}  // namespace lightnet
