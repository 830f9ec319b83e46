// Where light has to leave its lamps to be of use: learnt from trials.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/math/samples.hpp"

namespace lightnet {

/// The numbers that Scene::emit() takes: which light, where on it, and whither.
using EmissionNumbers = std::array<float, 5>;

/// One way of light that was tried.
struct Trial {
    EmissionNumbers numbers;
    float weight = 0;  // 1 over the density with which `numbers` were chosen
    float gain = 0;    // how much of its light was of use, W
};

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
