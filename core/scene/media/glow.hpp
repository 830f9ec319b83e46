// Light that media emit, for those who follow it from there.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/math/box.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/media/bounds.hpp"
#include "core/scene/media/medium.hpp"

namespace lightnet {

/// Cells of space, of which each is chosen by the most that it can emit. Constant once it is made.
class Glow {
public:
    Glow() = default;
    /// `boxes`: around what each medium fills, metres; where its extinction has a grid that doesn't count. Keeps
    /// looking at `media`.
    Glow(std::span<const Medium> media, std::span<const Box> boxes);

    /// Where light leaves, in all directions alike.
    struct Spark {
        Vec3 position;
        std::uint16_t medium;
        Rgb flux;  // W, over the density of its choice
    };
    /// None: there is nothing by this sample. Whether that medium fills the place is for others to find out.
    std::optional<Spark> spark(float choice, Vec2 place) const;
    /// No less than all of it, W.
    double power() const { return power_; }

private:
    struct Source {
        std::uint16_t medium;
        Vec3 corner, x, y, z;  // a parallelepiped, metres
        std::array<std::uint32_t, 3> cells;
        double volume;  // of a cell, m³
    };
    struct Cell {
        std::uint32_t source, index;
    };
    void add(const Source& source, const VolumeField& emission, std::vector<double>& powers);

    std::span<const Medium> media_;
    std::vector<Source> sources_;
    std::vector<Cell> cells_;
    std::vector<float> ends_;  // running shares of these
    double power_ = 0;
};

}  // namespace lightnet
