// Points on lamps, many at once: what AreaLamps::sample() gives, to the bit.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/base/math/columns.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/lamps/ball_lamp.hpp"
#include "core/scene/surfaces/flat_lamp.hpp"
#include "core/scene/surfaces/light_sample.hpp"

namespace lightnet {

/// A point that looks at a lamp which was chosen for it.
struct LampAsked {
    std::uint32_t who;  // which of the samples is its
    Vec3 from;
    Vec2 u;
    float chance;  // of the lamp
};

/// What is the same for lamps of all forms. One thread's, as what follows.
class LampPoints {
protected:
    void add(const LampAsked& asked, Rgb radiance, bool two_sided, float area, std::uint32_t group);
    void write(LightSamples& samples) const;

    std::size_t count_ = 0;
    std::array<std::uint32_t, lanes> who_;
    Columns3 from_, radiance_, position_, direction_;
    Columns2 u_;
    Column chance_, area_, pdf_;
    Flags two_sided_, group_, found_;
};

/// On triangles and parallelograms.
class FlatLampPoints : LampPoints {
public:
    void add(const LampAsked& asked, const FlatLamp& lamp);
    /// Samples of all that were added. `share`: the chance that it is lamps that are looked at.
    void find(float share, LightSamples& samples);

private:
    struct Finding;
    Columns3 corner_, first_edge_, second_edge_, normal_;
    Flags whole_;
};

/// On balls.
class BallLampPoints : LampPoints {
public:
    void add(const LampAsked& asked, const BallLamp& lamp);
    /// As FlatLampPoints::find().
    void find(float share, LightSamples& samples);

private:
    struct Finding;
    Columns3 center_;
    Column radius_;
    Flags inwards_;
};

}  // namespace lightnet
