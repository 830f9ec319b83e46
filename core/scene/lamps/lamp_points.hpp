// Points on lamps, many at once: what AreaLamps::sample() gives, to the bit.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/base/math/columns.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/bare_lights/light_sample.hpp"
#include "core/scene/lamps/ball_lamp.hpp"
#include "core/scene/surfaces/flat_lamp.hpp"

namespace lightnet {

/// A point that looks at a lamp which was chosen for it.
struct LampAsked {
    std::uint32_t who;  // which of the samples is its
    Vec3 from;
    Vec2 u;
    float chance;  // of the lamp
};

// Where lamps are, without what those of all forms have.

/// Triangles and parallelograms.
struct FlatLampColumns {
    using Lamp = FlatLamp;
    Columns3 corner, first_edge, second_edge, normal;
    Flags whole;

    void set(std::size_t i, const FlatLamp& lamp);
    [[gnu::always_inline]] FlatLamp operator[](std::size_t i) const {
        FlatLamp lamp;
        lamp.facet = {corner[i], first_edge[i], second_edge[i], normal[i]};
        lamp.whole = whole[i] != 0;
        return lamp;
    }
};

struct BallLampColumns {
    using Lamp = BallLamp;
    Columns3 center;
    Column radius;
    Flags inwards;

    void set(std::size_t i, const BallLamp& lamp);
    [[gnu::always_inline]] BallLamp operator[](std::size_t i) const {
        BallLamp ball;
        ball.center = center[i];
        ball.radius = radius[i];
        ball.inwards = inwards[i] != 0;
        return ball;
    }
};

/// Some points, each of which looks at a lamp of its own. One thread's.
template <class Forms>
class LampPoints {
public:
    void add(const LampAsked& asked, const typename Forms::Lamp& lamp);
    /// Samples of all that were added. `share`: the chance that it is lamps that are looked at.
    void find(float share, LightSamples& samples);

private:
    struct Finding;
    void write(LightSamples& samples) const;

    std::size_t count_ = 0;
    Forms forms_;
    std::array<std::uint32_t, lanes> who_;
    Columns3 from_, radiance_, position_, direction_;
    Columns2 u_;
    Column chance_, area_, pdf_;
    Flags two_sided_, group_, found_;
};

extern template class LampPoints<FlatLampColumns>;
extern template class LampPoints<BallLampColumns>;

}  // namespace lightnet
